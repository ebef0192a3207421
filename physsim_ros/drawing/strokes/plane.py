# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Plane geometry: angles, principal axes, linear maps and small systems of equations.

Law: the same bits on every x86-64 processor with FMA. BLAS and LAPACK (`@`, `dot`, `linalg`,
`convolve`) choose kernels by processor, and so do NumPy's loops for arctan2, exp, log and powers
but squares: here are closed forms, and the functions of `math`.
"""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import cross, dots, norms

_atan2 = np.frompyfunc(math.atan2, 2, 1)


def headings(vectors: Floats) -> Floats:
    """Return the directions of plane vectors (..., 2), -π .. π [rad]."""
    return np.asarray(_atan2(vectors[..., 1], vectors[..., 0]), dtype=np.float64)


def angles(a: Floats, b: Floats) -> Floats:
    """Return the angles from directions a to directions b [rad], counter-clockwise."""
    return np.asarray(_atan2(cross(a, b), dots(a, b)), dtype=np.float64)


def unit_vector(angle: float) -> Floats:
    """Return the unit vector of a direction [rad]."""
    return np.array((math.cos(angle), math.sin(angle)))


def quarter_heading(sides: Floats, weights: Floats) -> float:
    """
    Return the mean direction of sides modulo a quarter turn, -π/4 .. π/4 [rad].

    Four times the direction is the same for all sides of a rectangle.

    :param sides: (n, 2) float64
    :param weights: (n,) float64
    """
    x, y = (sides / np.maximum(norms(sides), 1e-300)[:, None]).T
    for _ in range(2):
        # The square of a complex number of length 1: twice its angle.
        x, y = x * x - y * y, 2.0 * x * y
    return math.atan2(float((weights * y).sum()), float((weights * x).sum())) / 4


def principal_axis(away: Floats) -> tuple[float, float, float]:
    """
    Return the greater principal axis of inertia of points about the origin.

    :param away: (n, 2) float64 [m]
    :return: its direction [rad]; the sums of squares along it and across it [m²]
    """
    x, y = away[:, 0], away[:, 1]
    xx, xy, yy = float((x * x).sum()), float((x * y).sum()), float((y * y).sum())
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    middle, half = (xx + yy) / 2, math.hypot((xx - yy) / 2, xy)
    return angle, middle + half, max(middle - half, 0.0)


def stretched(points: Floats, along: Floats, factor: float) -> Floats:
    """Return points stretched by a factor along a unit vector: straight lines stay straight."""
    return points + ((factor - 1.0) * dots(points, along))[..., None] * along


def least_squares(columns: Floats, target: Floats) -> tuple[float, float]:
    """
    Return a, b for which a · one + b · other is nearest to the target (normal equations).

    :param columns: (n, 2) float64: one, other; 0, 0 is returned where they are parallel
    :param target: (n,) float64
    """
    one, other = columns[:, 0], columns[:, 1]
    aa, ab, bb = float((one * one).sum()), float((one * other).sum()), float((other**2).sum())
    at, bt = float((one * target).sum()), float((other * target).sum())
    determinant = aa * bb - ab * ab
    if determinant <= 1e-18 * aa * bb:
        return 0.0, 0.0
    return (at * bb - bt * ab) / determinant, (bt * aa - at * ab) / determinant
