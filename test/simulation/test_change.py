# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies are changed in place: by named properties, a spawn again, a move, anchor and release."""

from dataclasses import replace
import math

import numpy as np
from physsim_ros.model.answer import Answer
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import NothingThere, UnknownJoint
from physsim_ros.model.requests import (
    Anchor,
    ChangeBody,
    Command,
    Configure,
    Cut,
    Delete,
    MoveBodies,
    Release,
    Unjoin,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.world import World
import pytest

from ..building import (
    BLUE,
    body,
    body_at,
    BOX,
    DISC,
    ELL,
    G,
    INSIDE,
    join,
    names,
    NOWHERE,
    pose,
    RED,
    ROUNDING,
    SHAPES,
    spawn,
    spawning,
    stack,
    twist,
)

STILL = [0.0, 0.0, 0.0]


def changed(world: World, **properties: object) -> None:
    message = world.apply(ChangeBody(name='a/0', properties=Properties(**properties))).answer
    assert message == Answer(subject='a/0', message='changed a/0')


# By named properties


def test_only_what_is_named_changes(world):
    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.3), velocity=(1.0, 2.0), spin=3.0, lifetime=9.0)
    world.step(7)
    before, snapshot = body(world, 'a/0'), world.snapshot()

    changed(world, friction=0.25)
    assert body(world, 'a/0') == replace(before, friction=0.25)
    changed(world, density=7.0, elasticity=0.125)
    world.apply(ChangeBody(name='a/0', color=(1, 0, 0, 1)))

    assert body(world, 'a/0') == replace(
        before, friction=0.25, density=7.0, elasticity=0.125, color=(1.0, 0.0, 0.0, 1.0)
    )
    assert world.snapshot().poses == pytest.approx(snapshot.poses, abs=1e-12)
    assert world.snapshot().twists == pytest.approx(snapshot.twists, abs=1e-12)


@pytest.mark.parametrize(
    ('name', 'value', 'default'),
    [
        ('friction', 0.25, 0.75),
        ('elasticity', 0.25, 0.125),
        ('density', 7.0, 3.0),
        ('kinematic', True, False),
        ('anchored', True, False),
        ('group', 5, 0),
        ('sensor', True, False),
        ('label', 'm', ''),
        ('robot', {'drive': {'kind': 'omni'}}, None),
    ],
)
def test_a_property_that_is_unset_has_its_default_again(name, value, default):
    world = World(settings=replace(NOWHERE, friction=0.75, elasticity=0.125, density=3.0))
    spawn(world, 'a/0', DISC)
    before = body(world, 'a/0')
    changed(world, **{name: value})

    world.apply(ChangeBody(name='a/0', unset=(name,)))

    assert getattr(body(world, 'a/0'), name) == default
    assert body(world, 'a/0') == before


@pytest.mark.parametrize(
    ('unset', 'left'),
    [
        ('mass', [(None, 3.0), (None, 5.0)]),
        ('density', [(20.0, 20.0 / DISC.form.area), (None, 3.0)]),
    ],
)
def test_a_mass_that_is_unset_leaves_a_density_and_a_density_a_mass(unset, left):
    world = World(settings=replace(NOWHERE, density=3.0))
    spawn(world, 'a/0', DISC, mass=20.0)
    spawn(world, 'a/1', DISC, density=5.0)

    for name in names(world):
        world.apply(ChangeBody(name=name, unset=(unset,)))

    assert [(each.mass, each.density) for each in world.scene.bodies] == left


def test_a_velocity_that_is_unset_is_none(world):
    spawn(world, 'a/0', DISC, velocity=(1.0, 2.0), spin=3.0)

    world.apply(ChangeBody(name='a/0', unset=('velocity',)))
    assert twist(world, 'a/0') == pytest.approx((0.0, 0.0, 3.0))
    world.apply(ChangeBody(name='a/0', unset=('spin',)))
    assert not twist(world, 'a/0').any()


def test_pose_velocity_and_role_change_too(world):
    spawn(world, 'a/0', DISC, velocity=(1.0, 0.0))
    spawn(world, 'b/0', DISC, (5.0, 5.0, 0.0))

    changed(world, velocity=(0.0, 4.0))
    assert twist(world, 'a/0') == pytest.approx((0.0, 4.0, 0.0))
    world.apply(ChangeBody(name='a/0', pose=(1.0, 2.0, 0.5), frame='b/0'))
    assert pose(world, 'a/0') == pytest.approx((6.0, 7.0, 0.5))
    changed(world, anchored=True)
    assert twist(world, 'a/0') == pytest.approx(STILL)
    changed(world, anchored=False)
    world.step(10)
    assert pose(world, 'a/0') == pytest.approx((6.0, 7.0, 0.5))


