# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A body that is spawned again, anchored or released is changed in place."""

import math

import numpy as np
from physsim_ros.model.errors import NothingThere
from physsim_ros.model.requests import Anchor, Command, Configure, Delete, Release
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.world import World
import pytest

from ..building import (
    BLUE,
    body,
    body_at,
    BOX,
    DISC,
    ELL,
    names,
    pose,
    RED,
    ROUNDING,
    SHAPES,
    spawn,
    spawning,
    stack,
    twist,
)

# Change in place


def test_a_change_keeps_what_is_not_said(world):
    said = {'mass': 4.0, 'friction': 0.25, 'elasticity': 0.75, 'group': 5, 'sensor': True,
            'label': 'm1'}  # fmt: skip
    spawn(world, 'a/0', DISC, color=RED, lifetime=9.0, **said)
    before = body(world, 'a/0')

    answer = world.apply(spawning('a/0', BOX, (1.0, 2.0, 0.3)))

    after = body(world, 'a/0')
    assert answer == Answer(subject='a/0', message='changed a/0')
    assert after.shape == BOX
    assert pose(world, 'a/0') == pytest.approx((1.0, 2.0, 0.3), abs=ROUNDING)
    assert (after.color, after.expires) == (before.color, before.expires)
    assert (after.mass, after.friction, after.elasticity) == (4.0, 0.25, 0.75)
    assert (after.group, after.sensor, after.label) == (5, True, 'm1')


@pytest.mark.parametrize('shape', [DISC, BOX, ELL], ids=['same shape', 'box', 'ell'])
def test_a_change_keeps_the_motion_in_the_middle_of_it(shape):
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


def test_a_change_takes_over_what_is_said(world):
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


def test_a_change_keeps_the_place_in_the_order_and_on_top(world):
    for name in ('a/0', 'a/1', 'a/2'):
        spawn(world, name, DISC)

    spawn(world, 'a/0', BOX)
    spawn(world, 'a/1', DISC, color=RED)

    assert names(world) == ('a/0', 'a/1', 'a/2')
    assert body_at(world, (0.0, 0.0)) == 'a/2'
    assert len(world) == 3


def test_a_recoloured_and_labelled_body_that_rests_does_not_stir():
    settings = WorldSettings(bounds=(-9.0, 0.0, 9.0, 99.0))
    world, other = World(settings=settings), World(settings=settings)
    for each in (world, other):
        stack(each, 5)
        each.step(240)

    spawn(world, 'stack/2', BOX, tuple(pose(world, 'stack/2').tolist()), color=RED, label='m')
    for each in (world, other):
        each.step(240)

    assert (body(world, 'stack/2').color, body(world, 'stack/2').label) == (RED, 'm')
    assert world.digest() != other.digest()
    assert np.array_equal(world.snapshot().poses, other.snapshot().poses)


def test_a_change_that_changes_nothing_leaves_the_digest():
    world = World()
    spawn(world, 'a/0', BOX, velocity=(1.0, 0.0))
    world.step(10)
    before = world.digest()

    spawn(world, 'a/0', BOX, tuple(pose(world, 'a/0').tolist()))

    assert world.digest() == before


def test_a_wrench_stays_through_a_change(world):
    spawn(world, 'a/0', DISC, mass=2.0)
    world.apply(Configure(changes={'command_timeout': 0.0}))
    world.apply(Command(names=('a/0',), wrenches=((4.0, 0.0, 0.0),)))
    world.step(120)

    spawn(world, 'a/0', BOX, (0.0, 0.0, 0.0), mass=1.0)
    assert twist(world, 'a/0') == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)
    world.step(120)

    # 2 m/s² for half a second, then 4 m/s².
    assert twist(world, 'a/0') == pytest.approx((3.0, 0.0, 0.0), abs=1e-9)


