# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The world carries out requests; a refusal changes nothing; the same requests, the same bits."""

from collections.abc import Callable
from dataclasses import replace
import math
import os
from pathlib import Path
import subprocess
import sys

import numpy as np
from physsim_ros.engine import body as rigid_body
from physsim_ros.model.checks import FARTHEST
from physsim_ros.model.colors import color_of
from physsim_ros.model.errors import (
    Anchored,
    BadProperty,
    Malformed,
    NothingThere,
    Refusal,
    UnknownBody,
    UnknownFrame,
    WorldFull,
)
from physsim_ros.model.requests import (
    Anchor,
    Command,
    Configure,
    Delete,
    DeleteAll,
    Release,
    Request,
    Restore,
)
from physsim_ros.model.scene import Body
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc, Shape, Triangles
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
import pytest

from ..building import (
    body,
    body_at,
    BOX,
    DISC,
    ELL,
    NOWHERE,
    pose,
    SHAPES,
    spawn,
    spawning,
    stack,
    TRIANGLE,
    twist,
)

RED, BLUE = (1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 0.5)
# A pose goes to the centre of mass and back: a few last bits of metres.
ROUNDING = 1e-12


@pytest.fixture
def world() -> World:
    """Return an empty world without gravity, friction or loss."""
    return World(settings=NOWHERE)


def names(world: World) -> tuple[str, ...]:
    return world.snapshot().scene.names


# Spawn


def test_a_spawned_body_is_what_was_said_and_where(world: World) -> None:
    answer = world.apply(
        spawning(
            'box/3', Box(width=2.0, height=1.0), (1.0, -2.0, 0.3), color=RED, lifetime=1.0,
            mass=4.0, friction=0.25, elasticity=0.75, velocity=(1.0, 2.0), spin=3.0, group=5,
            sensor=True,
        )
    )  # fmt: skip

    assert answer == ('box/3', 'spawned box/3')
    assert body(world, 'box/3') == Body(
        name='box/3', shape=Box(width=2.0, height=1.0), color=RED, mass=4.0, density=1.0,
        friction=0.25, elasticity=0.75, anchored=False, kinematic=False, group=5, sensor=True,
        expires=240,
    )  # fmt: skip
    assert pose(world, 'box/3') == pytest.approx((1.0, -2.0, 0.3), abs=ROUNDING)
    assert twist(world, 'box/3') == pytest.approx((1.0, 2.0, 3.0), abs=ROUNDING)
    assert len(world) == 1
    assert 'box/3' in world
    assert 'box/4' not in world


def test_what_is_not_said_comes_from_the_settings() -> None:
    world = World(settings=WorldSettings(density=3.0, friction=0.1, elasticity=0.2))

    spawn(world, 'a/7')

    assert body(world, 'a/7') == Body(
        name='a/7', shape=DISC, color=color_of('a/7'), mass=None, density=3.0, friction=0.1,
        elasticity=0.2, anchored=False, kinematic=False, group=0, sensor=False, expires=None,
    )  # fmt: skip
    assert body(world, 'a/7').total_mass == pytest.approx(3.0 * math.pi / 4, rel=1e-12)


@pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())
@pytest.mark.parametrize('anchored', [False, True])
def test_the_pose_of_any_shape_is_its_origins(shape: Shape, anchored: bool, world: World) -> None:
    spawn(world, 'a/0', shape, (3.0, -4.0, 2.5), anchored=anchored)

    assert pose(world, 'a/0') == pytest.approx((3.0, -4.0, 2.5), abs=ROUNDING)


def test_bodies_are_listed_in_the_order_of_their_spawning(world: World) -> None:
    order = ('b/1', 'a/9', 'c/0', 'a/2')
    for place, name in enumerate(order):
        spawn(world, name, DISC, (3.0 * place, 0.0, 0.0), anchored=place % 2 == 0)

    world.step(3)

    assert names(world) == order
    assert world.snapshot().poses[:, 0] == pytest.approx([0.0, 3.0, 6.0, 9.0], abs=1e-12)


# Change in place


def test_a_change_keeps_what_is_not_said(world: World) -> None:
    said = {'mass': 4.0, 'friction': 0.25, 'elasticity': 0.75, 'group': 5, 'sensor': True}
    spawn(world, 'a/0', DISC, color=RED, lifetime=9.0, **said)
    before = body(world, 'a/0')

    answer = world.apply(spawning('a/0', BOX, (1.0, 2.0, 0.3)))

    after = body(world, 'a/0')
    assert answer == ('a/0', 'changed a/0')
    assert after.shape == BOX
    assert pose(world, 'a/0') == pytest.approx((1.0, 2.0, 0.3), abs=ROUNDING)
    assert (after.color, after.expires) == (before.color, before.expires)
    assert (after.mass, after.friction, after.elasticity) == (4.0, 0.25, 0.75)
    assert (after.group, after.sensor) == (5, True)


