# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Constraint rows of many bodies, solved directly and together.

Impulses λ change velocities v by M^-1 J^T λ. Those with which the rows J v reach their targets,

    [ M   J^T ] [ dv ]   [ 0 ]
    [ J   -E  ] [ -λ ] = [ target - J v ],

form a sparse, symmetric, quasi-definite system, which has LDL^T factors in every order (R. J.
Vanderbei, "Symmetric Quasidefinite Matrices", SIAM Journal on Optimization 1995). QDLDL, the
factorisation of the solver OSQP, finds an order of little fill (approximate minimum degree) and
factors. It is plain C without BLAS: every processor adds in the same order. E is a small part of
the diagonal of J M^-1 J^T, since rows may say the same twice, as the joints of a parallelogram do.

Rows whose λ has bounds make it a mixed linear complementarity problem: a row reaches its target,
or λ is at a bound and J v is on the other side of the target. Block principal pivoting (J. J.
Júdice and F. M. Pires, "A block principal pivoting algorithm for large-scale strictly monotone
linear complementarity problems", Computers & Operations Research 1994): all rows on the wrong side
change it at once. That may go in a circle, even with three rows of one body; so after half of the
factorisations only the last of them changes, which comes to an end (K. G. Murty, "Note on a
Bard-type scheme for solving the complementarity problem", Opsearch 1974).

Islands share no dynamic body, so that no entry of the matrix connects them. Rounding, and which
row is the last one, are decided island by island, so that none depends on another.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.engine.graph_search import components, Rows
from physsim_ros.model.arrays import Flags, Floats, Ints
import qdldl

# Factorisations of a problem with bounds, at most.
ROUNDS = 30
# Rounding of J v: a row is on the wrong side of its target beyond that [m/s], or [m] of positions.
ROUNDING = 1e-7
# Rounding of λ, as a share of the greatest of its island.
SHARE_OF_ROUNDING = 1e-9


class Problem(NamedTuple):
    """
    Rows with their targets and bounds.

    :ivar jacobian: (r, 2, 3) float64: J, of the first and the second body of each row
    :ivar wanted: (r,) float64: target - J v [m/s, rad/s]
    :ivar lower: (r,) float64: least λ [N s, N m s]
    :ivar upper: (r,) float64: greatest λ [N s, N m s]
    """

    jacobian: Floats
    wanted: Floats
    lower: Floats
    upper: Floats


class Solution(NamedTuple):
    """
    Impulses of rows.

    :ivar impulses: (r,) float64: λ [N s, N m s]
    :ivar changes: (b, 3) float64: of velocities [m/s, rad/s]
    :ivar sides: (r,) int64: -1 and 1 where λ is at the lower and at the upper bound, else 0
    :ivar wrong: (r,) bool: rows that are still on the wrong side
    """

    impulses: Floats
    changes: Floats
    sides: Ints
    wrong: Flags


class SaddlePoint:
    """
    The system of a set of rows, whose Jacobian may change.

    :param ends: (r, 2) intp: the two bodies of each row
    :param inverse: (b, 3) float64: inverse masses, masses and moments of the bodies [1/kg, 1/kg,
        1/(kg m²)]; 0 for those that forces do not move

    :ivar islands: (b,) intp: the island of each body
    :ivar island_of_row: (r,) intp: the island of each row
    """

    def __init__(self, ends: Rows, inverse: Floats) -> None:
        self.ends, self.inverse = ends, inverse
        # (6 r,) of x, y and yaw of both bodies of each row, among those of all bodies.
        self._coordinates = (3 * ends[..., None] + np.arange(3)).ravel()
        dynamic: Flags = np.asarray(inverse.any(axis=1))
        self.islands = components(len(inverse), ends[dynamic[ends].all(axis=1)])
        self.island_of_row = self.islands[np.where(dynamic[ends[:, 0]], *ends.T)]
        self._moved = np.flatnonzero(np.isin(np.arange(len(inverse)), ends) & dynamic)
        place = np.full(len(inverse), -1, np.intp)
        place[self._moved] = np.arange(len(self._moved))
        self._unknowns, count = 3 * len(self._moved), len(ends)
        # Columns of the upper triangle: an entry each of M, then of each row J and E, its bodies
        # in ascending order.
        places = place[ends]
        order = np.argsort(places, axis=1, kind='stable')
        ascending = np.take_along_axis(places, order, axis=1)
        entries = np.repeat(ascending, 3, axis=1) * 3 + np.tile(np.arange(3), 2)
        present = np.column_stack((np.repeat(ascending >= 0, 3, axis=1), np.ones(count, np.bool_)))
        own = np.arange(self._unknowns, self._unknowns + count)
        indices = np.column_stack((entries, own))[present]
        # Of each entry its place in J and E of the rows, which stand side by side.
        sources = np.repeat(order, 3, axis=1) * 3 + np.tile(np.arange(3), 2)
        sources = np.column_stack((sources, np.full(count, 6))) + 7 * np.arange(count)[:, None]
        self._sources = sources[present]
        self._rows = np.empty((count, 7))
        self._inverse_of_rows = inverse[ends].reshape(-1, 6)
        ends_of_rows = self._unknowns + np.cumsum(present.sum(axis=1))
        self._masses = np.zeros_like(inverse)
        self._masses[self._moved] = 1.0 / inverse[self._moved]
        values = np.concatenate((self._masses[self._moved].ravel(), np.ones(len(indices))))
        _, self._of_rows = np.split(values, [self._unknowns])
        size = self._unknowns + count
        first = np.arange(self._unknowns + 1)
        # A fifth of the imports of a node; a world without joints needs none of it.
        from scipy.sparse import csc_array  # noqa: PLC0415

        self._matrix = csc_array(
            (values, np.concatenate((first[:-1], indices)), np.concatenate((first, ends_of_rows))),
            shape=(size, size),
        )
        self._factors: qdldl.Solver | None = None

    def rates(self, jacobian: Floats, velocities: Floats) -> Floats:
        """Return (r,) float64: J v, of (b, 3) velocities."""
        parts = (jacobian * velocities.take(self.ends, axis=0)).reshape(-1, 6)
        rates: Floats = np.add.reduce(parts, axis=1)
        return rates

    def momenta(self, jacobian: Floats, impulses: Floats) -> Floats:
        """Return (b, 3) float64: J^T λ [N s, N m s]."""
        pushes = (jacobian * impulses[:, None, None]).ravel()
        # Weighted counts are float64, which the types of NumPy 2.4 do not say.
        momenta = np.bincount(self._coordinates, pushes, self.inverse.size)
        return momenta.reshape(-1, 3)  # type: ignore[return-value]

    def products(self, one: Floats, other: Floats) -> Floats:
        """Return (b,) float64: the part of each body in u M v of two changes of velocities [J]."""
        sums: Floats = np.add.reduce(one * other * self._masses, axis=1)
        return sums

    def factor(self, jacobian: Floats, active: Flags, regularisation: Floats) -> None:
        """
        Factor the system of the rows that are active.

        :param regularisation: (r,) float64: E, as a share of the diagonal of J M^-1 J^T
        """
        used = self._rows[:, :6]
        np.multiply(jacobian.reshape(-1, 6), active[:, None], out=used)
        diagonal = np.add.reduce(used * used * self._inverse_of_rows, axis=1)
        self._rows[:, 6] = np.where(diagonal > 0.0, -regularisation * diagonal, -1.0)
        # Any mode but that of the default writes without a copy.
        self._rows.take(self._sources, out=self._of_rows, mode='clip')
        if self._factors is None:
            self._factors = qdldl.Solver(self._matrix, upper=True)
        else:
            self._factors.update(self._matrix, upper=True)

    def solve_active(self, wanted: Floats, momenta: Floats | None = None) -> tuple[Floats, Floats]:
        """
        Return λ of the rows that are active, and what changes.

        :param wanted: (r,) float64: 0 for rows that are not active
        :param momenta: (b, 3) float64: J^T λ of the rows that are not [N s, N m s]
        :return: (r,) float64 and (b, 3) float64: changes of velocities
        """
        pushes = np.zeros(self._unknowns) if momenta is None else momenta[self._moved].ravel()
        # For `solve` to be called is for `factor` to have been.
        found = self._factors.solve(np.concatenate((pushes, wanted)))  # type: ignore[union-attr]
        changes, count = np.zeros(self.inverse.shape), self._unknowns
        changes[self._moved] = found[:count].reshape(-1, 3)
        return -found[count:], changes

    def solve(
        self, problem: Problem, sides: Ints, regularisation: Floats, rounds: int = ROUNDS
    ) -> Solution:
        """
        Solve rows with bounds.

        :param sides: (r,) int64: the first guess of those of the solution
        :param regularisation: (r,) float64: E, as a share of the diagonal of J M^-1 J^T
        :param rounds: factorisations at most
        """
        jacobian, wanted, lower, upper = problem
        sides = sides.copy()
        for following in reversed(range(rounds)):
            active = sides == 0
            fixed = np.where(sides < 0, lower, upper)
            fixed[active] = 0.0
            self.factor(jacobian, active, regularisation)
            momenta = self.momenta(jacobian, fixed) if np.count_nonzero(fixed) else None
            found, changes = self.solve_active(np.where(active, wanted, 0.0), momenta)
            impulses = np.where(active, found, fixed)
            rounding = SHARE_OF_ROUNDING * self._greatest(impulses)
            below, above = impulses < lower - rounding, impulses > upper + rounding
            beyond = self.rates(jacobian, changes) - wanted
            inward = np.where(sides < 0, beyond < -ROUNDING, (sides > 0) & (beyond > ROUNDING))
            inward &= lower < upper
            wrong = below | above | inward
            if not following or not np.count_nonzero(wrong):
                break
            changed = wrong if following >= rounds // 2 else self._last(wrong)
            sides[changed] = np.where(below, -1, np.where(above, 1, 0))[changed]
        return Solution(impulses, changes, sides, wrong)

    def _greatest(self, values: Floats) -> Floats:
        """Return (r,) float64: for each row the greatest absolute value in its island."""
        greatest = np.zeros(len(self.islands))
        np.maximum.at(greatest, self.island_of_row, np.abs(values))
        return greatest[self.island_of_row]

    def _last(self, rows: Flags) -> Flags:
        """Return (r,) bool: of some rows, (r,) bool, the last one in each island."""
        numbers = np.flatnonzero(rows)
        places = np.unique(self.island_of_row[numbers][::-1], return_index=True)[1]
        last = np.zeros_like(rows)
        last[numbers[::-1][places]] = True
        return last

    def refine(self, problem: Problem, solution: Solution) -> Solution:
        """Return a solution of `solve` that comes closer to the targets, which E keeps it from."""
        active = solution.sides == 0
        left = problem.wanted - self.rates(problem.jacobian, solution.changes)
        impulses, changes = self.solve_active(np.where(active, left, 0.0))
        return solution._replace(
            impulses=solution.impulses + np.where(active, impulses, 0.0),
            changes=solution.changes + changes,
        )
