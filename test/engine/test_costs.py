# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The cost of an event of many bodies in one step is proportional to their number."""

from collections.abc import Callable
import math

from physsim_ros.model.requests import Delete, DeleteBodies
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.world import World
import pytest

from .costs import growth, MOST
from ..building import spawn

pytestmark = pytest.mark.cost


def landing(count: int) -> Callable[[], object]:
    """Return the step in which discs land on a wall at once."""
    world = World(settings=WorldSettings(gravity=(0.0, 0.0), bounds=(-1e4, 0.0, 1e4, 1e4)))
    for number in range(count):
        pose = (0.2 * number, 0.0525, 0.0)
        spawn(world, f'disc/{number}', Disc(radius=0.05), pose, velocity=(0.0, -1.0))
    # Makes the table.
    world.snapshot()
    return lambda: world.step(1)


def test_many_that_land_at_once_cost_what_their_count_says():
    assert growth(landing, 1500) < MOST


def struck(count: int) -> Callable[[], object]:
    """Return the step in which elastic boxes hit a plate, each faster than the one before."""
    world = World(settings=WorldSettings(gravity=(0.0, 0.0), elasticity=1.0))
    for number in range(count):
        pose, speed = (0.2 * number, 0.0505, 0.0), 1.0 + number / count
        spawn(world, f'box/{number}', Box(width=0.1, height=0.1), pose, velocity=(0.0, -speed))
    plate = Box(width=0.2 * count + 1.0, height=1.0)
    spawn(world, 'plate/0', plate, (0.1 * count, -0.5, 0.0), mass=1e6)
    # Makes the table.
    world.snapshot()
    return lambda: world.step(1)


def test_elastic_impacts_on_one_body_cost_what_their_count_says():
    assert growth(struck, 700) < MOST


def cornered(count: int) -> Callable[[], object]:
    """Return the step in which discs meet the corners of boxes at once."""
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    for number in range(count):
        x, y = divmod(number, 100)
        post = Box(width=0.1, height=0.1)
        spawn(world, f'post/{number}', post, (float(x), float(y), math.pi / 4), anchored=True)
        pose = (float(x), y + 0.05 * math.sqrt(2.0) + 0.0525, 0.0)
        spawn(world, f'disc/{number}', Disc(radius=0.05), pose, velocity=(0.0, -1.0))
    # Makes the table.
    world.snapshot()
    return lambda: world.step(1)


def test_many_discs_that_meet_corners_at_once_cost_what_their_count_says():
    assert growth(cornered, 1500) < MOST


def under_way(count: int) -> Callable[[], object]:
    """Return a step of actors that have begun as one gate opened, which has closed since."""
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    gate = Box(width=1.0, height=1.0)
    spawn(world, 'gate/0', gate, (-9.0, 0.0, 0.0), anchored=True, sensor=True)
    waits = {'gate': 'gate/0'}
    spawn(world, 'key/0', Disc(radius=0.1), (-9.0, 0.0, 0.0))
    for number in range(count):
        pose = (float(number), 0.0, 0.0)
        path = {'kind': 'path', 'points': [[number, 0], [number, 9]], 'speed': 1.0}
        actor = {**path, 'start': waits}
        spawn(world, f'cart/{number}', Disc(radius=0.1), pose, kinematic=True, actor=actor)
    world.step(1)
    world.apply(Delete(name='key/0'))
    world.step(1)
    assert world.snapshot().twists[-1, 1] > 0.0
    return lambda: world.step(4)


def test_actors_under_way_do_not_look_at_their_gates():
    assert growth(under_way, 300) < MOST


def around_hub(count: int) -> World:
    """Return a world of boxes that touch a large disc all around, at rest and without gravity."""
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    side, reach = 0.05, 0.02 * count
    spawn(world, 'hub/0', Disc(radius=reach), (0.0, 0.0, 0.0))
    # So little overlap is not pushed out.
    distance = reach + side / 2 - 1e-4
    for number in range(count):
        angle = math.tau * number / count
        pose = distance * math.cos(angle), distance * math.sin(angle), angle
        spawn(world, f'box/{number}', Box(width=side, height=side), pose)
    return world


def released(count: int) -> Callable[[], object]:
    """Return the look at a large disc from which what it touched was removed."""
    world = around_hub(count)
    rest = Box(width=1.0, height=1.0)
    spawn(world, 'rest/0', rest, (0.0, 0.0, 0.0), anchored=True)
    world.step(1)
    world.apply(Delete(name='rest/0'))
    # Makes the table.
    _ = world.scene
    return world.snapshot


def test_the_contacts_of_a_released_body_cost_what_their_count_says():
    assert growth(released, 1000) < MOST


def afloat(count: int) -> Callable[[], object]:
    """Return a step of bodies each in a medium of its own."""
    world = World(settings=WorldSettings(gravity=(0.0, -9.81)))
    medium = {'anchored': True, 'sensor': True, 'medium': {'density': 2.0}}
    for number in range(count):
        pose = *(float(each) for each in divmod(number, 100)), 0.0
        spawn(world, f'pool/{number}', Disc(radius=0.2), pose, **medium)
        spawn(world, f'disc/{number}', Disc(radius=0.1), pose)
    # Makes the table.
    world.snapshot()
    return lambda: world.step(1)


def test_media_cost_what_their_count_says():
    assert growth(afloat, 1000) < MOST


def deleted(count: int) -> Callable[[], object]:
    """Return the deletion of every other one of the discs in a row, which touch."""
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    for number in range(count):
        spawn(world, f'disc/{number}', Disc(radius=0.05), (0.0999 * number, 0.0, 0.0))
    world.step(1)
    names = world.scene.names[::2]
    return lambda: world.apply(DeleteBodies(names=names))


def test_bodies_that_are_deleted_together_cost_what_their_count_says():
    assert growth(deleted, 500) < MOST
