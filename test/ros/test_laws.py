# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Laws 28 to 36 as others see them: a client asks for worlds over topics, and measures them.

It knows what it spawned, and what `~/states`, `~/contacts` and the answers say in each step.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from itertools import pairwise
import math
from pathlib import Path
import random
from typing import NamedTuple

import numpy as np
from physsim_ros.testing import box, disc, marker, own_context, PhysSim
from physsim_ros.testing.messages import yaw_of
import pytest
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import Marker, MarkerArray

from ..client import Client

# `test/laws` has the laws themselves.
pytestmark = pytest.mark.slow

G = 9.81
RATE = 240.0


class State(NamedTuple):
    """
    The n bodies after a step, in the order in which they were spawned.

    :ivar poses: (n, 3), x, y [m], yaw [rad]
    :ivar twists: (n, 3), vx, vy [m/s], spin [rad/s]
    """

    poses: np.ndarray
    twists: np.ndarray


class Observer:
    """
    A client of a world that publishes each step.

    :ivar contacts: messages of `~/contacts` so far
    """

    def __init__(self, physsim: PhysSim) -> None:
        self._physsim = physsim
        self._client = Client(physsim)
        self._states = self._client.listen(MultiDOFJointState, '~/states')
        self.contacts = self._client.listen(MultiDOFJointState, '~/contacts')

    def spawn(self, *bodies: Marker) -> None:
        """Spawn bodies, each of which is accepted."""
        events = self._client.ask('~/spawn_array', MarkerArray(markers=list(bodies)))
        assert [each.code for each in events] == ['ok'] * len(bodies)

    def join(self, name: str, points: list[tuple[float, float]], text: str) -> str:
        """Join bodies, and return the code of the answer."""
        joint = marker(Marker.LINE_LIST, name, points=points, text='{%s}' % text)  # noqa: UP031
        (event,) = self._client.ask('~/join', joint)
        return event.code

    def watch(self, seconds: float) -> list[State]:
        """Return what is so after each step of the next seconds."""
        self._states.clear()
        self._physsim.run(seconds)
        return [
            State(
                np.array(
                    [
                        (each.translation.x, each.translation.y, yaw_of(each.rotation))
                        for each in message.transforms
                    ]
                ),
                np.array(
                    [(each.linear.x, each.linear.y, each.angular.z) for each in message.twist]
                ),
            )
            for message in self._states
        ]


ObservedWorld = Callable[..., AbstractContextManager[Observer]]