@pytest.mark.parametrize('shape', [DISC, BOX, ELL], ids=['same shape', 'box', 'ell'])
def test_a_change_keeps_the_motion_in_the_middle_of_it(shape: Shape) -> None:
    world = World()
    spawn(world, 'a/0', DISC, velocity=(1.0, 5.0), spin=2.0)
    world.step(24)
    before = twist(world, 'a/0')

    spawn(world, 'a/0', shape, (0.0, 7.0, 0.0))

    assert before == pytest.approx((1.0, 5.0 - 0.981, 2.0), abs=1e-9)
    assert twist(world, 'a/0') == pytest.approx(before, abs=1e-12)
    # And it flies on as a projectile does.
    world.step(24)
    assert twist(world, 'a/0') == pytest.approx((1.0, 5.0 - 1.962, 2.0), abs=1e-9)


def test_a_change_takes_over_what_is_said(world: World) -> None:
    spawn(world, 'a/0', DISC, velocity=(1.0, 2.0), spin=3.0, mass=2.0)

    spawn(world, 'a/0', DISC, velocity=(5.0, 6.0))
    assert twist(world, 'a/0') == pytest.approx((5.0, 6.0, 3.0), abs=ROUNDING)
    spawn(world, 'a/0', DISC, spin=0.0)
    assert twist(world, 'a/0') == pytest.approx((5.0, 6.0, 0.0), abs=ROUNDING)
    spawn(world, 'a/0', DISC, density=3.0, friction=0.5, color=BLUE, lifetime=0.5)

    after = body(world, 'a/0')
    assert (after.mass, after.density, after.friction) == (None, 3.0, 0.5)
    assert (after.color, after.expires) == (BLUE, 120)
    assert twist(world, 'a/0') == pytest.approx((5.0, 6.0, 0.0), abs=ROUNDING)


def test_a_change_keeps_the_place_in_the_order_and_on_top(world: World) -> None:
    for name in ('a/0', 'a/1', 'a/2'):
        spawn(world, name, DISC)

    spawn(world, 'a/0', BOX)
    spawn(world, 'a/1', DISC, color=RED)

    assert names(world) == ('a/0', 'a/1', 'a/2')
    assert body_at(world, (0.0, 0.0)) == 'a/2'
    assert len(world) == 3


def test_a_recoloured_body_that_rests_does_not_stir() -> None:
    settings = WorldSettings(bounds=(-9.0, 0.0, 9.0, 99.0))
    world, other = World(settings=settings), World(settings=settings)
    for each in (world, other):
        stack(each, 5)
        each.step(240)

    spawn(world, 'stack/2', BOX, tuple(pose(world, 'stack/2').tolist()), color=RED)
    for each in (world, other):
        each.step(240)

    assert body(world, 'stack/2').color == RED
    assert np.array_equal(world.snapshot().poses, other.snapshot().poses)


def test_a_change_that_changes_nothing_leaves_the_digest() -> None:
    world = World()
    spawn(world, 'a/0', BOX, velocity=(1.0, 0.0))
    world.step(10)
    before = world.digest()

    spawn(world, 'a/0', BOX, tuple(pose(world, 'a/0').tolist()))

    assert world.digest() == before


def test_a_wrench_stays_through_a_change(world: World) -> None:
    spawn(world, 'a/0', DISC, mass=2.0)
    world.apply(Configure(changes={'command_timeout': 0.0}))
    world.apply(Command(names=('a/0',), wrenches=((4.0, 0.0, 0.0),)))
    world.step(120)

    spawn(world, 'a/0', BOX, (0.0, 0.0, 0.0), mass=1.0)
    assert twist(world, 'a/0') == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)
    world.step(120)

    # 2 m/s² for half a second, then 4 m/s².
    assert twist(world, 'a/0') == pytest.approx((3.0, 0.0, 0.0), abs=1e-9)


def test_a_body_can_be_anchored_and_freed_by_a_change(world: World) -> None:
    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.7), velocity=(1.0, 0.0), spin=1.0)
    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.7), anchored=True)
    world.step(24)
    assert pose(world, 'a/0') == pytest.approx((1.0, 2.0, 0.7), abs=ROUNDING)
    assert twist(world, 'a/0').tolist() == [0.0, 0.0, 0.0]

    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.7), anchored=False, velocity=(0.0, 1.0))

    assert pose(world, 'a/0') == pytest.approx((1.0, 2.0, 0.7), abs=ROUNDING)
    assert twist(world, 'a/0') == pytest.approx((0.0, 1.0, 0.0), abs=ROUNDING)


# Delete


def test_a_deleted_body_is_gone(world: World) -> None:
    for name in ('a/0', 'a/1', 'a/2'):
        spawn(world, name, DISC)

    answer = world.apply(Delete(name='a/1'))

    assert answer == ('a/1', 'deleted a/1')
    assert names(world) == ('a/0', 'a/2')
    assert 'a/1' not in world
    with pytest.raises(UnknownBody):
        world.apply(Delete(name='a/1'))


def test_a_name_can_be_used_again_and_comes_last(world: World) -> None:
    spawn(world, 'a/0', DISC, mass=3.0, velocity=(1.0, 0.0))
    spawn(world, 'a/1', DISC)
    world.apply(Delete(name='a/0'))

    spawn(world, 'a/0', DISC)

    assert names(world) == ('a/1', 'a/0')
    assert body(world, 'a/0').mass is None
    assert twist(world, 'a/0').tolist() == [0.0, 0.0, 0.0]


