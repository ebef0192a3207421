# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The broad phase finds every pair of boxes that overlap; only what could meet is advanced."""

import itertools
import math
from typing import Any

import numpy as np
from physsim_ros.engine import broad_phase
from physsim_ros.model.requests import Command
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
from physsim_ros.simulation.world import World
import pytest

from ...building import join, spawn


@pytest.mark.parametrize('seed', range(5))
@pytest.mark.parametrize('few', [(0, 0), (0, 10**9), (10**9, 0)])
@pytest.mark.parametrize('far', [0.0, 1e11])
@pytest.mark.parametrize('most', [None, 100])
def test_every_pair_of_boxes_that_overlap_is_found_once(monkeypatch, seed, few, far, most):
    monkeypatch.setattr(broad_phase, '_FEW_PAIRS', few[0])
    monkeypatch.setattr(broad_phase, '_FEW_BESIDE', few[1])
    pick = np.random.default_rng(seed)
    low = pick.uniform(-10.0, 10.0, (300, 2)) + far
    # From a millimetre to tens of metres.
    boxes = np.concatenate((low, low + 10.0 ** pick.uniform(-3.0, 1.5, (300, 2))), axis=1)
    first = pick.uniform(size=300) < 0.3

    found = [
        pair
        for one, other in broad_phase.pairs_in_parts(boxes, first, most=most)
        for pair in zip(one.tolist(), other.tolist(), strict=True)
    ]
    expected = {
        (a, b)
        for a, b in itertools.combinations(range(300), 2)
        if (first[a] or first[b]) and broad_phase.boxes_overlap(boxes[a], boxes[b])
    }
    assert len(found) == len(expected)
    assert set(found) == expected


def swept(world: World) -> int:
    """Return how many pairs of bodies were advanced in the last steps of a world."""
    return world.space.core.swept


def test_of_a_crowd_that_falls_nobody_is_swept_before_the_ground():
    world = World(settings=WorldSettings(bounds=(-10.0, 0.0, 10.0, 30.0)))
    for number in range(100):
        row, column = divmod(number, 20)
        pose = (0.15 * column, 12.0 + 0.15 * row, 0.0)
        spawn(world, f'small/{number}', Disc(radius=0.05), pose)
    # Faster than a quarter of their radius a sub-step after 1.22 s, down after 1.56 s.
    world.step(290)
    assert swept(world) == 0
    world.step(90)
    assert swept(world) > 0
    # A quarter of the radius may go unseen in a sub-step, and 5 mm is left standing.
    assert world.snapshot().poses[:, 1].min() > 0.05 - 0.0125 - 0.005


def heap(**properties: Any) -> World:
    """Return bodies that fly through each other, one of them larger and one faster than most."""
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    for number in range(20):
        radius, speed = 0.5 if number == 7 else 0.05, 100.0 if number == 8 else 30.0
        velocity = (speed * math.cos(number), speed * math.sin(number))
        pose = (0.01 * number, 0.0, 0.0)
        given = {'velocity': velocity, **properties}
        spawn(world, f'body/{number}', Disc(radius=radius), pose, **given)
    return world


@pytest.mark.parametrize(('group', 'meets'), [(0, True), (1, False), (-1, False)])
def test_a_group_whose_bodies_pass_through_each_other_is_not_swept(group, meets):
    world = heap(group=group)
    world.step(1)
    assert bool(swept(world)) is meets


@pytest.mark.parametrize('collide', [True, False])
def test_what_a_joint_keeps_from_colliding_is_not_swept(collide):
    world = heap()
    for number, (a, b) in enumerate(itertools.combinations(range(20), 2)):
        points, said = [(0.01 * a, 0.0), (0.01 * b, 0.0)], {'collide': collide, 'stiffness': 1.0}
        join(world, 'spring', points, f'joint/{number}', a=f'body/{a}', b=f'body/{b}', **said)
    world.step(1)
    assert bool(swept(world)) is collide


def test_who_passes_through_sensors_alone_is_not_swept():
    world = heap(sensor=True)
    world.step(1)
    assert swept(world) == 0


@pytest.mark.parametrize(('moved', 'anew'), [('body/0', False), ('wall/0', True)])
def test_the_tree_of_what_is_anchored_is_built_anew_only_where_that_is_moved(
    monkeypatch, moved, anew
):
    world, noted = heap(), []
    spawn(world, 'wall/0', Disc(radius=1.0), (50.0, 0.0, 0.0), anchored=True)
    monkeypatch.setattr(world.space.core, 'note_moved_static', lambda: noted.append(moved))

    world.apply(Command(names=(moved,), poses=np.array([[0.0, 9.0, 0.0]])))

    assert bool(noted) == anew
