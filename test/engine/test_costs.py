# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""What happens to many bodies in one step costs what their count says."""

from collections.abc import Callable

from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
from physsim_ros.simulation.world import World

from .costs import growth, MOST
from ..building import spawn


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
