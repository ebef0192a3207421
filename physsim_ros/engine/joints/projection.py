# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Position correction: gaps that a step leaves in joints are closed in positions, not by velocities.

Problem: the velocities that the solver leaves close no gap (the bias is only the centripetal
term), so gaps of joints would grow from step to step. A bias would close them by velocities,
which are energy where joints and contacts contradict each other.
Method: Newton's method on the constraint rows C(q) = 0 of all joints together, with the least
mass-weighted displacements (fast projection: Goldenthal, Harmon, Fattal, Bercovier and Grinspun,
"Efficient Simulation of Inextensible Cloth", SIGGRAPH 2007):

    (J M^-1 J^T) lambda = C,    dq = - M^-1 J^T lambda

J M^-1 J^T has an entry where two rows share a dynamic body, so that chains and trees have a narrow
band in the order of Cuthill and McKee; LAPACK's banded Cholesky (`dpbsv`) solves it. Bounds
(ropes, limits) are rows while they are violated. Islands share no body, thus no entry. One step is
enough for most; an island that turns fast gets more.
An island whose band would be wider than `WIDEST`, as a random network of joints, has its rows
solved one by one: the mass of a body is split among its rows (Tonge, Benevolenski and Voroshilov,
"Mass Splitting for Jitter-Free Parallel Rigid Body Simulation", SIGGRAPH 2012), which converges
more slowly, at a cost that is linear.
Cost: an evaluation of C and J for each kind of joint, and n b^2 for n rows of bandwidth b.
Without it chains and beams come apart (laws 14, 15, 20, 22, 23, 33).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from physsim_ros.engine.graph_search import Rows
from physsim_ros.engine.joints.kind import Batch
from physsim_ros.model.arrays import Flags, Floats
from scipy.linalg.lapack import dpbsv
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, reverse_cuthill_mckee

RowsOf = Callable[[Batch, Floats, Floats], tuple[Floats, Floats]]

# Violated bounds are closed but for this [m, rad]: Chipmunk stops a limit while it is violated.
LIMIT_SLOP = 1e-4
# The fastest that a gap is closed at [m/s, rad/s]: a body that is put elsewhere comes back like a
# thrown one, and joints that contradict each other move their bodies no further than that.
FASTEST_CORRECTION = 20.0
# Share of its diagonal that is added to J M^-1 J^T: joints may say the same twice, as the four of
# a parallelogram do.
REGULARISATION = 1e-7
# An island with a gap wider than this after a Newton step gets another one [m, rad], ...
CLOSED = 1e-4
# ... at most so many in a step of the engine.
MOST_STEPS = 8
# The furthest that a body turns in a Newton step [rad]: rows are linear for small turns only.
MOST_TURN = 0.25
# The furthest that a body moves in a Newton step, in sums of all gaps of its island: joints that
# contradict each other have nearly singular equations, whose solutions are of any size.
MOST_LEVERAGE = 10.0
# Rows that the band of an island may span. With n b^2 operations for n rows, 20,000 joints take a
# third of a second a Newton step; a net of 40 by 40 rods spans 80.
WIDEST = 128


