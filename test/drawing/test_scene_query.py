# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A view of a snapshot tells of the world what the world itself would tell."""

from __future__ import annotations

import itertools
import math

import numpy as np
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.model.errors import UnknownFrame
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import Join
from physsim_ros.simulation.world import World
import pytest

from ..building import body_at, INSIDE, NOWHERE, SHAPES, spawn

AT = (3.0, -2.0, 0.7)


def crowded() -> World:
    """Return a world of bodies of every shape, turned and on top of one another."""
    world = World(settings=NOWHERE)
    places = itertools.product((0.0, 0.9, 1.8), (0.0, 0.8, 1.6))
    for number, (shape, (x, y)) in enumerate(zip(SHAPES.values(), places, strict=False)):
        spawn(world, f'a/{number}', shape, (x, y, 0.7 * number))
    return world


def test_the_topmost_body_under_a_point_is_the_worlds() -> None:
    world = crowded()
    view = SceneQuery(world.snapshot())
    points = np.random.default_rng(3).uniform((-1.0, -1.0), (3.0, 3.0), (2000, 2)).tolist()
    hits = 0
    for x, y in points:
        found = body_at(world, (x, y))
        assert next(iter(view.bodies_at((x, y))), None) == found
        hits += found is not None
    assert hits > 500


def test_all_bodies_under_a_point_are_found_topmost_first() -> None:
    world = World(settings=NOWHERE)
    for number in (3, 1, 2):
        spawn(world, f'a/{number}', pose=(0.1 * number, 0.0, 0.0))
    spawn(world, 'a/0', pose=(5.0, 0.0, 0.0))
    assert SceneQuery(world.snapshot()).bodies_at((0.0, 0.0)) == ('a/2', 'a/1', 'a/3')


@pytest.mark.parametrize('kind', SHAPES)
def test_a_body_that_is_near_enough_counts(kind: str) -> None:
    world = World(settings=NOWHERE)
    spawn(world, 'a/0', SHAPES[kind], AT)
    view = SceneQuery(world.snapshot())
    inside = view.in_world('a/0', INSIDE[kind])
    assert view.bodies_at(inside) == ('a/0',)
    # Right of all of it, but for the slack.
    reach = 1e-6
    while view.bodies_at((inside[0] + reach, inside[1])):
        reach += 0.01
    outside = inside[0] + reach, inside[1]
    assert view.bodies_at(outside, 0.02) == ('a/0',)
    assert view.bodies_at((outside[0] + 10.0, outside[1]), 0.02) == ()


def test_points_go_from_the_world_to_a_body_and_back() -> None:
    world = World(settings=NOWHERE)
    spawn(world, 'a/0', pose=AT)
    view = SceneQuery(world.snapshot())
    ahead = 3.0 + 2 * math.cos(0.7), -2.0 + 2 * math.sin(0.7)
    assert view.in_world('a/0', (2.0, 0.0)) == pytest.approx(ahead)
    assert view.local('a/0', ahead) == pytest.approx((2.0, 0.0))
    assert view.resolve_point((2.0, 0.0), 'a/0') == view.in_world('a/0', (2.0, 0.0))
    assert view.resolve_point((2.0, 0.0), '') == (2.0, 0.0)
    with pytest.raises(UnknownFrame):
        view.resolve_point((2.0, 0.0), 'b/0')


def test_numbers_lie_above_all_of_their_kind_and_above_those_remembered() -> None:
    world = World(settings=NOWHERE)
    for name in ('drawn/7', 'drawn/2', 'other/99', 'drawn/a/50'):
        spawn(world, name)
    world.apply(
        Join(name='drawn/4', kind=JointKind.ROD, points=((0, 0), (1, 0)), a='drawn/7', b='drawn/2')
    )
    snapshot = world.snapshot()
    assert (SceneQuery(snapshot).next_body(), SceneQuery(snapshot).next_joint()) == (
        'drawn/8',
        'drawn/5',
    )
    remembering = SceneQuery(snapshot, first=20, first_joint=30)
    assert (remembering.next_body(), remembering.next_joint()) == ('drawn/20', 'drawn/30')
    empty = SceneQuery(World().snapshot())
    assert (empty.next_body(), empty.next_joint()) == ('drawn/0', 'drawn/0')
