# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A crowd of fast bodies costs a bounded number of pairs, and is no reason to miss a wall."""

from __future__ import annotations

from typing import Any

import numpy as np
from physsim_ros.engine.ccd import impact_islands, swept_boxes
from physsim_ros.engine.ccd.broad_phase import boxes_overlap, count_candidates, count_on_axes
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Compound, Disc
from physsim_ros.simulation.world import World
import pytest

from ...building import spawn

NOWHERE = WorldSettings(gravity=(0.0, 0.0))


@pytest.fixture
def advanced(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Return the products of corners of the pairs whose time of impact is found, by call."""
    costs: list[int] = []
    first_impacts = impact_islands.first_impacts

    def spy(motions: Any, pairs: Any) -> Any:
        corners = np.array([len(each.corners) for each in pairs.hulls])
        costs.append(int(corners[pairs.shapes[0]] @ corners[pairs.shapes[1]]))
        return first_impacts(motions, pairs)

    monkeypatch.setattr(impact_islands, 'first_impacts', spy)
    return costs


def crowd(world: World, count: int, speed: float, shape: Any, *, at: float = 0.0) -> None:
    """Spawn bodies that fly in all directions."""
    pick = np.random.default_rng(1)
    for number in range(count):
        x, y = pick.uniform(0.0, 30.0, 2).tolist()
        velocity = tuple(pick.normal(0.0, speed, 2).tolist())
        spawn(world, f'crowd/{number}', shape, (at + x, y, 0.0), velocity=velocity)


def test_what_is_near_a_box_weighs_at_least_what_overlaps_it() -> None:
    pick = np.random.default_rng(0)
    low = pick.uniform(-10.0, 10.0, (300, 2))
    boxes = np.concatenate((low, low + 10.0 ** pick.uniform(-3.0, 1.5, (300, 2))), axis=1)
    weights = pick.integers(1, 9, 300).astype(float)
    first = pick.uniform(size=300) < 0.3
    near = count_candidates(boxes, first, weights)
    overlap = boxes_overlap(boxes[:, None], boxes) @ weights
    assert (near[first] >= overlap[first]).all()
    (on_axes,) = count_on_axes(boxes, weights[None])
    assert (on_axes >= overlap).all()
    assert (on_axes < weights.sum()).any()
    assert not near[~first].any()


@pytest.mark.parametrize(
    ('count', 'shape'),
    [
        (800, Disc(radius=0.1)),
        (800, Box(width=0.2, height=0.2)),
        (20, Compound(element=Disc(radius=0.1), centers=tuple((0.2 * k, 0.0) for k in range(20)))),
    ],
)
def test_a_crowd_of_fast_bodies_keeps_its_budget(
    advanced: list[int], count: int, shape: Any
) -> None:
    world = World(settings=NOWHERE)
    crowd(world, count, 2e4, shape)
    world.step(1)
    assert advanced
    assert max(advanced) <= swept_boxes.BUDGET


def test_a_bullet_meets_a_wall_however_large_a_crowd_flies_elsewhere() -> None:
    ends = []
    for count in (0, 800):
        world = World(settings=NOWHERE)
        spawn(world, 'wall/0', Box(width=0.1, height=5.0), (30.0, 0.0, 0.0), anchored=True)
        spawn(world, 'bullet/0', Disc(radius=0.05), (0.0, 0.0, 0.0), velocity=(9e3, 0.0))
        crowd(world, count, 2e4, Disc(radius=0.1), at=1e4)
        world.step(3)
        row = world.snapshot().scene.names.index('bullet/0')
        ends.append(world.snapshot().poses[row].tolist())
    assert ends[0] == ends[1]
    assert ends[0][0] < 30.0


def test_a_bullet_passes_a_resting_crowd_and_meets_the_wall_behind() -> None:
    world = World(settings=NOWHERE)
    for number in range(2500):
        place = (8.0 + 0.2 * (number % 50), 0.2 * (number // 50), 0.0)
        spawn(world, f'crowd/{number}', Disc(radius=0.05), place)
    spawn(world, 'wall/0', Box(width=0.1, height=50.0), (25.0, 25.0, 0.0), anchored=True)
    spawn(world, 'bullet/0', Disc(radius=0.05), (0.0, 0.0, 0.0), velocity=(7e3, 7e3))
    world.step(1)
    row = world.snapshot().scene.names.index('bullet/0')
    assert world.snapshot().poses[row, 0] < 25.0
