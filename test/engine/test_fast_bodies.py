# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Within the slow bounds no body is fast for any stage; a body at rest is within them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.ccd.fast_bodies import EXTENSION, fast_bodies, fast_in_crowd
from physsim_ros.model.arrays import Floats
from physsim_ros.simulation.world import World

from ..building import DT, NOWHERE, SHAPES, spawn

# So many that a fast one may be near more pieces than the engine pairs cheaply.
COUNT = 600


def table_of(count: int) -> BodyTable:
    """Return the table of bodies of all shapes, some of them anchored, kinematic or sensors."""
    world = World(settings=NOWHERE)
    shapes = list(SHAPES.values())
    for number in range(count):
        kinds = {
            'anchored': number % 7 == 1,
            'kinematic': number % 5 == 2,
            'sensor': number % 6 == 3,
        }
        spawn(world, f'body/{number}', shapes[number % 8], (9.0 * number, 0.0, 0.0), **kinds)
    return world.space.table


def twists_about_the_limits(count: int) -> Iterator[Floats]:
    """Yield velocities from a hundredth of what any stage calls fast to many times that."""
    rng = np.random.default_rng(27)
    for size in np.geomspace(0.01, 100.0, 60):
        yield size * rng.normal(size=(count, 3)) * rng.choice([0.0, 0.1, 1.0], (count, 3))


def set_twists(table: BodyTable, twists: Floats) -> None:
    """Set the velocities of all bodies, anchored ones excepted."""
    state = table.state.copy()
    state[:, 3:] = np.where(table.columns.anchored[:-1, None], 0.0, twists)
    table.write_state(state)


def test_within_the_bounds_no_body_is_fast_for_any_stage() -> None:
    covered = []
    for table in map(table_of, (3, COUNT)):
        for twists in twists_about_the_limits(len(table.bodies)):
            set_twists(table, twists)
            moves = table.state[:, 3:] * DT
            ways = table.state[:, 3:5] * EXTENSION
            fast = fast_bodies(table.columns, moves) | fast_in_crowd(table.columns, ways)
            covered.append(table.all_slow)

            assert not (covered[-1] and fast.any())
    assert True in covered
    assert False in covered


def test_bodies_at_rest_are_within_the_bounds_and_no_bodies_are() -> None:
    assert table_of(COUNT).all_slow
    assert table_of(0).all_slow


def test_a_velocity_that_is_no_number_is_not_within_the_bounds() -> None:
    table = table_of(1)
    table.sizes[0, 3] = np.nan

    assert not table.all_slow
