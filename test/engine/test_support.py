# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies that lose what they rest or hang on fall exactly; those that keep it do not stir."""

from functools import partial

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import (
    Command,
    Configure,
    Delete,
    Pin,
    Release,
    Request,
    Spawn,
    Unjoin,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.world import World
import pytest

from ..building import BOX, G, join, pose, spawn, stack, twist


def hung(world: World) -> Request:
    join(world, 'rod', [(0.0, 50.0), (0.0, 53.0)], a='r/0')
    return Unjoin(name='joint/0')


def sprung(world: World) -> Request:
    join(world, 'spring', [(0.0, 50.0), (0.0, 53.0)], a='r/0')
    return Unjoin(name='joint/0')


def pinned(world: World) -> Request:
    world.apply(Pin(point=(0.0, 50.0)))
    return Release(point=(0.0, 50.0))


BELOW = (0.0, 49.0, 0.0)


def floored(world: World, request: Request) -> Request:
    spawn(world, 'f/0', BOX, BELOW, anchored=True)
    return request


def walled(world: World) -> Request:
    world.apply(Configure(changes={'bounds': (-9.0, 49.5, 9.0, 90.0)}))
    return Configure(changes={'bounds': None})


@pytest.mark.parametrize(
    'held',
    [
        hung,
        sprung,
        pinned,
        walled,
        partial(floored, request=Delete(name='f/0')),
        partial(floored, request=Command(names=('f/0',), poses=((9.0, 0.0, 0.0),))),
        partial(
            floored,
            request=Spawn(name='f/0', shape=BOX, pose=BELOW, properties=Properties(sensor=True)),
        ),
    ],
    ids=['rod', 'spring', 'pin', 'wall', 'deleted', 'moved', 'sensor'],
)
def test_what_is_let_go_falls_exactly(held):
    world = World()
    spawn(world, 'r/0', BOX, (0.0, 50.0, 0.0))
    let_go = held(world)
    world.step(240)
    before = world.snapshot()
    x, y, _ = before.poses[0]
    world.apply(let_go)
    assert world.snapshot().twists[0] == pytest.approx(before.twists[0], abs=1e-12)
    world.step(480)
    vy = before.twists[0][1]
    assert pose(world, 'r/0')[:2] == pytest.approx((x, y + 2.0 * vy - G * 2.0), abs=1e-9)
    assert twist(world, 'r/0')[1] == pytest.approx(vy - 2.0 * G, abs=1e-9)


def test_what_keeps_another_support_does_not_stir():
    world = World()
    spawn(world, 'plank/0', Box(width=4.0, height=0.2), (0.0, 2.1, 0.0))
    for number in range(3):
        post, place = Box(width=0.5, height=2.0), (number - 1.0, 1.0, 0.0)
        spawn(world, f'post/{number}', post, place, anchored=True)
    world.step(240)
    before = pose(world, 'plank/0')
    world.apply(Delete(name='post/1'))
    world.step(240)
    assert pose(world, 'plank/0') == pytest.approx(before, abs=1e-4)


def standing(count: int) -> World:
    """Return a stack at rest on a floor that can be taken away; its boxes are rows 1 and up."""
    world = World(settings=WorldSettings(elasticity=0.0))
    spawn(world, 'floor/0', Box(width=20.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
    stack(world, count)
    world.step(1200)
    return world


@pytest.mark.parametrize(
    ('request_', 'gravity'),
    [
        (Delete(name='floor/0'), (0.0, -G)),
        (Command(names=('floor/0',), poses=((0.0, -9.0, 0.0),)), (0.0, -G)),
        (Configure(changes={'gravity': (0.0, 0.0)}), (0.0, 0.0)),
        (Configure(changes={'gravity': (0.0, G)}), (0.0, G)),
    ],
    ids=['floor deleted', 'floor moved', 'weightless', 'upward'],
)
def test_a_stack_that_loses_its_footing_falls_as_one(request_, gravity):
    world = standing(10)
    before = world.snapshot()

    world.apply(request_)
    world.step(240)

    # To the rest of the sway of the stack; the weight that it has borne is gone.
    after, now = gravity[1], world.snapshot()
    assert now.twists[-10:, 1] == pytest.approx(after, abs=1e-4)
    assert now.poses[-10:, 1] == pytest.approx(before.poses[-10:, 1] + after / 2, abs=1e-4)


def test_what_stood_on_a_box_that_is_deleted_falls_as_one_and_the_rest_stands():
    world = standing(8)

    world.apply(Delete(name='stack/3'))
    world.step(48)

    vy = world.snapshot().twists[1:, 1]
    assert vy[3:] == pytest.approx(-0.2 * G, abs=1e-4)
    assert vy[:3] == pytest.approx(0.0, abs=0.02)


def test_a_floor_laid_at_once_holds_the_stack():
    world = standing(6)

    world.apply(Delete(name='floor/0'))
    spawn(world, 'floor/1', Box(width=20.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
    world.step(1)

    assert np.abs(world.snapshot().twists).max() < 0.01


@pytest.mark.parametrize('gravity', [(0.0, -9.7), (0.0, -5.0), (0.0, -0.1)])
def test_a_stack_does_not_stir_where_gravity_is_less(gravity):
    world = standing(10)

    world.apply(Configure(changes={'gravity': gravity}))

    for _ in range(30):
        world.step(1)
        assert np.abs(world.snapshot().twists).max() < 1e-3


def test_gravity_that_comes_back_finds_what_it_left():
    world = standing(3)

    for gravity in ((1e-310, 0.0), (G, -G), (0.0, 0.0), (0.0, -G)):
        world.apply(Configure(changes={'gravity': gravity}))
    world.step(240)

    assert np.abs(world.snapshot().twists).max() < 1e-3


def test_looking_at_what_is_let_go_changes_nothing():
    one, other = standing(4), standing(4)

    for world in (one, other):
        world.apply(Delete(name='floor/0'))
        if world is one:
            world.snapshot()
            world.digest()
            world.save()
        spawn(world, 'floor/1', Box(width=20.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
        world.apply(Delete(name='stack/1'))
    digests = one.digest(), other.digest()
    for world in (one, other):
        world.step(60)

    assert digests[0] == digests[1]
    assert one.digest() == other.digest()