class Projection:
    """
    The correction of the positions of jointed bodies.

    :param batches: joints with constraint rows, by kind, and the functions for these
    :param inverse: (m, 3) float64: inverse masses and moments of the bodies; 0 is not dynamic
    :param dt: of a step [s]
    """

    def __init__(
        self,
        batches: Sequence[tuple[Batch, RowsOf]],
        inverse: Floats,
        dt: float,
    ) -> None:
        self._batches = batches
        counts = [batch.lower.shape[1] for batch, _ in batches]
        owners = [
            np.repeat(batch.numbers, n) for (batch, _), n in zip(batches, counts, strict=True)
        ]
        first = [np.repeat(batch.a, n) for (batch, _), n in zip(batches, counts, strict=True)]
        other = [np.repeat(batch.b, n) for (batch, _), n in zip(batches, counts, strict=True)]
        none = np.empty(0, np.intp)
        self._owner = np.concatenate([none, *owners])
        # Each row has two sides: how it moves its first body, and how its second.
        self._sides = np.concatenate([none, *first, *other])
        self._inverse = inverse[self._sides]
        self._widest = FASTEST_CORRECTION * dt
        count = len(self._owner)
        dynamic = self._inverse.any(axis=1)
        # Rows of one island have one number, and so have its dynamic bodies.
        self._islands, self._island = _islands(self._sides, dynamic, count)
        self._bodies = len(inverse)
        rows_on = np.bincount(self._sides[dynamic], minlength=self._bodies)
        # Of each row: its body with the most rows is an island's least band.
        wide = self._widened((rows_on[self._sides] * dynamic).reshape(2, -1).max(axis=0))
        left, right = _sharing(self._sides, dynamic, split=np.tile(wide, 2))
        order = _narrow_order(left % count, right % count, count) if count else none
        place = np.empty(count, np.intp)
        place[order] = np.arange(count)
        self._order, self._place = order, place
        reach = np.zeros(count, np.intp)
        np.maximum.at(reach, right % count, np.abs(place[left % count] - place[right % count]))
        wide |= self._widened(reach)
        entries = place[left % count] >= place[right % count]
        entries &= ~wide[right % count] | (left == right)
        self._left, self._right = left[entries], right[entries]
        # The parts into which the mass of a body is split.
        parts = np.where(np.tile(wide, 2), rows_on[self._sides], 1)
        self._parts = parts[self._right]
        offset = place[self._left % count] - place[self._right % count]
        self._shape = int(offset.max(initial=0)) + 1, count
        # Lower form of LAPACK: entry (i, j) of the matrix stands at [i - j, j].
        self._at = offset * count + place[self._right % count]

    def _widened(self, reach: Rows) -> Flags:
        """
        Return which rows are of islands with too wide a band.

        :param reach: (r,) intp: how far each row is from others that share a body
        """
        wide = np.zeros(self._islands, np.bool_)
        wide[self._island[reach > WIDEST]] = True
        return wide[self._island]

    def close(self, poses: Floats, yielded: Sequence[int]) -> None:
        """
        Close the gaps of all joints but those that yielded in this step.

        :param poses: (m, 3) float64: of the jointed bodies [m, rad]; changed in place
        :param yielded: numbers of the joints that reached their greatest force
        """
        if not self._batches:
            return
        counts = ~np.isin(self._owner, yielded)
        gaps, jacobian = self._read(poses)
        # The share of a gap that is too wide to be closed now.
        rest = gaps - np.clip(gaps, -self._widest, self._widest)
        active = counts & (gaps != 0.0)
        for _ in range(MOST_STEPS):
            self._make_newton_step(poses, np.where(active, gaps - rest, 0.0), jacobian, active)
            gaps, jacobian = self._read(poses)
            wide = np.zeros(self._islands, np.bool_)
            wide[self._island[counts & (np.abs(gaps - rest) > CLOSED)]] = True
            if not wide.any():
                break
            active = counts & (gaps != 0.0) & wide[self._island]

    def _make_newton_step(
        self, poses: Floats, gaps: Floats, jacobian: Floats, active: Flags
    ) -> None:
        """
        Close gaps as far as rows are linear.

        :param gaps: (r,) float64: C [m, rad]
        :param jacobian: (2 r, 3) float64: J; changed in place
        :param active: (r,) bool: rows that count
        """
        jacobian[~np.concatenate((active, active))] = 0.0
        moved = jacobian * self._inverse
        shared = np.einsum('ij,ij->i', moved[self._left], jacobian[self._right]) * self._parts
        matrix = np.bincount(self._at, shared, self._shape[0] * self._shape[1])
        matrix = matrix.reshape(self._shape)
        matrix[0] *= 1.0 + REGULARISATION
        matrix[0, matrix[0] == 0.0] = 1.0
        _, push, failed = dpbsv(matrix, gaps[self._order], lower=1)
        if failed:
            # Only numbers that are not finite fail: the regularisation is far above rounding.
            return
        push = push[self._place]
        changes = moved * np.concatenate((push, push))[:, None]
        changes *= self._step_share(changes, gaps)[np.tile(self._island, 2), None]
        for axis in range(3):
            poses[:, axis] -= np.bincount(self._sides, changes[:, axis], self._bodies)

    def _step_share(self, changes: Floats, gaps: Floats) -> Floats:
        """
        Return the share of a Newton step that each island makes (trust region).

        :param changes: (2 r, 3) float64: displacements by each row, of its two bodies [m, rad]
        :param gaps: (r,) float64: C that the rows close [m, rad]
        :return: (islands,) float64, at most 1
        """
        sums = [np.bincount(self._sides, axis, self._bodies) for axis in changes.T]
        far, turn = np.hypot(sums[0], sums[1])[self._sides], np.abs(sums[2])[self._sides]
        island = np.tile(self._island, 2)
        farthest, most_turn = np.zeros(self._islands), np.zeros(self._islands)
        np.maximum.at(farthest, island, far)
        np.maximum.at(most_turn, island, turn)
        reach = MOST_LEVERAGE * np.bincount(self._island, np.abs(gaps), self._islands)
        by_turn = MOST_TURN / np.maximum(most_turn, 1e-300)
        return np.minimum(1.0, np.minimum(by_turn, reach / np.maximum(farthest, 1e-300)))

    def _read(self, poses: Floats) -> tuple[Floats, Floats]:
        """
        Return how far each row is from its bounds, and its Jacobian.

        :return: (r,) float64: C [m, rad], and (2 r, 3) float64: of the first body of each row,
            then of the second
        """
        gaps, first, other = [], [], []
        for batch, rows in self._batches:
            value, jacobian = rows(batch, poses[batch.a], poses[batch.b])
            slop = LIMIT_SLOP * (batch.lower < batch.upper)
            gap = np.maximum(value - (batch.upper + slop), 0.0)
            gap += np.minimum(value - (batch.lower - slop), 0.0)
            gaps.append(gap.ravel())
            first.append(jacobian[:, :, :3].reshape(-1, 3))
            other.append(jacobian[:, :, 3:].reshape(-1, 3))
        return np.concatenate(gaps), np.concatenate((*first, *other))


