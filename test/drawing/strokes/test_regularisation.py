# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Near-right angles become right, near-equal sides equal, near-level lines level; no others."""

import math

import numpy as np
from physsim_ros.drawing.strokes import regularisation
from physsim_ros.model.arrays import Floats
import pytest

NEAR = 0.12


def rotated_each(corners: list[tuple[float, float]], angle: float) -> Floats:
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array(corners) @ np.array(((cos, sin), (-sin, cos)))


def sides(corners: Floats) -> Floats:
    return np.hypot(*(np.roll(corners, -1, axis=0) - corners).T)


@pytest.mark.parametrize(('angle', 'yaw'), [(0.1, 0.0), (0.15, 0.15), (1.52, 0.0), (-0.6, -0.6)])
def test_a_rectangle_is_level_if_it_is_nearly(angle: float, yaw: float) -> None:
    pose, width, height = regularisation.rectangle(
        rotated_each([(0, 0), (3, 0), (3, 1), (0, 1)], angle), NEAR
    )

    assert pose[2] == pytest.approx(yaw, abs=1e-9)
    assert {round(width, 9), round(height, 9)} == {3.0, 1.0}


@pytest.mark.parametrize(('height', 'square'), [(0.9, True), (0.85, False)])
def test_a_rectangle_is_a_square_if_it_is_nearly(height: float, square: bool) -> None:
    _, width, high = regularisation.rectangle(
        np.array([(0, 0), (1, 0), (1, height), (0, height)]), NEAR
    )

    assert (width == high) == square


@pytest.mark.parametrize(('count', 'turn'), [(3, 0.06), (5, 0.06), (6, 0.06), (6, 0.26)])
def test_a_polygon_is_regular_and_lies_flat_if_it_is_nearly(count: int, turn: float) -> None:
    angle = np.arange(count) * 2 * math.pi / count - math.pi / 2 + math.pi / count + turn
    drawn = np.column_stack((np.cos(angle), np.sin(angle)))
    drawn[0] *= 1.05

    made = regularisation.polygon_outline(drawn, NEAR)

    assert np.ptp(sides(made)) < 1e-9
    # m: two corners are the lowest
    lowest = np.sort(made[:, 1])
    assert (lowest[1] - lowest[0] < 1e-9) == (turn < NEAR)


def test_nearly_right_angles_become_right_and_others_stay() -> None:
    house = np.array([(0, 0), (4, 0.15), (4.1, 2), (2.2, 3.4), (0.1, 2.1)])

    made = regularisation.polygon_outline(house, NEAR)

    assert made[0, 1] == pytest.approx(made[1, 1], abs=1e-9)
    assert made[1, 0] == pytest.approx(made[2, 0], abs=1e-9)
    assert made[4, 0] == pytest.approx(made[0, 0], abs=1e-9)
    assert made[3] == pytest.approx(house[3], abs=1e-9)


def test_a_triangle_with_two_sides_nearly_equal_is_isosceles() -> None:
    made = regularisation.polygon_outline(np.array([(0, 0), (2, 0), (1.08, 3)]), NEAR)

    left, right = math.dist(made[2], made[0]), math.dist(made[2], made[1])
    assert left == pytest.approx(right, abs=1e-9)


def test_a_triangle_with_sides_of_its_own_stays() -> None:
    drawn = np.array([(0.0, 0.0), (3.9, 0.8), (1.0, 2.3)])

    assert regularisation.polygon_outline(drawn, NEAR) == pytest.approx(drawn, abs=1e-9)


def test_lines_are_level_and_upright_where_they_nearly_are() -> None:
    made = regularisation.line(np.array([(0.1, 2.0), (0.0, 0.0), (3.0, 0.2), (5.0, 1.5)]), NEAR)

    assert made == pytest.approx(np.array([(0.05, 2.0), (0.05, 0.1), (3.0, 0.1), (5.0, 1.5)]))


def test_with_no_tolerance_everything_stays() -> None:
    corners = np.array([(0, 0), (4, 0.01), (4.01, 2), (0.01, 2.01)])

    assert (regularisation.polygon_outline(corners, 0.0) == corners).all()
    assert (regularisation.line(corners, 0.0) == corners).all()
