# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A closed polyline that crosses itself has a simple outline around it, or is no solid."""

import math

import numpy as np
from physsim_ros.drawing.strokes.outer_boundary import outer_boundary
from physsim_ros.model.shapes import signed_area
import pytest

ANGLE = np.arange(5) * 0.8 * math.pi
STAR = np.column_stack((np.cos(ANGLE), np.sin(ANGLE)))


def test_a_simple_outline_is_its_own_boundary_and_runs_counter_clockwise() -> None:
    square = np.array([(0, 0), (0, 1), (1, 1), (1, 0)], dtype=np.float64)

    boundary = outer_boundary(square)

    assert boundary is not None
    assert {tuple(corner) for corner in boundary.tolist()} == {(0, 0), (0, 1), (1, 1), (1, 0)}
    assert signed_area(boundary) == pytest.approx(1.0)


@pytest.mark.parametrize('star', [STAR, STAR[::-1], STAR @ np.array([(2.0, 0.5), (0.0, 1.0)])])
def test_a_pentagram_has_ten_corners_its_own_among_them(star: np.ndarray) -> None:
    boundary = outer_boundary(star)

    assert boundary is not None
    assert len(boundary) == 10
    for corner in star:
        assert np.hypot(*(boundary - corner).T).min() == pytest.approx(0.0, abs=1e-12)


def test_ends_that_cross_at_a_corner_stay_at_the_solid_as_they_were_drawn() -> None:
    crossing = np.array([(0.0, -0.2), (0, 3), (3, 3), (3, 0), (-0.2, 0.0)])

    boundary = outer_boundary(crossing)

    assert boundary is not None
    # m²: the square of 3 m, and the triangle that the ends leave
    assert signed_area(boundary) == pytest.approx(9.0, abs=0.1)


def test_an_eight_and_a_spiral_are_no_solids() -> None:
    hourglass = np.array([(0, 0), (1, 1), (1, 0), (0, 1)], dtype=np.float64)
    turn = np.linspace(0.0, 5.0 * math.pi, 50)[10:]
    spiral = np.column_stack((turn * np.cos(turn), turn * np.sin(turn)))

    assert outer_boundary(hourglass) is None
    assert outer_boundary(spiral) is None