def test_all_bodies_of_a_namespace_are_deleted_and_no_others(world: World) -> None:
    for name in ('a/0', 'b/0', 'a/1', 'ab/0', 'a/b/0'):
        spawn(world, name, DISC)

    answer = world.apply(DeleteAll(namespace='a'))

    assert answer == ('', 'deleted 2 bodies')
    assert names(world) == ('b/0', 'ab/0', 'a/b/0')
    assert world.apply(DeleteAll(namespace='nobody')) == ('', 'deleted 0 bodies')


def test_everything_is_deleted_and_the_world_goes_on(world: World) -> None:
    for number in range(5):
        spawn(world, f'a/{number}', DISC, anchored=number % 2 == 0)
    world.step(2)

    world.apply(DeleteAll())
    world.step(2)

    assert names(world) == ()
    assert len(world) == 0
    assert world.snapshot().poses.shape == (0, 3)
    assert world.step_count == 4
    spawn(world, 'a/0', DISC)
    world.step(1)
    assert names(world) == ('a/0',)


# Lifetime


@pytest.mark.parametrize(
    ('rate', 'lifetime', 'steps'),
    [(240.0, 0.1, 24), (240.0, 1e-9, 1), (240.0, 1 / 240, 1), (240.0, 1.5 / 240, 2),
     (1000.0, 0.7, 700), (60.0, 0.05, 3), (10000.0, 30673452 / 10000.0, 30673452)],
)  # fmt: skip
def test_a_lifetime_ends_at_its_step(rate: float, lifetime: float, steps: int) -> None:
    world = World(physics_rate=rate)
    spawn(world, 'a/0', DISC)
    world.step(7)

    spawn(world, 'a/0', DISC, lifetime=lifetime)

    assert body(world, 'a/0').expires == 7 + steps
    if steps < 1000:
        world.step(steps - 1)
        assert 'a/0' in world
        world.step(1)
        assert 'a/0' not in world


def test_lifetimes_end_within_many_steps_as_one_by_one(world: World) -> None:
    for number in range(5):
        spawn(world, f'a/{number}', DISC, (3.0 * number, 0.0, 0.0), lifetime=(5 - number) / 240)

    world.step(3)

    assert names(world) == ('a/0', 'a/1')


def test_a_lifetime_is_kept_until_another_is_said(world: World) -> None:
    spawn(world, 'a/0', DISC, lifetime=10 / 240)
    world.step(5)

    spawn(world, 'a/0', BOX)
    assert body(world, 'a/0').expires == 10
    spawn(world, 'a/0', BOX, lifetime=10 / 240)
    assert body(world, 'a/0').expires == 15


def test_who_dies_under_another_leaves_it_falling() -> None:
    world = World()
    spawn(world, 'floor/0', BOX, (0.0, -0.5, 0.0), anchored=True, lifetime=0.5)
    spawn(world, 'a/0', BOX, (0.0, 0.5, 0.0))
    world.step(120)
    assert pose(world, 'a/0')[1] == pytest.approx(0.5, abs=0.005)

    world.step(120)

    # It rested in the slop of 5 mm, and fell for half a second.
    assert pose(world, 'a/0')[1] == pytest.approx(0.5 - 9.81 / 8, abs=0.02)


# A full world


def test_a_full_world_takes_no_more_but_changes_what_it_has() -> None:
    world = World(settings=WorldSettings(max_bodies=2))
    spawn(world, 'a/0')
    spawn(world, 'a/1')

    with pytest.raises(WorldFull):
        spawn(world, 'a/2')
    spawn(world, 'a/1', BOX)
    world.apply(Delete(name='a/0'))
    spawn(world, 'a/2')

    assert names(world) == ('a/1', 'a/2')


def test_a_world_made_smaller_keeps_its_bodies() -> None:
    world = World()
    for number in range(3):
        spawn(world, f'a/{number}')

    world.apply(Configure(changes={'max_bodies': 1}))

    assert len(world) == 3
    with pytest.raises(WorldFull):
        spawn(world, 'a/3')


# Frames


@pytest.mark.parametrize('shape', [DISC, ELL], ids=['centred', 'off-centre'])
@pytest.mark.parametrize('anchored', [False, True])
def test_a_pose_may_be_relative_to_a_turned_body(
    shape: Shape, anchored: bool, world: World
) -> None:
    spawn(world, 'table/0', shape, (2.0, 1.0, math.pi / 2), anchored=anchored)

    spawn(world, 'cup/0', DISC, (3.0, 1.0, 0.2), frame='table/0')

    # Ahead along its x axis is up; left of it is to the left.
    assert pose(world, 'cup/0') == pytest.approx((1.0, 4.0, math.pi / 2 + 0.2), abs=1e-12)


def test_a_frame_is_where_the_body_is_by_then(world: World) -> None:
    spawn(world, 'table/0', DISC, velocity=(1.0, 0.0), spin=math.pi / 2)
    world.step(240)

    spawn(world, 'cup/0', DISC, (3.0, 0.0, 0.0), frame='table/0')

    assert pose(world, 'cup/0') == pytest.approx((1.0, 3.0, math.pi / 2), abs=1e-9)
    # It is put there, not tied to it.
    assert twist(world, 'cup/0').tolist() == [0.0, 0.0, 0.0]


