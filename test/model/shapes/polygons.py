# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Polygons as tests draw them: strategies, and assertions about their pieces."""

import math
import random

from hypothesis import assume
from hypothesis import strategies as st
import numpy as np
from physsim_ros.model.errors import BadSize
from physsim_ros.model.shapes import Convex, Piece, Polygon
import pytest

Points = list[tuple[float, float]]
# Sums of a few products in float64, relative.
ROUNDING = 1e-12


def area_of(points: Points | tuple[tuple[float, float], ...]) -> float:
    """Return the signed area of an outline by the shoelace formula [m²]."""
    vertices = np.array(points) - points[0]
    following = np.roll(vertices, -1, axis=0)
    return float((vertices[:, 0] * following[:, 1] - vertices[:, 1] * following[:, 0]).sum() / 2)


def turned(points: Points, yaw: float) -> Points:
    cos, sin = math.cos(yaw), math.sin(yaw)
    return [(cos * x - sin * y, sin * x + cos * y) for x, y in points]


def assert_cover(pieces: tuple[Piece, ...], area: float, *, share: float = 1e-9) -> None:
    """Assert that pieces are convex, counter-clockwise, and together of that area [m²]."""
    total = 0.0
    for piece in pieces:
        assert isinstance(piece, Convex)
        vertices = np.array(piece.vertices)
        edges = np.roll(vertices, -1, axis=0) - vertices
        before = np.roll(edges, 1, axis=0)
        turns = before[:, 0] * edges[:, 1] - before[:, 1] * edges[:, 0]
        chords = np.hypot(*(before + edges).T)
        # 1 µm and its rounding: what bends inwards by less counts as straight.
        assert (turns >= -1.001e-6 * chords).all()
        # Once around, and no more: all bends to the left together are 2π.
        angles = np.arctan2(turns, (before * edges).sum(axis=1))
        assert angles.sum() == pytest.approx(2 * math.pi, abs=1e-6)
        total += area_of(piece.vertices)
    assert total == pytest.approx(area, rel=share)


def assert_apart(pieces: tuple[Piece, ...]) -> None:
    """Assert that no piece holds the middle of another."""
    convex = [np.array(piece.vertices) for piece in pieces if isinstance(piece, Convex)]
    for at, vertices in enumerate(convex):
        middle = vertices.mean(axis=0)
        for other in (each for number, each in enumerate(convex) if number != at):
            edges = np.roll(other, -1, axis=0) - other
            to_middle = middle - other
            sides = edges[:, 0] * to_middle[:, 1] - edges[:, 1] * to_middle[:, 0]
            assert (sides < 0).any()


def assert_solid(points: Points) -> None:
    """Assert that an outline becomes a solid of its area, either way round."""
    area = abs(area_of(points))
    perimeter = sum(map(math.dist, points, points[1:] + points[:1]))
    for outline in (points, points[::-1]):
        try:
            form = Polygon(outline=tuple(outline)).form
        except BadSize:
            # It has parts of less than a millimetre; whether, a test of its own asks.
            continue
        assert form.area == pytest.approx(area, rel=1e-9)
        # A thousandth may lie in slivers; 1 µm along the outline may be straightened.
        assert_cover(form.pieces, area, share=1.1e-3 + 1e-6 * perimeter / area)
        assert_apart(form.pieces)


@st.composite
def stars(draw: st.DrawFn) -> Points:
    """Corners around a centre, at any distances: always simple."""
    count = draw(st.integers(3, 40))
    distances = st.floats(0.2, 3.0)
    shift = draw(st.floats(0.0, 0.7))
    return [
        (radius * math.cos(angle), radius * math.sin(angle))
        for radius, angle in (
            (draw(distances), 2 * math.pi * (k + shift) / count) for k in range(count)
        )
    ]


@st.composite
def combs(draw: st.DrawFn) -> Points:
    """Draw a back with teeth of any lengths, turned."""
    teeth = draw(st.lists(st.floats(0.01, 4.0), min_size=1, max_size=20))
    points = [(0.0, 0.0)]
    for number, length in enumerate(teeth):
        points += [(number + 0.5, 0.0), (number + 0.75, -length), (number + 1.0, 0.0)]
    points += [(float(len(teeth)), 0.5), (0.0, 0.5)]
    return turned(points, draw(st.floats(0.0, 7.0)))


@st.composite
def polyominoes(draw: st.DrawFn) -> Points:
    """Squares side by side, turned: many corners on one line, and many ways to cut."""
    cells = {(0, 0)}
    for direction in draw(
        st.lists(st.sampled_from([(1, 0), (-1, 0), (0, 1), (0, -1)]), min_size=1, max_size=20)
    ):
        x, y = draw(st.sampled_from(sorted(cells)))
        cells.add((x + direction[0], y + direction[1]))
    following: dict[tuple[int, int], tuple[int, int]] = {}
    for x, y in sorted(cells):
        for start, end, beyond in (
            ((x, y), (x + 1, y), (x, y - 1)),
            ((x + 1, y), (x + 1, y + 1), (x + 1, y)),
            ((x + 1, y + 1), (x, y + 1), (x, y + 1)),
            ((x, y + 1), (x, y), (x - 1, y)),
        ):
            if beyond not in cells:
                # Two squares that meet in a corner only make no simple outline.
                assume(start not in following)
                following[start] = end
    first = min(following)
    points, at = [first], following[first]
    while at != first:
        points.append(at)
        at = following[at]
    assume(len(points) == len(following))
    return turned([(float(x), float(y)) for x, y in points], draw(st.floats(0.0, 7.0)))


@st.composite
def drawn_boxes(draw: st.DrawFn) -> Points:
    """Draw a box as a hand does: many points a side, each a bit off."""
    count, off = draw(st.integers(2, 15)), draw(st.sampled_from([1e-12, 1e-7, 1e-4, 1e-2]))
    seed = draw(st.integers(0, 2**32))
    rng = random.Random(seed)
    sides = (
        lambda share: (share, 0.0),
        lambda share: (1.0, share),
        lambda share: (1.0 - share, 1.0),
        lambda share: (0.0, 1.0 - share),
    )
    points = [side(k / count) for side in sides for k in range(count)]
    return [(x + rng.uniform(-off, off), y + rng.uniform(-off, off)) for x, y in points]
