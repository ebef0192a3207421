# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Linear complementarity problems: λ >= 0, A λ + b >= 0, one of the two 0 in each row.

A is symmetric and positive semidefinite, with a positive diagonal; λ are impulses of contacts, A
is what they change the velocities of all contacts by. Plain floats: of eight rows and less, they
are quicker than arrays, and BLAS rounds otherwise on another processor.
"""

from __future__ import annotations

from collections.abc import Sequence
import math

# Part of the diagonal of A that is added to it: where many λ solve the problem, it chooses the
# most even ones (A. N. Tikhonov, regularisation).
_REGULARISATION = 1e-10
# Share of the greatest rate that is rounding, or comes from the regularisation.
_ROUNDING = 1e-8
# Greatest λ in units of the effective masses, as a multiple of the greatest rate. A single point
# has 1, a body on another of an eighth of its mass 9. A problem that no λ solves exceeds it, as
# that of a body wedged between two that do not move.
_GREATEST = 10.0
# Greatest count of exchanges: nearly all impacts take one or two, and at most five were seen.
_EXCHANGES = 10


def product(a: Sequence[float], b: Sequence[float]) -> float:
    """Return the sum of products, up to the end of the shorter sequence."""
    total = 0.0
    for x, y in zip(a, b, strict=False):
        total += x * y
    return total


def solve_lcp(matrix: Sequence[Sequence[float]], rates: Sequence[float]) -> list[float] | None:
    """
    Return λ, the most even one in units of the effective masses where many solve the problem.

    Block principal pivoting (J. J. Júdice and F. M. Pires, A block principal pivoting algorithm
    for large-scale strictly monotone linear complementarity problems, 1994): all rows that are on
    the wrong side change it at once.

    :param matrix: n rows of n: A
    :param rates: n: b
    :return: n; None where there is no λ up to `_GREATEST`, or the exchanges come to no end
    """
    rows = range(len(rates))
    scale = [1.0 / math.sqrt(matrix[i][i]) for i in rows]
    scaled = [[matrix[i][j] * scale[i] * scale[j] for j in rows] for i in rows]
    wanted = [-rates[i] * scale[i] for i in rows]
    greatest = max(map(abs, wanted))
    active = set(rows)
    for _ in range(_EXCHANGES):
        found = _solve_rows(scaled, wanted, sorted(active))
        left = [product(scaled[i], found) - wanted[i] for i in rows]
        wrong = {i for i in rows if (found[i] if i in active else left[i]) < -_ROUNDING * greatest}
        if not wrong:
            if max(found) > _GREATEST * greatest:
                return None
            return [max(found[i], 0.0) * scale[i] for i in rows]
        active ^= wrong
    return None


def _solve_rows(
    matrix: Sequence[Sequence[float]], wanted: Sequence[float], rows: Sequence[int]
) -> list[float]:
    """Return the solution of some rows of a regularised system, 0 in the others: Cholesky."""
    lower: list[list[float]] = []
    reduced: list[float] = []
    for i in rows:
        row: list[float] = []
        for j, above in zip(rows, lower, strict=False):
            row.append((matrix[i][j] - product(row, above)) / above[-1])
        row.append(math.sqrt(matrix[i][i] * (1.0 + _REGULARISATION) - product(row, row)))
        lower.append(row)
        reduced.append((wanted[i] - product(row, reduced)) / row[-1])
    found = [0.0] * len(wanted)
    for place in reversed(range(len(rows))):
        below = sum(lower[k][place] * found[rows[k]] for k in range(place + 1, len(rows)))
        found[rows[place]] = (reduced[place] - below) / lower[place][-1]
    return found