@pytest.fixture
def observed_world(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> ObservedWorld:
    """Give a test worlds that publish each step, one after the other."""

    @contextmanager
    def make(gravity: float = -G) -> Iterator[Observer]:
        values = {'publish_rate': RATE, 'physics_rate': RATE, 'gravity': [0.0, gravity]}
        with (
            own_context(monkeypatch) as context,
            PhysSim(context, world_dir=str(tmp_path), **values) as physsim,
        ):
            yield Observer(physsim)

    return make


def test_a_plough_goes_as_far_as_its_velocity_says(observed_world: ObservedWorld) -> None:
    with observed_world(gravity=0.0) as world:
        text = '{mass: 1000, friction: 0, velocity: [30, 0]}'
        world.spawn(box('plough/0', size=(0.3, 1.0), text=text))
        places = [(1.0 + 0.12 * (each // 8), 0.13 * (each % 8) - 0.46) for each in range(80)]
        light = '{mass: 0.1, friction: 0, elasticity: 0.5}'
        world.spawn(
            *(disc(f'ball/{i}', diameter=0.1, at=at, text=light) for i, at in enumerate(places))
        )
        states = world.watch(0.5)
    way = states[-1].poses[0, 0] - states[0].poses[0, 0]
    told = sum((a.twists[0, 0] + b.twists[0, 0]) / 2 for a, b in pairwise(states)) / RATE
    assert way > 10.0
    assert way == pytest.approx(told, rel=0.02)


@pytest.mark.parametrize('limit', ['max_force: 1e6', 'break_force: 1e6', 'lower: -50, upper: 50'])
def test_neither_a_motor_far_away_nor_a_limit_that_is_not_reached_changes_a_pendulum(
    observed_world: ObservedWorld, limit: str
) -> None:
    ends = []
    for changed in (False, True):
        with observed_world() as world:
            world.spawn(box('bar/0', size=(1.0, 0.1), at=(0.5, 4.0)))
            text = 'kind: axle, a: bar/0, b: world' + (f', {limit}' if changed else '')
            assert world.join('axle/0', [(0.0, 4.0)], text) == 'ok'
            if changed:
                world.spawn(box('far/0', size=(1.0, 0.1), at=(50.0, 4.0)))
                text = 'kind: motor, a: far/0, b: world, rate: 3, max_torque: 50'
                assert world.join('far/0', [(50.0, 4.0)], text) == 'ok'
            ends.append(world.watch(1.5)[-1].poses[0])
    assert ends[0] == pytest.approx(ends[1], abs=1e-9)


def test_contacts_tell_the_whole_weight_of_what_lies_on_a_machine(
    observed_world: ObservedWorld,
) -> None:
    with observed_world() as world:
        world.spawn(box('plank/0', size=(3.0, 0.2), at=(0.0, 2.0)))
        for number, x in enumerate((-1.4, 1.4)):
            text = 'kind: axle, a: plank/0, b: world'
            assert world.join(f'axle/{number}', [(x, 2.0)], text) == 'ok'
        world.spawn(box('load/0', size=(0.8, 0.8), at=(0.0, 2.5), text='{mass: 2}'))
        world.watch(2.0)
        world.contacts.clear()
        world.watch(1.0)
    upward = 0.0
    for message in world.contacts:
        for name, wrench in zip(message.joint_names, message.wrench, strict=True):
            sign = {'plank/0|load/0': 1.0, 'load/0|plank/0': -1.0}[name]
            upward += sign * wrench.force.y
    assert upward == pytest.approx(2.0 * G, rel=0.01)


@pytest.mark.parametrize('power', [3, 4, 6])
def test_a_spring_is_as_stiff_as_it_says_or_refused_by_code(
    observed_world: ObservedWorld, power: int
) -> None:
    stiffness = 10.0**power
    with observed_world() as world:
        world.spawn(disc('mass/0', diameter=0.2, text='{mass: 1}'))
        text = 'kind: spring, a: mass/0, b: world, stiffness: %g, damping: %g'
        values = stiffness, math.sqrt(stiffness)
        code = world.join('spring/0', [(0.0, 0.0), (0.0, 1.0)], text % values)
        if code != 'ok':
            assert power > 4
            return
        extension = -world.watch(4.0)[-1].poses[0, 1]
    assert extension == pytest.approx(G / stiffness, rel=0.01)


def test_light_planks_stay_joined_and_carry_a_heavy_disc_that_rolls_over_them(
    observed_world: ObservedWorld,
) -> None:
    with observed_world() as world:
        planks = [
            box(f'plank/{i}', size=(1.0, 0.2), at=(i + 0.5, 5.0), text='{mass: 0.22, group: 7}')
            for i in range(10)
        ]
        banks = [
            box(f'bank/{i}', size=(width, 1.0), at=(x, 4.6), text='{anchored: true, group: 7}')
            for i, (x, width) in enumerate(((-0.5, 1.0), (11.5, 3.0)))
        ]
        world.spawn(*planks, *banks)
        for i in range(11):
            a, b = f'plank/{min(i, 9)}', f'plank/{i - 1}' if 0 < i < 10 else 'world'
            assert (
                world.join(f'axle/{i}', [(float(i), 5.0)], f'kind: axle, a: {a}, b: {b}') == 'ok'
            )
        text = '{mass: 50, velocity: [2, 0], spin: -4}'
        world.spawn(disc('roller/0', at=(1.0, 5.61), text=text))
        states = world.watch(2.0)
    for state in states:
        x, y, yaw = state.poses[:10].T
        along = np.stack([np.cos(yaw), np.sin(yaw)]) / 2
        left, right = np.stack([x, y]) - along, np.stack([x, y]) + along
        assert np.hypot(*(right[:, :-1] - left[:, 1:])).max() < 0.02
        # It lies on a row that was straight.
        assert state.poses[-1, 1] > 5.55


def test_joints_that_contradict_each_other_give_no_energy(observed_world: ObservedWorld) -> None:
    pick = random.Random(0)
    sizes = [(pick.uniform(0.3, 1.0), pick.uniform(0.3, 1.0)) for _ in range(6)]
    masses = np.array([10 ** pick.uniform(-1, 1) for _ in sizes])
    places = [(pick.uniform(-2.0, 2.0), pick.uniform(2.0, 5.0)) for _ in sizes]
    with observed_world() as world:
        world.spawn(
            *(
                box(f'b/{i}', size=size, at=at, text='{mass: %r}' % float(mass))  # noqa: UP031
                for i, (size, at, mass) in enumerate(zip(sizes, places, masses, strict=True))
            ),
            box('floor/0', size=(100.0, 1.0), at=(0.0, -0.5), text='{anchored: true}'),
        )
        for number in range(8):
            b = pick.randrange(6)
            a = pick.choice([f'b/{i}' for i in range(6) if i != b] + ['world'])
            kind = pick.choice(['axle', 'pin', 'rod', 'slider', 'rope', 'gear'])
            x, y = places[b]
            points = [(x + pick.uniform(-0.5, 0.5), y + pick.uniform(-0.5, 0.5))]
            if kind in ('rod', 'slider', 'rope'):
                points.append((pick.uniform(-2.0, 2.0), pick.uniform(2.0, 5.0)))
            assert world.join(f'j/{number}', points, f'kind: {kind}, a: b/{b}, b: {a}') == 'ok'
        states = world.watch(2.0)
    turns = masses * np.square(sizes).sum(axis=1) / 12

    def energy(state: State) -> float:
        poses, twists = state.poses[:6], state.twists[:6]
        moving = masses @ np.square(twists[:, :2]).sum(axis=1) + turns @ np.square(twists[:, 2])
        return float(moving / 2 + G * masses @ poses[:, 1])

    could_fall = masses.sum() * G * 5.0
    assert max(map(energy, states)) - G * masses @ [y for _, y in places] < 0.05 * could_fall


def test_a_fast_bar_hits_every_disc(observed_world: ObservedWorld) -> None:
    spin = 100.0
    with observed_world(gravity=0.0) as world:
        text = f'{{kinematic: true, spin: {spin}, friction: 0}}'
        bodies = [box('bar/0', size=(4.0, 0.05), text=text)]
        for number in range(40):
            angle, far = 0.2 + 2.7 * number / 40, 0.4 + 1.5 * (number * 7 % 40) / 40
            at = far * math.cos(angle), far * math.sin(angle)
            bodies.append(disc(f'disc/{number}', diameter=0.06, at=at, text='{friction: 0}'))
        world.spawn(*bodies)
        states = world.watch((math.ceil(2 * math.pi / spin * RATE) + 2) / RATE)
    speeds = np.max([np.hypot(*each.twists[1:, :2].T) for each in states], axis=0)
    assert np.all(speeds > 0.5 * spin * 0.4)


@pytest.mark.parametrize('make', [disc, box])
def test_as_many_leave_an_elastic_row_as_came(
    observed_world: ObservedWorld, make: Callable[..., Marker]
) -> None:
    material = 'mass: 1, friction: 0, elasticity: 1'
    size = {'diameter': 0.2} if make is disc else {'size': (0.2, 0.2)}
    with observed_world(gravity=0.0) as world:
        for number in range(5):
            flies = number < 2
            at = 0.2 * number - (0.03 if flies else 0.0), 0.0
            text = f'{{{material}, velocity: [{2 if flies else 0}, 0]}}'
            world.spawn(make(f'row/{number}', at=at, text=text, **size))
        last = world.watch(0.3)[-1]
    assert last.twists[:, 0] == pytest.approx([0, 0, 0, 2, 2], abs=0.04)