def _sharing(sides: Rows, dynamic: Flags, *, split: Flags) -> tuple[Rows, Rows]:
    """
    Return the pairs of sides that move the same dynamic body, each with itself too.

    :param sides: (2 r,) intp: the body of each
    :param dynamic: (2 r,) bool: whether that is dynamic
    :param split: (2 r,) bool: sides that are in no pair but with themselves
    """
    moving = np.flatnonzero(dynamic & ~split)
    order = moving[np.argsort(sides[moving], kind='stable')]
    groups = np.split(order, np.flatnonzero(np.diff(sides[order])) + 1)
    alone = np.flatnonzero(dynamic & split)
    left = [np.repeat(group, len(group)) for group in groups]
    right = [np.tile(group, len(group)) for group in groups]
    return np.concatenate((*left, alone)), np.concatenate((*right, alone))


def _islands(sides: Rows, dynamic: Flags, count: int) -> tuple[int, Rows]:
    """
    Return the number of islands, and the island of each row.

    :param sides: (2 r,) intp: the body of each
    :param dynamic: (2 r,) bool: whether that is dynamic, and joins its rows to an island
    :param count: of rows
    """
    # A graph of rows and bodies, with an edge where a row moves a body.
    _, bodies = np.unique(sides, return_inverse=True)
    rows = np.arange(2 * count) % max(1, count)
    ends = rows[dynamic], count + bodies[dynamic]
    size = count + int(bodies.max(initial=-1)) + 1
    graph = coo_array((np.ones(len(ends[0])), ends), shape=(size, size))
    _, label = connected_components(graph, directed=False)
    islands, island = np.unique(label[:count], return_inverse=True)
    return len(islands), island


def _narrow_order(one: Rows, other: Rows, count: int) -> Rows:
    """Return the rows in an order in which those that share a body come close together."""
    graph = coo_array((np.ones(len(one)), (one, other)), shape=(count, count)).tocsr()
    order: Rows = reverse_cuthill_mckee(graph, symmetric_mode=True).astype(np.intp)
    return order
