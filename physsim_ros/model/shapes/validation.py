# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Checks that shapes share: lengths and points that can be simulated.

Law: a shape that has been constructed can be simulated. Pymunk 7.3.1 takes a degenerate polygon,
and raises in every later step.
"""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.checks import number
from physsim_ros.model.errors import BadOutline, BadSize, Malformed
from physsim_ros.model.transform import Point

# Least length of a shape [m]: a fifth of the engine's collision slop (5 mm), within which bodies
# overlap without force.
SMALLEST = 1e-3
# Greatest length and coordinate [m]: beyond 100 km a float64 position no longer resolves the slop
# after a long run.
LARGEST = 1e5
# Points of a shape: convex decomposition of as many takes three frames (50 ms).
MOST_POINTS = 1000
# Points closer than this are one point [m]: a thousandth of SMALLEST.
COINCIDENT = 1e-6


def checked_length(value: object, name: str) -> float:
    """
    Return a length as a float [m].

    :param name: of the field, for the refusal
    :raises BadSize: it is out of range
    :raises BadProperty: it is not a number
    :raises Malformed: it is not finite
    """
    length = number(value, name)
    if not SMALLEST <= length <= LARGEST:
        template = '{field} is {value:g} m; it must lie between {low:g} and {high:g} m'
        raise BadSize(template, field=name, value=length, low=SMALLEST, high=LARGEST)
    return length


def checked_points(points: Sequence[Point], name: str) -> Floats:
    """
    Return points as (n, 2) float64 [m].

    :param name: of the field, for the refusal
    :raises BadOutline: there are more than MOST_POINTS
    :raises BadSize: a coordinate is out of range
    :raises Malformed: they are no pairs of finite numbers
    """
    try:
        array = np.array([(x, y) for x, y in points], dtype=np.float64).reshape(-1, 2)
    except (TypeError, ValueError, OverflowError) as error:
        raise Malformed('{field} must be pairs of numbers', field=name) from error
    if not np.isfinite(array).all():
        raise Malformed('{field} has a coordinate that is not finite', field=name)
    if len(array) > MOST_POINTS:
        raise BadOutline('{field} has more than {most} points', field=name, most=MOST_POINTS)
    if len(array) and np.abs(array).max() > LARGEST:
        raise BadSize('{field} reaches further than {most:g} m', field=name, most=LARGEST)
    # Without negative zeros: equal shapes share one form, and have the same bits.
    return array + 0.0


def distinct_points(points: tuple[Point, ...], *, closed: bool) -> tuple[Point, ...]:
    """
    Return points without those that coincide with the one before them.

    :param points: [m]
    :param closed: whether the first point follows the last one
    """
    kept: list[Point] = []
    for point in points:
        if not kept or math.dist(point, kept[-1]) > COINCIDENT:
            kept.append(point)
    while closed and len(kept) > 1 and math.dist(kept[0], kept[-1]) <= COINCIDENT:
        kept.pop()
    return tuple(kept)


def as_tuples(points: Floats) -> tuple[Point, ...]:
    """Return (n, 2) float64 as pairs of floats."""
    return tuple(map(tuple, points.tolist()))