def test_a_body_can_be_anchored_and_freed_by_a_change(world):
    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.7), velocity=(1.0, 0.0), spin=1.0)
    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.7), anchored=True)
    world.step(24)
    assert pose(world, 'a/0') == pytest.approx((1.0, 2.0, 0.7), abs=ROUNDING)
    assert twist(world, 'a/0').tolist() == [0.0, 0.0, 0.0]

    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.7), anchored=False, velocity=(0.0, 1.0))

    assert pose(world, 'a/0') == pytest.approx((1.0, 2.0, 0.7), abs=ROUNDING)
    assert twist(world, 'a/0') == pytest.approx((0.0, 1.0, 0.0), abs=ROUNDING)


# Anchoring and releasing by a point


def test_the_topmost_is_the_one_that_spawned_last(world):
    for name in ('a/3', 'a/1', 'a/2'):
        spawn(world, name, DISC)

    assert body_at(world, (0.1, 0.1)) == 'a/2'
    world.apply(Delete(name='a/2'))
    assert body_at(world, (0.1, 0.1)) == 'a/1'


def test_sensors_and_grouped_bodies_are_found_under_a_point(world):
    spawn(world, 'a/0', DISC, sensor=True)
    spawn(world, 'a/1', DISC, (3.0, 0.0, 0.0), group=1)

    assert body_at(world, (0.0, 0.0)) == 'a/0'
    assert body_at(world, (3.0, 0.0)) == 'a/1'


def test_walls_are_no_bodies():
    world = World(settings=WorldSettings(bounds=(-1.0, -1.0, 1.0, 1.0)))

    assert body_at(world, (0.0, -1.5)) is None
    with pytest.raises(NothingThere):
        world.apply(Anchor(point=(0.0, -1.5)))


@pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())
def test_an_anchored_body_stays_where_it_was_and_released_it_falls(shape):
    world = World()
    spawn(world, 'a/0', shape, (1.0, 5.0, 0.7), velocity=(1.0, 2.0), spin=3.0)
    world.step(12)
    held = pose(world, 'a/0')
    x, y = shape.form.centroid
    point = (0.5, 0.5) if shape is ELL else (-0.3, 0.0) if shape is SHAPES['discs'] else (x, y)
    point = (0.0, 0.2) if shape is SHAPES['chain'] else point
    point = (0.0, 0.0) if shape is SHAPES['boxes'] else point

    assert world.apply(Anchor(point=point, frame='a/0')) == Answer(
        subject='a/0', message='anchored a/0'
    )
    assert pose(world, 'a/0') == pytest.approx(held, abs=ROUNDING)
    world.step(24)
    assert pose(world, 'a/0') == pytest.approx(held, abs=ROUNDING)
    assert twist(world, 'a/0').tolist() == [0.0, 0.0, 0.0]

    assert world.apply(Release(point=point, frame='a/0')) == Answer(
        subject='a/0', message='released a/0'
    )
    assert pose(world, 'a/0') == pytest.approx(held, abs=ROUNDING)
    assert twist(world, 'a/0') == pytest.approx((0.0, 0.0, 0.0), abs=ROUNDING)
    world.step(24)
    # A fall of a tenth of a second: the free flight is exact.
    assert pose(world, 'a/0') == pytest.approx(held - (0.0, 9.81 / 200, 0.0), abs=1e-9)


def test_anchoring_twice_and_releasing_twice_is_no_mistake(world):
    spawn(world, 'a/0', DISC, velocity=(1.0, 0.0))
    assert world.apply(Release(point=(0.0, 0.0))) == Answer(subject='a/0', message='released a/0')
    assert twist(world, 'a/0').tolist() == [1.0, 0.0, 0.0]

    world.apply(Anchor(point=(0.0, 0.0)))
    before = world.digest()
    assert world.apply(Anchor(point=(0.0, 0.0))) == Answer(subject='a/0', message='anchored a/0')
    assert world.digest() == before


def test_only_the_topmost_body_is_anchored(world):
    spawn(world, 'a/0', DISC)
    spawn(world, 'a/1', DISC)

    world.apply(Anchor(point=(0.0, 0.0)))

    assert not body(world, 'a/0').anchored
    assert body(world, 'a/1').anchored


@pytest.mark.parametrize('born', [True, False], ids=['from birth', 'later'])
def test_an_anchored_body_still_answers_to_changes(born):
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
