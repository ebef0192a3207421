# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Hands grab bodies, drag, throw and let go."""

from dataclasses import replace
import math

import numpy as np
from physsim_ros.engine.core import lib
from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Malformed, Refusal, WorldFull
from physsim_ros.model.requests import Anchor, Delete, DeleteAll, Grab, LetGo, MoveHand, Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Shape
from physsim_ros.model.transform import Point
from physsim_ros.simulation.entries import Origin
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
from physsim_ros.simulation.world.capacity import MOST_HANDS
import pytest

from .driven import SLAB
from ..building import BOX, DISC, DT, NOWHERE, spawn, spawning, twist

TOPIC = '~/drag/feedback'
# A rod, and the arm of a grip near its end [m].
ROD, ARM = Box(width=2.0, height=0.1), 0.9


def dragged(world: World, to: Point, steps: int, hand: str = 'h') -> list[np.ndarray]:
    """Move a hand to a point; return the twist of `a/0` after each step, and before them."""
    world.apply(MoveHand(hand=hand, point=to))
    twists = [twist(world, 'a/0')]
    for _ in range(steps):
        world.step(1)
        twists.append(twist(world, 'a/0'))
    return twists


def gaps_of(shape: Shape, arm: float, mass: float = 1.0, damping: float = 0.0) -> np.ndarray:
    """Return how far a body is below the hand that draws it up, after each of 120 steps [m]."""
    world = World(settings=replace(NOWHERE, damping=damping))
    spawn(world, 'a/0', shape, mass=mass)
    world.apply(Grab(hand='h', point=(arm, 0.0)))
    world.apply(MoveHand(hand='h', point=(arm, 0.05)))
    gaps = []
    for _ in range(120):
        world.step(1)
        anchor, hand = world.snapshot().grip_lines[0]
        gaps.append(hand[1] - anchor[1])
    return np.array(gaps)


@pytest.mark.parametrize('mass', [1e-3, 1.0, 1e6])
@pytest.mark.parametrize(('shape', 'arm'), [(DISC, 0.0), (ROD, ARM)])
def test_a_body_follows_its_hand_without_oscillation_at_any_mass_and_arm(mass, shape, arm):
    gaps = gaps_of(shape, arm, mass)

    # Critically damped: (1 + w t) e^(-w t), to the error of the implicit method, of order w dt.
    times = DT * np.arange(1, 121)
    omega = 2.0 * math.pi * 5.0
    wanted = 0.05 * (1.0 + omega * times) * np.exp(-omega * times)
    assert np.abs(gaps - wanted).max() < 0.05 * omega * DT / lib.SUB_STEPS
    # Implicit Euler of each sub-step, to the cube of the angle.
    dt, gap, speed, exact = DT / lib.SUB_STEPS, 0.05, 0.0, []
    for _ in times:
        for _ in range(lib.SUB_STEPS):
            gap -= speed * dt
            speed = (speed + omega**2 * gap * dt) / (1.0 + omega * dt) ** 2
        exact.append(gap)
    assert gaps == pytest.approx(exact, abs=1e-5)
    assert min(gaps) > -1e-9


def test_damping_slows_a_rod_that_is_turned_by_its_hand_as_a_disc():
    turned, pulled = gaps_of(ROD, ARM, damping=0.99), gaps_of(DISC, 0.0, damping=0.99)

    # To the cube of the angle.
    assert turned == pytest.approx(pulled, abs=1e-5)


@pytest.mark.parametrize('gravity', [(0.0, -9.81), (0.0, -1.62), (0.0, 0.0)])
@pytest.mark.parametrize('factor', [2.0, 10.0])
def test_the_force_of_a_hand_is_bounded_in_weights_of_its_body(gravity, factor):
    world = World(settings=WorldSettings(gravity=gravity, drag_force=factor))
    spawn(world, 'a/0', DISC, mass=3.0)
    world.apply(Grab(hand='h', point=(0.0, 0.0)))
    world.step(60)

    twists = np.array(dragged(world, (50.0, 20.0), 60))

    accelerations = np.diff(twists[:, :2], axis=0) / DT - gravity
    most = factor * (math.hypot(*gravity) or 9.81)
    sizes = np.hypot(*accelerations.T)
    assert sizes.max() <= most * (1.0 + 1e-9)
    assert sizes[0] == pytest.approx(most)


