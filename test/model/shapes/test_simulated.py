# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every shape that has been constructed can be simulated."""

import math

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, LARGEST, Polygon, Shape, SMALLEST
from physsim_ros.simulation.world import World
import pytest

from .polygons import combs, drawn_boxes, polyominoes, stars
from ...building import SHAPES, spawn


def assert_it_can_be_simulated(shape: Shape, *, haste: float = 1.0) -> None:
    """Step a shape among neighbours of its own size: falling, standing, struck, turning."""
    form = shape.form
    size = form.outer
    x, y = form.centroid
    wall = 8 * size
    bounds = (-wall, -wall, wall, wall) if wall <= LARGEST else None
    world = World(settings=WorldSettings(bounds=bounds))
    spawn(world, 'a/0', shape, (-x, -y, 0.0))
    spawn(world, 'a/1', shape, (-x, -5 * size - y, 0.4), anchored=True)
    down, left, right = -30 * size * haste, -300 * size * haste, 100 * size * haste
    spawn(world, 'a/2', shape, (-x, 2 * size - y, 1.1), velocity=(0.0, down), spin=2.0)
    spawn(world, 'a/3', shape, (4 * size - x, -y, -0.9), velocity=(left, 0.0))
    block = Box(width=2 * size, height=2 * size)
    spawn(world, 'a/4', block, (-4 * size, 0.0, 0.3), velocity=(right, 0.0))
    spawn(world, 'a/5', Disc(radius=max(size, SMALLEST)), (size, 0.0, 0.0))

    lost = world.step(60)

    snapshot = world.snapshot()
    assert lost == ()
    assert np.isfinite(snapshot.poses).all()
    assert np.isfinite(snapshot.twists).all()


@settings(deadline=None, max_examples=25)
@given(
    shape=st.one_of(
        st.floats(0.01, 100.0).map(lambda radius: Disc(radius=radius)),
        st.builds(lambda w, h: Box(width=w, height=h), st.floats(0.01, 9.0), st.floats(0.01, 9.0)),
        st.one_of(stars(), combs(), polyominoes(), drawn_boxes()).map(
            lambda points: Polygon(outline=tuple(points))
        ),
        st.lists(st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0)), min_size=3, max_size=9)
        .filter(lambda points: math.dist(points[0], points[1]) > 1e-5)
        .map(lambda points: Chain(points=tuple(points), thickness=0.1)),
    )
)
def test_what_was_accepted_can_be_simulated(shape):
    assert_it_can_be_simulated(shape, haste=0.01)


EXTREMES: dict[str, Shape] = {
    'smallest disc': Disc(radius=SMALLEST),
    'smallest box': Box(width=SMALLEST, height=SMALLEST),
    'longest needle': Box(width=100.0, height=SMALLEST),
    'thinnest polygon': Polygon(outline=((0.0, 0.0), (5.0, 0.0), (5.0, 1.01e-3), (0.0, 1.01e-3))),
    'flattest triangle': Polygon(outline=((0.0, 0.0), (9.0, 0.0), (4.0, 1.01e-3))),
    'points on a line': Chain(points=((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)), thickness=SMALLEST),
    'fold': Chain(points=((0.0, 0.0), (1.0, 0.0), (0.0, 0.0)), thickness=0.1),
    'shortest chain': Chain(points=((0.0, 0.0), (1.1e-6, 0.0)), thickness=0.5),
    'one disc often': Compound(element=Disc(radius=0.2), centers=((0.0, 0.0),) * 9),
    'far from its origin': Polygon(
        outline=((9e4, 9e4), (9e4 + 1, 9e4), (9e4 + 1, 9e4 + 1), (9e4, 9e4 + 1))
    ),
    'nearly double corner': Polygon(
        outline=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (1.1e-6, 1.0), (0.0, 1.0))
    ),
    'disc of 10 km': Disc(radius=LARGEST / 10),
}


@pytest.mark.parametrize('shape', EXTREMES.values(), ids=EXTREMES.keys())
def test_the_most_extreme_shapes_can_be_simulated(shape):
    # Not so fast that most of the time goes into sweeping needles.
    assert_it_can_be_simulated(shape, haste=0.01)


@pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())
def test_every_kind_of_shape_can_be_simulated(shape):
    assert_it_can_be_simulated(shape, haste=0.3)
