# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Friction of a body with the floor: force and torque together, within one limit surface.

Problem: a body that slides and turns at once has less friction either way than one that only
slides or only turns; two separate limits would give it too much.
Method: the limit surface of Goyal, Ruina and Papadopoulos (Planar sliding with dry friction,
1991), approximated by the ellipsoid of Howe and Cutkosky (Practical force-motion models for
sliding manipulation, 1996): (f / F)² + (τ / T)² = 1 with F = μ m g and T = lever F. The body slips
along its normal (maximum dissipation). One step is implicit (backward Euler), so that friction
stops a body and never turns it round: the slip that is left is the root of a scalar equation,
found by Newton's method as Moré and Sorensen do (Computing a trust region step, 1983).
Cost: some 30 operations on arrays.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.model.arrays import Flags, Floats

# Newton's steps. Without turning or without sliding the first is exact; eight leave 1e-12 of the
# slip at any ratio of the two limits from 0.01 to 100.
_ITERATIONS = 8


class Friction(NamedTuple):
    """
    Friction in a step, for k bodies.

    :ivar changes: (k, 3) float64: of velocity [m/s] and spin [rad/s]
    :ivar sticks: (k,) bool: the floor carries it along; no slip is left
    """

    changes: Floats
    sticks: Flags


def friction_of(slips: Floats, most: Floats, lever: Floats, gyration: Floats) -> Friction:
    """
    Return the friction of bodies with the floor.

    :param slips: (k, 3) float64: velocity [m/s] and spin [rad/s] relative to the floor that each
        would have after the step without friction
    :param most: (k,) float64: greatest change of velocity, μ g dt [m/s], > 0
    :param lever: (k,) float64: mean distance of the points that bear it [m], > 0
    :param gyration: (k,) float64: moment of inertia by mass [m²]
    """
    # Turns count by the speed at the lever.
    around = lever * np.abs(slips[:, 2])
    most_around = most * (lever * lever / gyration)
    across = np.hypot(slips[:, 0], slips[:, 1])
    sticks = (across / most) ** 2 + (around / most_around) ** 2 <= 1.0
    changes = -slips
    rows = np.flatnonzero(~sticks)
    if len(rows):
        shares = _shares(across[rows], around[rows], most[rows], most_around[rows])
        changes[rows] *= shares[:, (0, 0, 1)]
    return Friction(changes, sticks)


def _shares(across: Floats, around: Floats, most: Floats, most_around: Floats) -> Floats:
    """
    Return (k, 2) float64: the share of velocity and of spin that friction takes from slips.

    The slip s that is left solves (across / (s + most))² + (around / (s + most_around))² = 1.
    """
    left = np.maximum(np.maximum(across - most, around - most_around), 0.0)
    for _ in range(_ITERATIONS):
        sliding, turning = 1.0 / (left + most), 1.0 / (left + most_around)
        a, b = (across * sliding) ** 2, (around * turning) ** 2
        total = a + b
        left = left + total * (np.sqrt(total) - 1.0) / (a * sliding + b * turning)
    return np.stack((most / (left + most), most_around / (left + most_around)), axis=1)