def test_a_body_can_be_moved_relative_to_itself(world: World) -> None:
    spawn(world, 'a/0', DISC, (1.0, 1.0, math.pi))

    spawn(world, 'a/0', DISC, (2.0, 0.0, 0.0), frame='a/0')

    assert pose(world, 'a/0') == pytest.approx((-1.0, 1.0, math.pi), abs=1e-12)


def test_commanded_poses_may_be_relative_to_a_body_that_is_moved_too(world: World) -> None:
    spawn(world, 'a/0', DISC, (1.0, 0.0, math.pi / 2))
    spawn(world, 'a/1', DISC)

    world.apply(
        Command(names=('a/0', 'a/1'), poses=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)), frame='a/0')
    )

    assert pose(world, 'a/0') == pytest.approx((1.0, 1.0, math.pi / 2), abs=1e-12)
    assert pose(world, 'a/1') == pytest.approx((0.0, 0.0, math.pi / 2), abs=1e-12)


# Anchoring and releasing by a point

EDGES = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)]


@pytest.mark.parametrize('yaw', [0.0, 0.7, -2.0, math.pi])
@pytest.mark.parametrize('anchored', [False, True])
@pytest.mark.parametrize('edge', EDGES)
def test_a_point_is_in_a_turned_box_up_to_each_edge(
    yaw: float, anchored: bool, edge: tuple[float, float], world: World
) -> None:
    spawn(world, 'a/0', Box(width=2.0, height=1.0), (10.0, -3.0, yaw), anchored=anchored)
    half = 1.0 if edge[0] else 0.5
    cos, sin = math.cos(yaw), math.sin(yaw)

    def at(distance: float) -> tuple[float, float]:
        x, y = edge[0] * distance, edge[1] * distance
        return 10.0 + cos * x - sin * y, -3.0 + sin * x + cos * y

    assert body_at(world, at(half - 1e-6)) == 'a/0'
    assert body_at(world, at(half + 1e-6)) is None


@pytest.mark.parametrize('angle', [0.0, 0.7, 2.0, 4.0])
def test_a_point_is_in_a_disc_up_to_its_rim(angle: float, world: World) -> None:
    spawn(world, 'a/0', DISC, (1.0, 1.0, 0.0))
    x, y = math.cos(angle), math.sin(angle)

    assert body_at(world, (1.0 + 0.499999 * x, 1.0 + 0.499999 * y)) == 'a/0'
    assert body_at(world, (1.0 + 0.500001 * x, 1.0 + 0.500001 * y)) is None


@pytest.mark.parametrize('yaw', [0.0, 0.7])
def test_a_point_in_the_notch_of_an_ell_is_outside_it(yaw: float, world: World) -> None:
    spawn(world, 'a/0', ELL, (0.0, 0.0, yaw))
    cos, sin = math.cos(yaw), math.sin(yaw)
    for x, y, inside in (
        (0.5, 1.5, True),
        (1.5, 0.5, True),
        (0.5, 0.5, True),
        (1.5, 1.5, False),
        (1.01, 1.01, False),
        (0.99, 0.99, True),
        (-0.01, 0.5, False),
    ):
        found = body_at(world, (cos * x - sin * y, sin * x + cos * y))
        assert (found == 'a/0') is inside


