# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Swept boxes: which bodies could meet in the coming step, at a bounded cost.

Problem: boxes of fast bodies span the world, so that n bodies make n² pairs in a step that no
signal ends. Method: an island has a budget of pairs, shared by its fast bodies. A body whose
swept box meets more than its share is followed not to the end of the step, but to a *horizon* at
which the box meets so many; the engine's own result holds from there on. Known engines bound the
same by a greatest speed of bodies (`b2_maxTranslation` in Box2D, 2 m a step; Jolt's
`mMaxLinearVelocity`), but here every finite velocity is a velocity.

Laws: a horizon follows from what a body itself could meet, and a body that meets little is
followed to the end, however fast it is and however many others there are elsewhere.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from physsim_ros.engine.ccd.broad_phase import count_candidates, count_on_axes, pairs_in_parts
from physsim_ros.engine.ccd.time_of_impact import Motions
from physsim_ros.model.arrays import Flags, Floats, Ints

# Pairs of corners that an island may compare in a round of impacts: those of 125 boxes that
# all may meet each other, or of one box and 15,000 others.
BUDGET = 250_000
# Greatest count of cuts of a horizon, after which a body is not followed at all. The count of
# pairs grows with the fourth power of the displacement or less.
_CUTS = 8
# Pairs of boxes that are compared at once: some 30 MB.
_PART = 100_000


class SweptBoxes:
    """
    Bounds of the ways of all bodies in a step.

    :param motions: of bodies, then of shapes that never move
    :param reach: (n,) float64: of the bodies from their centres of mass [m]
    :param standing: (s, 4) float64: boxes of the shapes
    :param corners: (n + s,) float64: of their shapes, the unit of the budget

    :ivar boxes: (n + s, 4) float64: left, bottom, right, top [m]
    """

    def __init__(self, motions: Motions, reach: Floats, standing: Floats, corners: Floats) -> None:
        count = len(reach)
        self._motions = motions
        self._reach = reach
        self._corners = corners
        self._horizons = np.ones(len(corners))
        self.boxes = np.concatenate((np.zeros((count, 4)), standing))
        # (n + s, 2) float64: centres at the beginning of a motion and at its horizon, and how far
        # a body is from the straight line between them at most.
        self._starts = (self.boxes[:, :2] + self.boxes[:, 2:]) / 2
        self._ends = self._starts.copy()
        self._halves = (self.boxes[:, 2:] - self.boxes[:, :2]) / 2
        self.fit_boxes(np.arange(count))

    def fit_boxes(self, rows: Ints) -> None:
        """Bound the ways of bodies from where their motions begin to their horizons."""
        motions = self._motions
        self._horizons[rows] = np.maximum(self._horizons[rows], motions.since[rows])
        starts = motions.poses[rows, :2]
        ends = motions.poses_at(rows, self._horizons[rows])[0][:, :2]
        # Height of the arc over its chord, at most.
        arm = np.hypot(*(starts - motions.pivots[rows]).T)
        margin = (self._reach[rows] + arm * motions.rates[rows, 2] ** 2 / 8)[:, None]
        self._starts[rows], self._ends[rows], self._halves[rows] = starts, ends, margin
        self.boxes[rows, :2] = np.minimum(starts, ends) - margin
        self.boxes[rows, 2:] = np.maximum(starts, ends) + margin

    def candidates(self, changed: Ints) -> Iterator[tuple[Ints, Ints]]:
        """
        Return the pairs whose boxes overlap, each once, part by part.

        :param changed: rows, one of each pair at least
        :return: (p,) and (p,) rows of a part, the lower one first
        """
        first = np.zeros(len(self.boxes), np.bool_)
        first[changed] = True
        return pairs_in_parts(self.boxes, self._cut_horizons(first), most=_PART)

    def _cut_horizons(self, first: Flags) -> Flags:
        """
        Bring the horizons of bodies nearer until they meet no more than the budget permits.

        :param first: (n + s,) bool: bodies in question
        :return: (n + s,) bool: those that are within the budget
        """
        corners = self._corners
        if corners[first].sum() * corners.sum() <= BUDGET:
            return first
        for cut in range(_CUTS):
            cost = self._costs(first)
            rows = np.flatnonzero(cost > BUDGET)
            if not len(rows) or cut == _CUTS - 1:
                break
            since = self._motions.since[rows]
            share = np.minimum(np.sqrt(np.sqrt(BUDGET / cost[rows])), 0.5)
            self._horizons[rows] = since + (self._horizons[rows] - since) * share
            self.fit_boxes(rows)
        return first & (cost <= BUDGET)

    def _costs(self, first: Flags) -> Floats:
        """
        Return the pairs of corners in the island of each body, at most: near it, times fast ones.

        :param first: (n + s,) bool: bodies in question, all of which are fast
        :return: (n + s,) float64; 0 for others
        """
        near, fast = self._corners, np.where(first, self._corners, 0.0)
        costs: Floats = count_on_axes(self.boxes, np.stack((near, fast))).prod(axis=0)
        costs[~first] = 0.0
        crowded = costs > BUDGET
        if crowded.any():
            # Bodies that are beside or above each other do not meet: counted in the plane.
            counts = count_candidates(self.boxes, crowded, near)
            counts *= count_candidates(self.boxes, crowded, fast)
            costs[crowded] = counts[crowded]
        return costs

    def come_near(self, one: Ints, other: Ints) -> Flags:
        """Tell which pairs have boxes that overlap at one time, which move on straight lines."""
        since = np.maximum(self._motions.since[one], self._motions.since[other])
        until = np.minimum(self._horizons[one], self._horizons[other])
        gap = self._centers(other, since) - self._centers(one, since)
        way = self._centers(other, until) - self._centers(one, until) - gap
        reach = self._halves[one] + self._halves[other]
        with np.errstate(divide='ignore'):
            times = np.stack(((-gap - reach) / way, (-gap + reach) / way))
        inside = np.where(np.abs(gap) <= reach, -np.inf, np.inf)
        enters = np.where(way == 0.0, inside, times.min(axis=0)).max(axis=1)
        leaves = np.where(way == 0.0, np.inf, times.max(axis=0)).min(axis=1)
        near: Flags = (since <= until) & (enters <= np.minimum(leaves, 1.0)) & (leaves >= 0.0)
        return near

    def _centers(self, rows: Ints, shares: Floats) -> Floats:
        """Return (p, 2) the centres of boxes at shares of the step, on straight lines [m]."""
        since = self._motions.since[rows]
        lapse = self._horizons[rows] - since
        share = (shares - since) / np.where(lapse > 0.0, lapse, 1.0)
        return self._starts[rows] + (self._ends[rows] - self._starts[rows]) * share[:, None]
