# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Machines of joints go on alike to the bit."""

from physsim_ros.model.shapes import Box
from physsim_ros.simulation.world import World

from .jointed import KINDS, pair, PROPERTIES
from ..building import join, joining, spawn


def machine() -> World:
    world = World()
    for number in range(6):
        spawn(world, f'a/{number}', Box(width=1.0, height=0.3), (number * 0.9, 3.0, 0.1 * number))
    spawn(world, 'ground/0', Box(width=40.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
    for number, kind in enumerate(KINDS):
        request = joining(
            kind,
            [(number * 0.6, 3.0), (number * 0.6 + 0.9, 3.0)][: kind.points],
            f'joint/{number}',
            a=f'a/{number % 6}',
            b='world' if number % 3 == 0 else f'a/{(number + 1) % 6}',
            **PROPERTIES.get(kind, {}),
        )
        world.apply(request)
    return world


def test_a_world_goes_on_from_a_checkpoint_to_the_bit():
    world = machine()
    world.step(200)
    key = world.renew()
    world.step(300)
    first = world.digest()
    world.resume(key)
    world.step(300)
    assert world.digest() == first


def test_scenes_are_the_same_object_until_a_joint_comes_or_goes():
    world = pair()
    before = world.snapshot().scene
    join(world, 'axle', [(0.4, 0.0)])
    joined = world.snapshot().scene
    world.step(10)
    assert world.snapshot().scene is joined is not before