def test_bodies_are_moved_together_and_keep_their_motion(world):
    spawn(world, 'a/0', ELL, (0.0, 0.0, 0.3), velocity=(1.0, 2.0), spin=3.0)
    spawn(world, 'a/1', BOX, (5.0, 0.0, 0.0), anchored=True)
    spawn(world, 'a/2', BOX, (9.0, 0.0, 0.0))
    before = world.snapshot()

    answer = world.apply(MoveBodies(names=('a/0', 'a/1'), by=(1.0, -2.0))).answer

    assert answer == Answer(message='moved 2 bodies')
    moved = world.snapshot().poses - before.poses
    assert moved == pytest.approx(np.array([[1, -2, 0], [1, -2, 0], [0, 0, 0]]))
    assert np.array_equal(world.snapshot().twists, before.twists)


# By a spawn again


def test_a_spawn_again_keeps_what_is_not_said_and_the_place_in_the_order(world):
    said = {'mass': 4.0, 'friction': 0.25, 'elasticity': 0.75, 'group': 5, 'sensor': True}
    spawn(world, 'a/0', DISC, color=RED, lifetime=9.0, label='m1', **said)
    spawn(world, 'a/1', DISC)
    before = body(world, 'a/0')

    answer = world.apply(spawning('a/0', BOX, (1.0, 2.0, 0.3))).answer

    assert answer == Answer(subject='a/0', message='changed a/0')
    assert body(world, 'a/0') == replace(before, shape=BOX, density=4.0)
    assert pose(world, 'a/0') == pytest.approx((1.0, 2.0, 0.3), abs=ROUNDING)
    assert names(world) == ('a/0', 'a/1')
    assert len(world) == 2


@pytest.mark.parametrize('shape', [DISC, BOX, ELL], ids=['same shape', 'box', 'ell'])
def test_a_spawn_again_keeps_the_motion_in_the_middle_of_it(shape):
    world = World()
    spawn(world, 'a/0', DISC, velocity=(1.0, 5.0), spin=2.0)
    world.step(24)
    before = twist(world, 'a/0')

    spawn(world, 'a/0', shape, (0.0, 7.0, 0.0))

    assert before == pytest.approx((1.0, 5.0 - G / 10, 2.0), abs=1e-9)
    assert twist(world, 'a/0') == pytest.approx(before, abs=1e-12)
    # And it flies on as a projectile does.
    world.step(24)
    assert twist(world, 'a/0') == pytest.approx((1.0, 5.0 - G / 5, 2.0), abs=1e-9)


def test_a_spawn_again_takes_over_what_is_said(world):
    spawn(world, 'a/0', DISC, velocity=(1.0, 2.0), spin=3.0, mass=2.0)

    spawn(world, 'a/0', DISC, velocity=(5.0, 6.0))
    assert twist(world, 'a/0') == pytest.approx((5.0, 6.0, 3.0), abs=ROUNDING)
    spawn(world, 'a/0', DISC, spin=0.0)
    spawn(world, 'a/0', DISC, density=3.0, friction=0.5, color=BLUE, lifetime=0.5)

    after = body(world, 'a/0')
    assert (after.mass, after.density, after.friction) == (None, 3.0, 0.5)
    assert (after.color, after.expires) == (BLUE, 120)
    assert twist(world, 'a/0') == pytest.approx((5.0, 6.0, 0.0), abs=ROUNDING)


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


def test_a_spawn_again_that_changes_nothing_leaves_the_digest():
    world = World()
    spawn(world, 'a/0', BOX, velocity=(1.0, 0.0))
    world.step(10)
    before = world.digest()

    spawn(world, 'a/0', BOX, tuple(pose(world, 'a/0').tolist()))

    assert world.digest() == before


