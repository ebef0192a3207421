# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
Linear complementarity problems: λ >= 0, A λ + b >= 0, one of the two 0 in each row.

A is symmetric and positive semidefinite, with a positive diagonal; λ are impulses of contacts, A
is what they change the velocities of all contacts by.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.model.arrays import Floats

# Least eigenvalue of A, its diagonal scaled to 1, that counts: two points of a contact with less
# are one (Box2D: `k_maxConditionNumber`, 1000).
_LEAST_EIGENVALUE = 1e-3
# Share of the greatest rate that is rounding.
_ROUNDING = 1e-9
# Exchanges at most: nearly all impacts take one or two, and no more than five were seen.
_EXCHANGES = 10


def solve_lcp(matrix: Floats, rates: Floats) -> Floats | None:
    """
    Return λ, the most even one in units of the effective masses where many solve the problem.

    Block principal pivoting (J. J. Júdice and F. M. Pires, A block principal pivoting algorithm
    for large-scale strictly monotone linear complementarity problems, 1994): all rows that are on
    the wrong side change it at once.

    :param matrix: (n, n) float64: A
    :param rates: (n,) float64: b
    :return: (n,) float64; None where the exchanges come to no end
    """
    scale = 1.0 / np.sqrt(matrix.diagonal())
    matrix, rates = matrix * np.outer(scale, scale), rates * scale
    rounding = _ROUNDING * float(np.abs(rates).max())
    active = np.ones(len(rates), np.bool_)
    for _ in range(_EXCHANGES):
        found = np.zeros(len(rates))
        part = matrix[active][:, active]
        found[active] = np.linalg.lstsq(part, -rates[active], rcond=_LEAST_EIGENVALUE)[0]
        wrong = np.where(active, found, matrix @ found + rates) < -rounding
        if not wrong.any():
            solution: Floats = np.maximum(found, 0.0) * scale
            return solution
        active ^= wrong
    return None
