# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A fan: rays from one point, by their angles, with the nearest distance along each.

Method: angular intervals. As seen from a point, an edge or a disc covers an interval of angles;
only the rays in it are intersected with it, so that the cost is that of pairs that meet. Angles
are compared as diamond angles, a monotone function of the angle without transcendental functions,
so that readings have the same bits on every processor.
"""

from __future__ import annotations

from collections.abc import Iterator
import itertools
from typing import NamedTuple

import numpy as np
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.transform import Point

# Greatest number of pairs of a ray and an edge or disc that are in memory at once, 100 bytes each.
_MOST_PAIRS = 2**20
# As a diamond angle.
_HALF_TURN = 2.0


class Rays(NamedTuple):
    """
    Rays from one point, counter-clockwise, within a turn; at least one.

    :ivar origin: x, y [m]
    :ivar x: (k,) float64: of their unit vectors
    :ivar y: (k,) float64: of the same
    """

    origin: Point
    x: Floats
    y: Floats


class Fan:
    """
    The nearest distance along each of some rays, of all that they have met.

    :param rays: of the fan

    :ivar x: (2 k,) float64: of the unit vectors of the rays; each ray has a second place, after
        all first ones, for intervals that pass the first ray
    :ivar y: (2 k,) float64: of the same
    """

    def __init__(self, rays: Rays) -> None:
        # `np.tile` takes four times as long.
        self.x, self.y = (np.concatenate((each, each)) for each in rays[1:])
        angles = _diamond_angles(rays.x, rays.y)
        self._first = angles[0]
        self._angles = self._since_first(angles)
        self._distances = np.full(2 * len(angles), np.inf)

    def pairs(self, x: Floats, y: Floats) -> Iterator[tuple[slice, Ints, Ints]]:
        """
        Yield the rays in each of m intervals of less than half a turn, ends included.

        :param x: (2, m) float64: of vectors at which the intervals begin, and at which they end,
            counter-clockwise
        :param y: (2, m) float64: of the same
        :return: some of the intervals; places of the rays in the first one, in the second one and
            so on; counts of these
        """
        if not x.size:
            return
        lows, highs = self._since_first(_diamond_angles(x, y))
        firsts = self._angles.searchsorted(lows, 'left')
        counts = self._angles.searchsorted(highs, 'right') - firsts
        # An interval passes the first ray; one that rounding has turned round is empty.
        counts += len(self._angles) * (lows - highs > _HALF_TURN)
        np.maximum(counts, 0, out=counts)
        ends = counts.cumsum()
        total = int(ends[-1]) if len(ends) else 0
        parted = ends.searchsorted(np.arange(0, total, _MOST_PAIRS), 'right').tolist()
        for low, high in itertools.pairwise((*parted, len(ends))):
            part = slice(low, high)
            before = ends[part] - counts[part]
            places = np.arange(before[0], ends[high - 1])
            places += (firsts[part] - before).repeat(counts[part])
            yield part, places, counts[part]

    def meet(self, places: Ints, distances: Floats) -> None:
        """
        Count what rays have met.

        :param places: (p,) int64: of the rays, as `pairs` has them
        :param distances: (p,) float64: from the origin [m]
        """
        np.minimum.at(self._distances, places, distances)

    def nearest(self) -> Floats:
        """Return (k,) float64: the nearest distance along each ray [m]; infinite for none."""
        nearest: Floats = self._distances.reshape(2, -1).min(axis=0)
        return nearest

    def _since_first(self, angles: Floats) -> Floats:
        """Return diamond angles from the first ray on, 0 .. 4."""
        since: Floats = angles - self._first
        since += 2.0 * _HALF_TURN * (since < 0.0)
        return since


def _diamond_angles(x: Floats, y: Floats) -> Floats:
    """
    Return -2 .. 2 for the angles of minus to plus half a turn of vectors.

    It is the way from the x axis along the square with its corners on the axes.
    """
    angles: Floats = np.copysign(1.0 - x / (np.abs(x) + np.abs(y)), y)
    return angles
