# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies that are removed: together or one after the other, with what rests on them."""

from __future__ import annotations

from physsim_ros.engine import space
from physsim_ros.model.requests import Delete, DeleteBodies
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.world import World
import pytest

from ..building import spawn


def pile(steps: int) -> World:
    """Return a world of discs and boxes, on a floor and a plate, after some steps."""
    world = World(settings=WorldSettings(bounds=(-2.0, 0.0, 2.0, 10.0)))
    for number in range(120):
        row, column = divmod(number, 12)
        shape = Disc(radius=0.1) if number % 3 else Box(width=0.2, height=0.15)
        pose = -1.5 + 0.25 * column + 0.01 * row, 0.2 + 0.25 * row, 0.1 * number
        spawn(world, f'b/{number}', shape, pose, elasticity=0.0 if number % 5 else 0.8)
    plate = Box(width=1.0, height=0.1)
    spawn(world, 'plate/0', plate, (0.0, 1.0, 0.0), anchored=True)
    world.step(steps)
    return world


# In the air, as it lands, and asleep.
@pytest.mark.parametrize('steps', [1, 240, 2400])
def test_bodies_removed_together_leave_the_bits_that_they_leave_one_by_one(steps: int) -> None:
    one_by_one, together = pile(steps), pile(steps)
    names = ('plate/0', *(f'b/{number}' for number in range(0, 120, 4)))
    for name in names:
        one_by_one.apply(Delete(name=name))
    together.apply(DeleteBodies(names=names))
    assert together.digest() == one_by_one.digest()
    for world in (one_by_one, together):
        world.step(200)
    assert together.digest() == one_by_one.digest()


def expired(world: World) -> int:
    """Make the step in which bodies expire, and return the number of its slices."""
    for number in range(7):
        spawn(world, f'short/{number}', Disc(radius=0.1), (3.0 + number, 1.0, 0.0), lifetime=0.1)
    world.step(23)
    slices = 1
    for _ in world.slices_of_steps(1):
        assert world.is_within_step
        slices += 1
    assert not any(name.startswith('short') for name in world.scene.names)
    return slices


def test_bodies_that_expire_at_once_leave_in_slices(monkeypatch: pytest.MonkeyPatch) -> None:
    at_once, in_slices = pile(0), pile(0)
    assert expired(at_once) == 1
    monkeypatch.setattr(space, '_MOST_LEAVING', 3)
    assert expired(in_slices) == 3
    for world in (at_once, in_slices):
        world.step(100)
    assert in_slices.digest() == at_once.digest()