def test_a_body_that_is_let_go_flies_on_with_its_velocity():
    world = World()
    spawn(world, 'a/0', DISC, (0.0, 5.0, 0.0))
    world.apply(Grab(hand='h', point=(0.1, 5.0)))
    dragged(world, (1.0, 6.0), 20)
    before = world.snapshot()

    world.apply(LetGo(hand='h'))

    assert np.array_equal(world.snapshot().twists, before.twists)
    world.step(48)
    time = 48 * DT
    flown = before.centers[0] + before.twists[0, :2] * time + (0.0, -9.81 * time**2 / 2)
    assert world.snapshot().centers[0] == pytest.approx(flown, abs=1e-9)


def test_two_hands_hold_one_body_and_share_its_weight():
    world = World()
    spawn(world, 'a/0', ROD)
    for number, x in enumerate((-ARM, ARM)):
        world.apply(Grab(hand=f'h{number}', point=(x, 0.0)))
    for number, x in enumerate((-ARM, ARM)):
        world.apply(MoveHand(hand=f'h{number}', point=(x, 1.0)))
    world.step(240)

    snapshot = world.snapshot()
    # Each spring has the effective mass at its grip, m / (1 + m r^2 / I).
    share = 2.0 / (1.0 + ARM**2 / ROD.form.gyration)
    sag = 9.81 / (share * (2.0 * math.pi * 5.0) ** 2)
    assert snapshot.poses[0] == pytest.approx([0.0, 1.0 - sag, 0.0], abs=1e-4)
    assert snapshot.twists[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-3)


@pytest.mark.parametrize('iterations', [1, 10])
def test_as_many_hands_on_one_body_as_there_may_be_do_not_shake_it(iterations):
    world = World(settings=WorldSettings(iterations=iterations))
    spawn(world, 'a/0', ROD)
    for number in range(MOST_HANDS):
        world.apply(Grab(hand=str(number), point=(number / 40 - 0.8, 0.0)))
    world.apply(MoveHand(hand='0', point=(-0.8, 0.5)))
    world.step(240)

    assert np.abs(twist(world, 'a/0')).max() < 1e-3


def test_the_topmost_movable_body_is_grabbed(world):
    for number, said in enumerate(({}, {}, {'anchored': True}, {'kinematic': True})):
        spawn(world, f'a/{number}', BOX if number else DISC, group=1, **said)

    answer = world.apply(Grab(hand='h', point=(0.0, 0.0))).answer
    assert answer == Answer(subject='a/1', message='grabbed a/1')
    assert world.apply(Grab(hand='h', point=(0.1, 0.0), frame='a/0')).answer.subject == 'a/1'


@pytest.mark.parametrize('point', [(9.0, 9.0), (0.0, -0.5)])
def test_a_hand_that_finds_no_movable_body_is_refused_and_keeps_what_it_holds(point):
    world = World()
    world.apply(SLAB)
    spawn(world, 'a/0', DISC, (0.0, 3.0, 0.0))
    world.apply(Grab(hand='h', point=(0.0, 3.0)))
    before = world.digest()

    with pytest.raises(Refusal) as refused:
        world.apply(Grab(hand='h', point=point))

    assert refused.value.code == 'nothing_there'
    assert world.digest() == before


def test_a_hand_beyond_as_many_as_there_may_be_is_refused_until_another_lets_go(world):
    spawn(world, 'a/0', DISC)
    for number in range(MOST_HANDS):
        world.apply(Grab(hand=str(number), point=(0.0, 0.0)))
    before = world.digest()

    with pytest.raises(WorldFull):
        world.apply(Grab(hand='one more', point=(0.0, 0.0)))

    assert world.digest() == before
    # One that grabs again takes the place that it has.
    world.apply(Grab(hand='0', point=(0.1, 0.0)))
    world.apply(LetGo(hand='0'))
    world.apply(Grab(hand='one more', point=(0.0, 0.0)))
    assert len(world.grips) == MOST_HANDS


def test_hands_whose_bodies_are_gone_are_dropped_when_another_grabs():
    sim = Simulation(settings=NOWHERE, speed=0.0)
    # In a paused world no hand lets go since it is silent.
    for hand in ('h', 'k'):
        sim.perform(spawning('a/0', DISC))
        sim.requests.submit(Grab(hand=hand, point=(0.0, 0.0)), Origin(TOPIC))
        sim.apply_requests()
        before = sim.world.grips
        sim.perform(Delete(name='a/0'))
        assert [grip.hand for grip in before] == [hand]
    sim.perform(spawning('a/0', DISC))
    sim.requests.submit(Grab(hand='l', point=(0.0, 0.0)), Origin(TOPIC))
    sim.apply_requests()

    hands = sim.applier.hands
    assert [hand for hand in ('h', 'k', 'l') if hand in hands] == ['l']