@pytest.mark.parametrize(
    ('offset', 'red', 'same'),
    [(1e-10, 0.5, True), (1e-8, 0.5, False), (0.0, 0.5 + 1e-7, True), (0.0, 0.5 + 1e-5, False)],
)
def test_a_marker_that_comes_back_with_its_rounding_changes_nothing(world, offset, red, same):
    gray = (0.5, 0.5, 0.5, 1.0)
    spawn(world, 'a/0', BOX, (0.0, 0.0, 0.0), color=gray)
    before = world.digest()

    spawn(world, 'a/0', BOX, (offset, 0.0, 0.0), color=(red, *gray[1:]))

    assert (world.digest() == before) is same


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


def test_a_body_can_be_anchored_and_freed_by_a_spawn_again(world):
    place = (1.0, 2.0, 0.7)
    spawn(world, 'a/0', ELL, place, velocity=(1.0, 0.0), spin=1.0)
    spawn(world, 'a/0', ELL, place, anchored=True)
    world.step(24)
    assert pose(world, 'a/0') == pytest.approx(place, abs=ROUNDING)
    assert twist(world, 'a/0').tolist() == STILL

    spawn(world, 'a/0', ELL, place, anchored=False, velocity=(0.0, 1.0))

    assert pose(world, 'a/0') == pytest.approx(place, abs=ROUNDING)
    assert twist(world, 'a/0') == pytest.approx((0.0, 1.0, 0.0), abs=ROUNDING)


# By a point


def test_the_topmost_is_the_one_that_spawned_last_and_alone_is_anchored(world):
    for name in ('a/3', 'a/1', 'a/2'):
        spawn(world, name, DISC)
    spawn(world, 'a/1', BOX, color=RED)

    assert body_at(world, (0.1, 0.1)) == 'a/2'
    world.apply(Delete(name='a/2'))
    assert body_at(world, (0.1, 0.1)) == 'a/1'
    world.apply(Anchor(point=(0.0, 0.0)))
    assert [each.anchored for each in world.scene.bodies] == [False, True]


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


@pytest.mark.parametrize('kind', SHAPES)
def test_an_anchored_body_stays_where_it_was_and_released_it_falls(kind):
    world = World()
    spawn(world, 'a/0', SHAPES[kind], (1.0, 5.0, 0.7), velocity=(1.0, 2.0), spin=3.0)
    world.step(12)
    held, at = pose(world, 'a/0'), {'point': INSIDE[kind], 'frame': 'a/0'}

    assert world.apply(Anchor(**at)).answer == Answer(subject='a/0', message='anchored a/0')
    assert pose(world, 'a/0') == pytest.approx(held, abs=ROUNDING)
    world.step(24)
    assert pose(world, 'a/0') == pytest.approx(held, abs=ROUNDING)
    assert twist(world, 'a/0').tolist() == STILL

    assert world.apply(Release(**at)).answer == Answer(subject='a/0', message='released a/0')
    assert pose(world, 'a/0') == pytest.approx(held, abs=ROUNDING)
    assert twist(world, 'a/0') == pytest.approx(STILL, abs=ROUNDING)
    world.step(24)
    # A fall of a tenth of a second: the free flight is exact.
    assert pose(world, 'a/0') == pytest.approx(held - (0.0, G / 200, 0.0), abs=1e-9)


def test_anchoring_twice_and_releasing_twice_is_no_mistake(world):
    spawn(world, 'a/0', DISC, velocity=(1.0, 0.0))
    assert world.apply(Release(point=(0.0, 0.0))).answer == Answer(
        subject='a/0', message='released a/0'
    )
    assert twist(world, 'a/0').tolist() == [1.0, 0.0, 0.0]

    world.apply(Anchor(point=(0.0, 0.0)))
    before = world.digest()
    assert world.apply(Anchor(point=(0.0, 0.0))).answer == Answer(
        subject='a/0', message='anchored a/0'
    )
    assert world.digest() == before


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


def test_a_cut_severs_the_joints_that_are_still_there(world):
    for number in range(3):
        spawn(world, f'a/{number}', DISC, (4.0 * number, 0.0, 0.0))
        join(world, 'rope', [(4.0 * number, 0.0), (4.0 * number, 9.0)], name=f'rope/{number}')
    severed = tuple(Unjoin(name=f'rope/{number}') for number in range(2))
    world.apply(severed[0])

    answer = world.apply(Cut(pieces=(), severed=severed)).answer

    assert [each.name for each in world.scene.joints] == ['rope/2']
    assert answer.message == 'cut rope/1'
    with pytest.raises(UnknownJoint):
        world.apply(Cut(pieces=(), severed=severed))
