# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world that the engine can be in is saved and loaded, whatever its numbers are."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
import itertools
import math
from typing import Any

from physsim_ros import Simulation
from physsim_ros.files import load_mapping, state_from, text_of
from physsim_ros.model.actors import actor_from
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checkpoint import BodyState, Motion, WorldState
from physsim_ros.model.checks import LOST
from physsim_ros.model.errors import Refusal
from physsim_ros.model.joints import JointKind, JointProperties, MOST_RATIO
from physsim_ros.model.requests import Delete, Join, Spawn
from physsim_ros.model.robots import Robot
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc, LARGEST, Shape
from physsim_ros.model.states import ActorState, NEVER, RobotState
import pytest

FLOATING = WorldSettings(gravity=(0.0, 0.0))
# The last places and turns before a body is lost [m, rad].
LAST = math.nextafter(LOST, 0.0)
PLACES = [-LAST, 0.1, LAST]
RATIOS = [MOST_RATIO, -MOST_RATIO, 1.0 / MOST_RATIO]


def saved_body(
    name: str,
    motion: tuple[float, ...],
    shape: Shape = Disc(radius=0.3),  # noqa: B008 - frozen
    **properties: Any,
) -> BodyState:
    """Return the state of a body with the motion of its centre of mass [m, rad, m/s, rad/s]."""
    world = Simulation(settings=FLOATING)
    world.perform(Spawn(name=name, shape=shape, properties=Properties(**properties)))
    (state,) = world.save().bodies
    x, y, yaw, vx, vy, spin = motion
    return replace(
        state, pose=(x, y, yaw), twist=(vx, vy, spin), motion=Motion(x, y, yaw, vx, vy, spin, True)
    )


def assert_saved(world: Simulation) -> None:
    """Assert that a world is loaded as it was saved, and saved as it was loaded."""
    state = world.save()
    text = text_of(state, 240.0)
    loaded = state_from(load_mapping(text, field='world'), WorldSettings(), 240.0)
    assert loaded.joints == state.joints
    assert [each.motion for each in loaded.bodies] == [each.motion for each in state.bodies]
    again = Simulation()
    again.begin(loaded)
    assert text_of(again.save(), 240.0) == text


def joins(kind: JointKind) -> Iterator[Join]:
    """Yield requests for joints of a kind, of bodies anywhere."""
    for x, ratio in itertools.product((0.1, 1e7), RATIOS if kind is JointKind.GEAR else [0]):
        points = ((x, 0.2), (0.3, -x))[: 2 if kind.points == 2 else 1]
        properties = JointProperties(ratio=ratio) if ratio else JointProperties()
        for b in ('b/0', 'world'):
            yield Join(name='j/0', kind=kind, points=points, a='a/0', b=b, properties=properties)


@pytest.mark.parametrize('kind', JointKind)
def test_a_joint_of_bodies_anywhere_is_saved(kind: JointKind) -> None:
    count = 0
    for here, yaw, join in itertools.product(PLACES, PLACES, joins(kind)):
        world = Simulation()
        ends = (
            saved_body('a/0', (here, -here, yaw, 0.0, 0.0, 0.0)),
            saved_body('b/0', (-here, here, -yaw, 0.0, 0.0, 0.0)),
        )
        world.begin(WorldState(settings=FLOATING, bodies=ends))
        try:
            world.perform(join)
        except Refusal:
            continue
        assert_saved(world)
        count += 1
    assert count > 10


@pytest.mark.parametrize('anchored', [False, True])
@pytest.mark.parametrize('speed', [0.0, 1e5, LAST])
def test_a_body_anywhere_at_any_speed_is_saved(speed: float, anchored: bool) -> None:
    for x, yaw in itertools.product(PLACES, repeat=2):
        world = Simulation()
        motion = (x, -x, yaw, *([0.0] * 3 if anchored else [speed, -speed, speed]))
        body = saved_body('a/0', motion, Box(width=0.5, height=0.1), anchored=anchored)
        world.begin(WorldState(settings=FLOATING, bodies=(body,)))
        assert_saved(world)


@pytest.mark.parametrize('number', [0.0, 1e-300, -LAST, LAST])
@pytest.mark.parametrize('until', [0, NEVER, 10**9])
def test_robots_and_actors_in_any_state_are_saved(number: float, until: int) -> None:
    square = number * number
    robot = Robot.from_mapping({'drive': {'kind': 'omni'}})
    driven = RobotState(
        until=until,
        aim=(number,) * 3,
        wheels=(number,) * 3,
        travel=(number,) * 3,
        odometry=(number,) * 3,
        covariance=(square, number, square, -number, number, square),
    )
    actor = actor_from({'kind': 'path', 'points': [[0, 0], [1, 0]], 'speed': 1}, 'actor')
    still = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    bodies = (
        replace(saved_body('r/0', still, robot=robot), driven=driven),
        replace(
            saved_body('a/0', (5.0, *still[1:]), actor=actor),
            acting=ActorState(until if until == NEVER else -until, abs(int(number)) % 2**53),
        ),
    )
    world = Simulation()
    world.begin(WorldState(settings=FLOATING, bodies=bodies))
    assert_saved(world)


def test_a_world_whose_media_have_just_changed_is_saved() -> None:
    world = Simulation(settings=WorldSettings(air_density=0.5, air_viscosity=0.5))
    pool = Properties(anchored=True, sensor=True, medium={'density': 2.0, 'flow': (1.0, 0.0)})
    world.perform(Spawn(name='first/0', shape=Disc(radius=0.3), pose=(9.0, 0.0, 0.0)))
    world.perform(Spawn(name='pool/0', shape=Box(width=4.0, height=4.0), properties=pool))
    world.perform(Spawn(name='boat/0', shape=Disc(radius=0.3)))
    world.run(0.2)
    before = world.world.snapshot().twists[2]
    world.perform(Delete(name='first/0'))
    assert world.world.snapshot().twists[1] == pytest.approx(before, abs=1e-12)
    assert_saved(world)


def test_a_winch_winds_out_no_longer_than_a_rope_that_can_be_saved() -> None:
    world = Simulation(settings=FLOATING)
    for name, x in (('a/0', 0.0), ('b/0', 2.0)):
        world.perform(Spawn(name=name, shape=Disc(radius=0.3), pose=(x, 0.0, 0.0)))
    rope = Join(
        name='j/0',
        kind=JointKind.ROPE,
        points=((0.0, 0.0), (2.0, 0.0)),
        a='a/0',
        b='b/0',
        properties=JointProperties(rate=1e5),
    )
    world.perform(rope)
    world.run(2.0)
    assert world.save().joints[0].properties.length == LARGEST
    assert_saved(world)
