# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Least-squares fits to points: a straight line, a rectangle, an ellipse, a curve of few points.

Law: a fit is always returned; the caller decides by its residual whether it is good.
"""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.drawing.geometry import (
    principal_axis,
    quarter_heading,
    size_of,
    spaced,
    unit_vector,
)
from physsim_ros.drawing.strokes.resampled import COUNT, smoothed
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import (
    dots,
    next_vertices,
    norms,
    rotated_each,
    segment_distances,
)

# The wobble of a careful hand (rms) in shares of the size of an open stroke. It is worth no corner
# (`corner_detection.py`); what is farther from straight sides is a curve, which is simplified to
# half of that.
WOBBLE = 0.012
# Rounds of the fit of a rectangle, each point to its nearest side.
_ROUNDS = 3


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ellipse:
    """
    An ellipse, fitted to an outline.

    :param center: (2,) float64 [m]
    :param angle: of its longer axis [rad]
    :param half: its half axes, the longer first [m]
    :param error: standard deviation of the radius of the outline, in shares of it, once the
        ellipse is stretched to a circle
    """

    center: Floats
    angle: float
    half: tuple[float, float]
    error: float

    @property
    def aspect(self) -> float:
        """Return the shorter axis by the longer."""
        return self.half[1] / self.half[0]

    @property
    def radius(self) -> float:
        """Return the radius of the circle of the same area [m]."""
        return math.sqrt(self.half[0] * self.half[1])

    def corners(self, count: int) -> Floats:
        """Return a number of points on it, (count, 2) float64 [m]."""
        circle = np.array([unit_vector(2.0 * math.pi * at / count) for at in range(count)])
        points: Floats = self.center + rotated_each(circle * self.half, self.angle)
        return points


def line(points: Floats) -> tuple[Floats, Floats, float]:
    """Return the line of least squares: a point on it, its direction, the residual (rms) [m]."""
    middle = points.mean(axis=0)
    angle, _, across = principal_axis(points - middle)
    return middle, unit_vector(angle), math.sqrt(across / len(points))


def rectangle(corners: Floats) -> Floats:
    """Return the corners of the rectangle nearest to four corners, in their order."""
    middle = corners.mean(axis=0)
    sides = next_vertices(corners) - corners
    # Sides weigh by their length².
    angle = quarter_heading(sides, dots(sides, sides))
    local = rotated_each(corners - middle, -angle)
    signs = np.where(local >= 0, 1.0, -1.0)
    nearest: Floats = middle + rotated_each(signs * np.abs(local).mean(axis=0), angle)
    return nearest


def rectangle_of(outline: Floats) -> tuple[Floats, float]:
    """
    Return the corners of the rectangle of least squares of a closed polyline, and the residual.

    Directions are those of steps across a fortieth of the outline; each side then lies at the mean
    of the points that are nearest to it.

    :param outline: (n, 2) float64: evenly spaced, the first point not repeated [m]
    :return: (4, 2) float64 [m]; the distance from its sides (rms) [m]
    """
    steps = np.roll(outline, -max(len(outline) // 40, 1), axis=0) - outline
    angle = quarter_heading(steps, norms(steps))
    local = rotated_each(outline, -angle)
    # Left, right, lower and upper side.
    sides = np.concatenate((local.min(axis=0), local.max(axis=0)))[[0, 2, 1, 3]]
    across = local[:, [0, 0, 1, 1]]
    for _ in range(_ROUNDS):
        nearest = np.abs(across - sides).argmin(axis=1)
        for side in range(4):
            if (nearest == side).any():
                sides[side] = across[nearest == side, side].mean()
    off = np.abs(across - sides).min(axis=1)
    left, right, lower, upper = sides.tolist()
    corners = np.array(((left, lower), (right, lower), (right, upper), (left, upper)))
    return rotated_each(corners, angle), math.sqrt(float((off**2).mean()))


def ellipse(outline: Floats) -> Ellipse:
    """Return the ellipse of the same centroid and second moments of area as an outline."""
    base = outline.mean(axis=0)
    x, y = (outline - base).T
    u, v = np.roll(x, -1), np.roll(y, -1)
    # Moments about the mean, by Green's theorem: sums over the triangles of the sides.
    weight = x * v - y * u
    double = float(weight.sum())
    if abs(double) < 1e-6 * float((x * x + y * y).mean()):
        double = math.inf
    cx, cy = (float((weight * (a + b)).sum()) / 3 / double for a, b in ((x, u), (y, v)))
    xx = float((weight * (x * x + x * u + u * u)).sum()) / 6 / double - cx * cx
    yy = float((weight * (y * y + y * v + v * v)).sum()) / 6 / double - cy * cy
    xy = float((weight * (2 * (x * y + u * v) + x * v + u * y)).sum()) / 12 / double - cx * cy
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    middle, apart = (xx + yy) / 2, math.hypot((xx - yy) / 2, xy)
    # The half axes are twice the radii of gyration; those of an eight have no square root.
    longer, shorter = (
        2.0 * math.sqrt(max(each, 1e-18)) for each in (middle + apart, middle - apart)
    )
    center = base + np.array((cx, cy))
    along, across = rotated_each(outline - center, -angle).T
    radii = np.hypot(along / longer, across / shorter)
    error = float(radii.std() / radii.mean())
    return Ellipse(center=center, angle=angle, half=(longer, shorter), error=error)


def simplified(path: Floats, bends: Floats, size: float) -> Floats | None:
    """
    Return a curve of few points, or None where straight sides fit the stroke.

    :param path: (n, 2) float64: of an open stroke, smooth, evenly spaced [m]
    :param bends: (k, 2) float64: ends and bends of the sides [m]
    :param size: of the stroke [m]
    """
    off = segment_distances(path, bends[:-1, None], bends[1:, None]).min(axis=0)
    if math.sqrt(float((off**2).mean())) <= WOBBLE * size:
        return None
    return _traced(path, size)


def traced(outline: Floats) -> Floats:
    """Return a closed polyline simplified to few points."""
    path = spaced(np.vstack((outline, outline[:1])), COUNT + 1)[:-1]
    path = smoothed(path, closed=True)
    size = size_of(path)
    # Starting at the point farthest from the middle, which is a corner of the result.
    path = np.roll(path, -int(((path - path.mean(axis=0)) ** 2).sum(axis=1).argmax()), axis=0)
    return _traced(np.vstack((path, path[:1])), size)[:-1]


def _traced(path: Floats, size: float) -> Floats:
    """Return a polyline of a size simplified by the Ramer-Douglas-Peucker algorithm."""
    kept, parts = {0, len(path) - 1}, [(0, len(path) - 1)]
    while parts:
        first, last = parts.pop()
        off = segment_distances(path[slice(first, last + 1)], path[first], path[last])
        furthest = first + int(off.argmax())
        if off.max() > WOBBLE / 2 * size:
            kept.add(furthest)
            parts += [(first, furthest), (furthest, last)]
    return path[sorted(kept)]