def test_a_point_on_the_seam_of_two_pieces_is_inside(world: World) -> None:
    # Two triangles make a square; its middle lies on the side that they share.
    square = Triangles(
        vertices=((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
    )
    spawn(world, 'a/0', square)
    spawn(world, 'a/1', ELL, (10.0, 0.0, 0.0))

    assert body_at(world, (0.0, 0.0)) == 'a/0'
    assert body_at(world, (0.5, 0.5)) == 'a/0'
    for share in np.linspace(0.01, 0.99, 21).tolist():
        # Any way from the inner corner of the ell to its outer ones is inside it.
        for x, y in ((0.0, 0.0), (2.0, 0.0), (0.0, 2.0), (1.0, 0.0), (0.0, 1.0)):
            point = (10.0 + 1.0 + share * (x - 1.0), 1.0 + share * (y - 1.0))
            assert body_at(world, point) == 'a/1'


def test_the_topmost_is_the_one_that_spawned_last(world: World) -> None:
    for name in ('a/3', 'a/1', 'a/2'):
        spawn(world, name, DISC)

    assert body_at(world, (0.1, 0.1)) == 'a/2'
    world.apply(Delete(name='a/2'))
    assert body_at(world, (0.1, 0.1)) == 'a/1'


def test_sensors_and_grouped_bodies_are_found_under_a_point(world: World) -> None:
    spawn(world, 'a/0', DISC, sensor=True)
    spawn(world, 'a/1', DISC, (3.0, 0.0, 0.0), group=1)

    assert body_at(world, (0.0, 0.0)) == 'a/0'
    assert body_at(world, (3.0, 0.0)) == 'a/1'


def test_walls_are_no_bodies() -> None:
    world = World(settings=WorldSettings(bounds=(-1.0, -1.0, 1.0, 1.0)))

    assert body_at(world, (0.0, -1.5)) is None
    with pytest.raises(NothingThere):
        world.apply(Anchor(point=(0.0, -1.5)))


@pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())
def test_an_anchored_body_stays_where_it_was_and_released_it_falls(shape: Shape) -> None:
    world = World()
    spawn(world, 'a/0', shape, (1.0, 5.0, 0.7), velocity=(1.0, 2.0), spin=3.0)
    world.step(12)
    held = pose(world, 'a/0')
    x, y = shape.form.centroid
    point = (0.5, 0.5) if shape is ELL else (-0.3, 0.0) if shape is SHAPES['discs'] else (x, y)
    point = (0.0, 0.2) if shape is SHAPES['chain'] else point
    point = (0.0, 0.0) if shape is SHAPES['boxes'] else point

    assert world.apply(Anchor(point=point, frame='a/0')) == ('a/0', 'anchored a/0')
    assert pose(world, 'a/0') == pytest.approx(held, abs=ROUNDING)
    world.step(24)
    assert pose(world, 'a/0') == pytest.approx(held, abs=ROUNDING)
    assert twist(world, 'a/0').tolist() == [0.0, 0.0, 0.0]

    assert world.apply(Release(point=point, frame='a/0')) == ('a/0', 'released a/0')
    assert pose(world, 'a/0') == pytest.approx(held, abs=ROUNDING)
    assert twist(world, 'a/0') == pytest.approx((0.0, 0.0, 0.0), abs=ROUNDING)
    world.step(24)
    # A fall of a tenth of a second: the free flight is exact.
    assert pose(world, 'a/0') == pytest.approx(held - (0.0, 9.81 / 200, 0.0), abs=1e-9)


def test_anchoring_twice_and_releasing_twice_is_no_mistake(world: World) -> None:
    spawn(world, 'a/0', DISC, velocity=(1.0, 0.0))
    assert world.apply(Release(point=(0.0, 0.0))) == ('a/0', 'released a/0')
    assert twist(world, 'a/0').tolist() == [1.0, 0.0, 0.0]

    world.apply(Anchor(point=(0.0, 0.0)))
    before = world.digest()
    assert world.apply(Anchor(point=(0.0, 0.0))) == ('a/0', 'anchored a/0')
    assert world.digest() == before


def test_only_the_topmost_body_is_anchored(world: World) -> None:
    spawn(world, 'a/0', DISC)
    spawn(world, 'a/1', DISC)

    world.apply(Anchor(point=(0.0, 0.0)))

    assert not body(world, 'a/0').anchored
    assert body(world, 'a/1').anchored


@pytest.mark.parametrize('born', [True, False], ids=['from birth', 'later'])
def test_an_anchored_body_still_answers_to_changes(born: bool) -> None:
    world = World()
    spawn(world, 'a/0', BOX, (0.0, 0.0, 0.7), anchored=born)
    if not born:
        world.apply(Anchor(point=(0.0, 0.0)))

    spawn(world, 'a/0', BOX, (4.0, 0.0, 0.7), color=RED)
    assert body(world, 'a/0').color == RED
    assert body(world, 'a/0').anchored
    assert body_at(world, (4.0, 0.0)) == 'a/0'
    assert body_at(world, (0.0, 0.0)) is None

    spawn(world, 'a/0', Box(width=3.0, height=1.0), (4.0, 0.0, 0.0))
    assert body_at(world, (5.4, 0.0)) == 'a/0'

    world.apply(Command(names=('a/0',), poses=((-4.0, 1.0, math.pi / 2),)))
    assert pose(world, 'a/0').tolist() == [-4.0, 1.0, math.pi / 2]
    assert body_at(world, (-4.0, 2.4)) == 'a/0'
    assert body_at(world, (-5.4, 1.0)) is None

    # Other bodies land on it at its new pose.
    spawn(world, 'b/0', Disc(radius=0.2), (-4.0, 3.0, 0.0), elasticity=0.0)
    world.step(240)
    assert pose(world, 'b/0')[1] == pytest.approx(2.7, abs=0.006)

    world.apply(Release(point=(-4.0, 1.0)))
    world.step(24)
    assert pose(world, 'a/0')[1] < 1.0


def test_an_anchored_body_is_never_moved_by_hits(world: World) -> None:
    spawn(world, 'a/0', BOX, (0.1, 0.2, 0.7))
    world.apply(Anchor(point=(0.1, 0.2)))
    held = pose(world, 'a/0').tolist()
    for number in range(8):
        angle = 2 * math.pi * number / 8
        x, y = math.cos(angle), math.sin(angle)
        spawn(world, f'hit/{number}', DISC, (3 * x, 3 * y, 0.0), velocity=(-20 * x, -20 * y),
              mass=100.0)  # fmt: skip

    world.step(240)

    assert pose(world, 'a/0').tolist() == held
    assert twist(world, 'a/0').tolist() == [0.0, 0.0, 0.0]
    speeds = np.hypot(*world.snapshot().twists[1:, :2].T)
    assert (speeds > 1.0).all()


# Saved states


@pytest.mark.parametrize('steps', [0, 1, 100])
def test_a_state_is_restored_into_the_same_digest(steps: int) -> None:
    world = busy_world()
    world.step(steps)
    before = world.digest()

    state = world.save()
    assert world.digest() == before
    world.apply(Restore(state=state))

    assert world.digest() == before
    assert world.save() == state


def test_a_restored_world_is_built_once_and_is_its_first_checkpoint(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = World()
    stack(world, 8)
    state, built = replace(world.save(), memory=None), list[str]()
    build = rigid_body.build
    monkeypatch.setattr(
        rigid_body, 'build', lambda body, serial: built.append(body.name) or build(body, serial)
    )

    simulation = Simulation()
    simulation.begin(state)

    assert built == [each.body.name for each in state.bodies]
    digest = simulation.world.digest()
    simulation.advance_frame()
    simulation.seek(0)
    assert simulation.world.digest() == digest


def test_two_worlds_restored_from_one_state_go_on_alike_at_any_step() -> None:
    world = busy_world()
    world.step(100)
    state = world.save()
    first, second = World(), World()
    second.step(37)

    first.apply(Restore(state=state))
    second.apply(Restore(state=state))
    for _ in range(5):
        first.step(40)
        second.step(40)
        assert first.save() == second.save()
    assert np.array_equal(first.snapshot().poses, second.snapshot().poses)
    assert first.step_count == second.step_count - 37


def test_a_restored_world_goes_on_alike_with_the_requests_that_follow() -> None:
    world = busy_world()
    world.apply(Delete(name='mix/0'))
    world.step(50)
    state = world.save()
    worlds = [World(), World()]

    for each in worlds:
        each.apply(Restore(state=state))
    worlds[1].apply(Restore(state=worlds[1].save()))
    for each in worlds:
        # A colour that nobody chose, an end of a wrench and a lifetime are to come alike.
        spawn(each, 'late/0', ELL, (0.0, 8.0, 0.0), lifetime=0.2)
        each.apply(Command(names=('late/0', 'mix/1'), wrenches=((1.0, 0.0, 0.0),) * 2))
        each.step(120)

    assert worlds[0].digest() == worlds[1].digest()


def test_restoring_replaces_everything_but_the_time() -> None:
    world = World(settings=WorldSettings(max_bodies=7))
    spawn(world, 'a/0', DISC)
    state = world.save()
    world.apply(Configure(changes={'gravity': (1.0, 0.0), 'bounds': (-9.0, -9.0, 9.0, 9.0)}))
    spawn(world, 'a/1', DISC, (4.0, 0.0, 0.0))
    world.step(10)

    answer = world.apply(Restore(state=state))

    assert answer == ('', 'loaded 1 bodies')
    assert names(world) == ('a/0',)
    assert world.settings == WorldSettings(max_bodies=7)
    assert world.step_count == 10
    # The walls have gone with the rest.
    world.step(480)
    assert pose(world, 'a/0')[1] < -10.0


def test_a_saved_state_is_not_changed_by_what_follows() -> None:
    world = busy_world()
    state = world.save()
    text = repr(state)

    world.step(20)
    world.apply(DeleteAll())

    assert repr(state) == text


# The same requests, the same bits


def busy_world() -> World:
    """Return a world with all shapes, roles, and everything that decides how it goes on."""
    world = World(settings=WorldSettings(bounds=(-12.0, 0.0, 12.0, 30.0), damping=0.05))
    stack(world, 4)
    for number, shape in enumerate(SHAPES.values()):
        spawn(world, f'mix/{number}', shape, (2.6 * number - 9.0, 6.0 + number, 0.4 * number),
              velocity=(number - 3.0, -1.0), spin=number - 2.0)  # fmt: skip
    spawn(world, 'peg/0', DISC, (3.0, 3.0, 0.0), anchored=True)
    spawn(world, 'lift/0', BOX, (-6.0, 2.0, 0.1), kinematic=True, velocity=(0.5, 0.0))
    spawn(world, 'gate/0', Box(width=4.0, height=4.0), (5.0, 5.0, 0.0), sensor=True,
          anchored=True)  # fmt: skip
    spawn(world, 'ghost/0', DISC, (7.0, 1.0, 0.0), group=3)
    spawn(world, 'ghost/1', DISC, (7.2, 1.0, 0.0), group=3)
    spawn(world, 'brief/0', DISC, (9.0, 1.0, 0.0), lifetime=0.6)
    # In another order than they were spawned.
    world.apply(Command(names=('mix/3', 'mix/1'), wrenches=((3.0, 1.0, 0.5), (-2.0, 0.0, 0.0))))
    return world


def chronicle() -> list[str]:
    """Return digests along the way of a busy world."""
    world = busy_world()
    digests = [world.digest()]
    for number in range(6):
        world.step(20)
        spawn(world, f'rain/{number}', Disc(radius=0.2), (0.1 * number, 12.0, 0.0))
        if number == 2:
            world.apply(Anchor(point=(0.0, 0.5)))
            world.apply(Configure(changes={'gravity': (1.0, -9.81), 'iterations': 15}))
        if number == 4:
            world.apply(Delete(name='mix/2'))
        digests.append(world.digest())
    return digests


def test_the_same_requests_give_the_same_digests() -> None:
    first = chronicle()

    assert chronicle() == first
    assert len(set(first)) == len(first)


@pytest.mark.parametrize('seed', ['0', '1234'])
def test_the_same_requests_give_the_same_digests_in_another_process(seed: str) -> None:
    program = 'from test.simulation.test_world import chronicle; print(*chronicle())'
    root = str(Path(__file__).parents[2])

    done = subprocess.run(
        [sys.executable, '-c', program],
        env={**os.environ, 'PYTHONHASHSEED': seed, 'PYTHONPATH': root},
        cwd=root,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        timeout=60,
    )

    assert done.stdout.split() == chronicle()


def test_many_steps_are_as_many_times_one() -> None:
    one_by_one, at_once = busy_world(), busy_world()

    for count in (1, 3, 4, 7, 16, 33, 120):
        at_once.step(count)
        for _ in range(count):
            one_by_one.step(1)
        assert at_once.digest() == one_by_one.digest()


@pytest.mark.parametrize('timeout', [1 / 240, 0.01, 0.03])
def test_a_wrench_that_ends_between_frames_ends_alike_however_steps_are_counted_out(
    timeout: float,
) -> None:
    worlds = []
    for _ in range(2):
        world = World(
            settings=WorldSettings(bounds=(-9.0, 0.0, 9.0, 9.0), command_timeout=timeout)
        )
        spawn(world, 'a/0', BOX, (0.0, 0.52, 0.0))
        world.apply(Command(names=('a/0',), wrenches=((3.0, -20.0, 0.5),)))
        worlds.append(world)

    for _ in range(10):
        worlds[0].step(4)
    for _ in range(40):
        worlds[1].step(1)

    assert worlds[0].digest() == worlds[1].digest()


@pytest.mark.parametrize('looking', ['snapshot', 'save', 'digest', 'contacts', 'body_at'])
def test_looking_changes_nothing(looking: str) -> None:
    world, unseen = busy_world(), busy_world()
    world.watching = looking == 'contacts'

    for _ in range(30):
        world.step(4)
        unseen.step(4)
        match looking:
            case 'contacts':
                world.contacts(world.snapshot())
            case 'body_at':
                body_at(world, (0.0, 0.5))
            case _:
                getattr(world, looking)()

    assert world.digest() == unseen.digest()


CHANGES: dict[str, Callable[[World], object]] = {
    'a step': lambda world: world.step(1),
    'a body': lambda world: spawn(world, 'new/0', DISC, (0.0, 20.0, 0.0)),
    'a body less': lambda world: world.apply(Delete(name='mix/1')),
    'a colour': lambda world: spawn(world, 'peg/0', DISC, (3.0, 3.0, 0.0), color=RED),
    'a lifetime': lambda world: spawn(world, 'peg/0', DISC, (3.0, 3.0, 0.0), lifetime=9.0),
    'a pose': lambda world: world.apply(Command(names=('mix/1',), poses=((0.0, 20.0, 0.0),))),
    'a velocity': lambda world: world.apply(
        Command(names=('mix/1',), twists=((1.0, 0.0, math.nextafter(1.0, 2.0)),))
    ),
    'a wrench': lambda world: world.apply(
        Command(names=('mix/2',), wrenches=((0.0, 0.0, 1e-300),))
    ),
    'how long a wrench acts': lambda world: (
        world.apply(Configure(changes={'command_timeout': 0.25})),
        world.apply(Command(names=('mix/3',), wrenches=((3.0, 1.0, 0.5),))),
        world.apply(Configure(changes={'command_timeout': 0.5})),
    ),
    'an anchor': lambda world: world.apply(Anchor(point=(0.0, 0.5))),
    'gravity': lambda world: world.apply(Configure(changes={'gravity': (0.0, -9.8)})),
    'iterations': lambda world: world.apply(Configure(changes={'iterations': 11})),
    'a default': lambda world: world.apply(Configure(changes={'friction': 0.51})),
}


@pytest.mark.parametrize('change', CHANGES.values(), ids=CHANGES.keys())
def test_whatever_decides_how_the_world_goes_on_is_in_the_digest(
    change: Callable[[World], object],
) -> None:
    world = busy_world()
    before = world.digest()

    change(world)

    assert world.digest() != before


# A refusal changes nothing

REFUSED: dict[str, tuple[Callable[[], Request], type[Refusal], str]] = {
    'a body too many': (lambda: spawning('new/0'), WorldFull, ''),
    'a body in no frame': (lambda: spawning('mix/0', frame='nobody/0'), UnknownFrame,
                           'header.frame_id'),
    'a body in the frame of the world by name': (lambda: spawning('mix/0', frame='world'),
                                                 UnknownFrame, 'header.frame_id'),
    'a body too far by its frame': (
        lambda: spawning('mix/0', DISC, (FARTHEST, 0.0, 0.0), frame='far/0'), BadProperty, 'pose'),
    'a body too heavy': (lambda: spawning('mix/0', Disc(radius=1e4), density=1e12), BadProperty,
                         'density'),
    'a body too light': (lambda: spawning('mix/0', Disc(radius=1e-3), density=1e-9), BadProperty,
                         'density'),
    'a body too heavy by the density it has': (lambda: spawning('dense/0', Disc(radius=10.0)),
                                               BadProperty, 'density'),
    'an anchored body with a velocity': (
        lambda: spawning('peg/0', DISC, velocity=(1.0, 0.0)), Anchored, 'velocity'),
    'an anchored body with a spin': (lambda: spawning('peg/0', DISC, spin=1.0), Anchored,
                                     'velocity'),
    'to anchor a moving body': (
        lambda: spawning('mix/0', DISC, anchored=True, velocity=(0.0, 1.0)), Anchored, 'velocity'),
    'to delete nobody': (lambda: Delete(name='nobody/0'), UnknownBody, 'name'),
    'to delete the world': (lambda: Delete(name='world'), UnknownBody, 'name'),
    'to anchor nothing': (lambda: Anchor(point=(0.0, 29.0)), NothingThere, 'point'),
    'to release nothing': (lambda: Release(point=(0.0, 29.0)), NothingThere, 'point'),
    'to anchor in no frame': (lambda: Anchor(point=(0.0, 0.0), frame='nobody/0'), UnknownFrame,
                              'header.frame_id'),
    'to release too far': (lambda: Release(point=(FARTHEST, 0.0), frame='far/0'), BadProperty,
                           'pose'),
    'to command nobody': (lambda: Command(names=('nobody/0',), poses=((0.0, 0.0, 0.0),)),
                          UnknownBody, 'joint_names'),
    'to command one body and nobody': (
        lambda: Command(names=('mix/0', 'nobody/0'), poses=((0.0, 0.0, 0.0),) * 2), UnknownBody,
        'joint_names'),
    'to pose a body in no frame': (
        lambda: Command(names=('mix/0',), poses=((0.0, 0.0, 0.0),), frame='nobody/0'),
        UnknownFrame, 'header.frame_id'),
    'to pose the second too far': (
        lambda: Command(names=('mix/0', 'mix/1'), frame='far/0',
                        poses=((0.0, 0.0, 0.0), (FARTHEST, 0.0, 0.0))), BadProperty, 'pose'),
    'a twist for an anchored body': (
        lambda: Command(names=('mix/0', 'peg/0'), twists=((1.0, 0.0, 0.0),) * 2), Anchored,
        'joint_names'),
    'a wrench for an anchored body': (
        lambda: Command(names=('mix/0', 'peg/0'), wrenches=((1.0, 0.0, 0.0),) * 2,
                        poses=((0.0, 0.0, 0.0),) * 2), Anchored, 'joint_names'),
    'a wrench for a kinematic body': (
        lambda: Command(names=('mix/0', 'lift/0'), wrenches=((1.0, 0.0, 0.0),) * 2,
                        twists=((1.0, 0.0, 0.0),) * 2), BadProperty, 'wrench'),
    'settings out of range': (lambda: Configure(changes={'friction': 0.1, 'damping': 2.0}),
                              BadProperty, 'damping'),
    'settings that are none': (lambda: Configure(changes={'gravity': (0.0, math.nan)}), Malformed,
                               'gravity'),
}  # fmt: skip


@pytest.mark.parametrize(('make', 'error', 'field'), REFUSED.values(), ids=REFUSED.keys())
@pytest.mark.parametrize('steps', [0, 30])
def test_a_refusal_changes_nothing(
    make: Callable[[], Request], error: type[Refusal], field: str, steps: int
) -> None:
    world, other = busy_world(), busy_world()
    for each in (world, other):
        spawn(each, 'far/0', DISC, (100.0, 0.0, 0.0), anchored=True)
        spawn(each, 'dense/0', Disc(radius=0.01), (9.0, 9.0, 0.0), density=1e10)
        each.apply(Configure(changes={'max_bodies': len(each)}))
        each.step(steps)
    before = world.digest()

    with pytest.raises(Refusal) as refused:
        world.apply(make())

    assert type(refused.value) is error
    assert refused.value.field == field
    assert world.digest() == before
    # Nor has it changed what no digest shows.
    world.step(60)
    other.step(60)
    assert world.digest() == other.digest()
    assert world.save() == other.save()


# Time


def test_time_is_the_steps_and_never_a_running_sum() -> None:
    world = World(physics_rate=300.0)

    world.step(7)

    assert world.step_count == world.snapshot().step == 7
    assert world.stamp == world.snapshot().stamp == 23_333_333


def test_a_snapshot_is_not_changed_by_what_follows(world: World) -> None:
    spawn(world, 'a/0', TRIANGLE, velocity=(1.0, 0.0))
    snapshot = world.snapshot()
    poses, twists = snapshot.poses.copy(), snapshot.twists.copy()

    snapshot.poses.flags.writeable = False
    world.step(10)
    world.apply(DeleteAll())

    assert np.array_equal(snapshot.poses, poses)
    assert np.array_equal(snapshot.twists, twists)
    assert snapshot.scene.names == ('a/0',)


def test_a_scene_is_the_same_object_until_something_changes(world: World) -> None:
    spawn(world, 'a/0', DISC)
    scene = world.snapshot().scene

    world.step(3)
    world.apply(Command(names=('a/0',), poses=((1.0, 0.0, 0.0),)))
    assert world.snapshot().scene is scene

    spawn(world, 'a/0', DISC, (1.0, 0.0, 0.0), color=RED)
    assert world.snapshot().scene is not scene