@pytest.mark.parametrize('hand', ['', 'x' * 1001, 'a\nb'])
def test_the_name_of_a_hand_can_be_printed(hand):
    with pytest.raises(Malformed):
        LetGo(hand=hand)


def test_a_sleeping_body_wakes_and_the_hand_keeps_it_awake():
    world = World()
    world.apply(SLAB)
    spawn(world, 'a/0', BOX, (0.0, 0.5, 0.0))
    world.step(480)
    world.apply(Grab(hand='h', point=(0.0, 0.5)))
    world.step(480)

    world.apply(MoveHand(hand='h', point=(0.5, 1.5)))
    world.step(240)

    assert world.snapshot().poses[1, :2] == pytest.approx([0.5, 1.5], abs=0.05)


@pytest.mark.parametrize(
    'request_',
    [
        Delete(name='a/0'),
        DeleteAll(),
        Anchor(point=(0.0, 0.0)),
        spawning('a/0', DISC, kinematic=True),
        Restore(state=World().save()),
    ],
    ids=lambda request: type(request).__name__,
)
def test_a_hand_loses_a_body_that_it_can_move_no_more(request_):
    sim = Simulation(settings=NOWHERE)
    sim.perform(spawning('a/0', DISC))
    sim.requests.submit(Grab(hand='h', point=(0.0, 0.0)), Origin(TOPIC))
    sim.advance_frame()
    sim.perform(request_)

    assert sim.advance_frame().snapshot.grips == ()
    for request in (MoveHand(hand='h', point=(1.0, 1.0)), LetGo(hand='h')):
        sim.requests.submit(request, Origin(TOPIC))
    assert sim.advance_frame().answers == (Answer(topic=TOPIC, message='h holds no body'),)


def test_a_body_keeps_its_hand_when_its_shape_changes(world):
    spawn(world, 'a/0', DISC)
    world.apply(Grab(hand='h', point=(0.2, 0.0)))
    spawn(world, 'a/0', BOX)
    dragged(world, (2.2, 0.0), 240)

    assert world.snapshot().poses[0, 0] == pytest.approx(2.0, abs=1e-3)


def test_a_hand_that_grabs_another_body_lets_go_of_the_first():
    worlds = World(), World()
    for world in worlds:
        spawn(world, 'a/0', DISC)
        spawn(world, 'b/0', DISC, (5.0, 0.0, 0.0))
        world.apply(Grab(hand='h', point=(0.0, 0.0)))
        world.step(60)
    worlds[0].apply(LetGo(hand='h'))
    for world in worlds:
        world.apply(Grab(hand='h', point=world.snapshot().poses[1, :2]))
        assert [grip.body for grip in world.grips] == ['b/0']
        world.step(60)

    assert worlds[1].digest() == worlds[0].digest()


def test_a_paused_hand_places_an_anchored_body_and_does_not_pull_it_while_time_runs():
    world = World()
    spawn(world, 'a/0', BOX, anchored=True)
    # Without a body that moves, no step is made.
    spawn(world, 'b/0', DISC, (9.0, 0.0, 0.0))
    world.apply(Grab(hand='h', point=(0.2, 0.0), paused=True))

    answer = world.apply(MoveHand(hand='h', point=(1.2, 0.0), paused=True)).answer
    assert answer == Answer(subject='a/0', message='placed a/0')
    world.apply(MoveHand(hand='h', point=(3.0, 0.0)))
    world.step(60)

    assert world.snapshot().poses[0].tolist() == [1.0, 0.0, 0.0]
    world.apply(Delete(name='a/0'))
    answer = world.apply(MoveHand(hand='h', point=(2.0, 0.0), paused=True)).answer
    assert answer == Answer(message='h holds no body')


def test_a_paused_hand_that_does_not_move_changes_nothing():
    world = World()
    spawn(world, 'a/0', BOX)
    world.apply(Grab(hand='h', point=(0.2, 0.0), paused=True))

    change = world.apply(MoveHand(hand='h', point=(0.2, 0.0), paused=True))

    assert not change.has_changed
