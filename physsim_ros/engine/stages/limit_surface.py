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
Cost: some 6 operations on arrays, and 150 where a body slips.
"""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.transform import norms

# Newton's steps. Without turning or without sliding the first is exact; eight leave 1e-12 of the
# slip at any ratio of the two limits from 0.01 to 100.
_ITERATIONS = 8


class LimitSurface(NamedTuple):
    """
    The limit surfaces of k bodies, as changes of velocity in a step.

    :ivar lever: (k,) float64: mean distance of the points that bear a body [m]
    :ivar most: (k,) float64: greatest change of velocity [m/s]
    :ivar most_around: (k,) float64: greatest change of the speed of a turn at the lever [m/s]
    :ivar axes: (k, 3) float64: greatest change of the velocity in x and in y [m/s], and of the
        spin [rad/s], each alone
    """

    lever: Floats
    most: Floats
    most_around: Floats
    axes: Floats

    @classmethod
    def of(cls, most: Floats, lever: Floats, gyration: Floats) -> Self:
        """
        Return the limit surfaces of bodies.

        :param most: (k,) float64: greatest change of velocity, μ g dt [m/s], > 0
        :param lever: (k,) float64: mean distance of the points that bear it [m], > 0
        :param gyration: (k,) float64: moment of inertia by mass [m²]
        """
        most_around = most * (lever * lever / gyration)
        axes = np.stack((most, most, most_around / lever), axis=1)
        return cls(lever, most, most_around, axes)

    def squares(self, changes: Floats) -> Floats:
        """Return (k,) float64: the squares of (k, 3) changes by the surface; on it, 1."""
        shares = changes / self.axes
        squares: Floats = np.add.reduce(shares * shares, axis=1)
        return squares


class Friction(NamedTuple):
    """
    Friction in a step, for k bodies.

    :ivar changes: (k, 3) float64: of velocity [m/s] and spin [rad/s]
    :ivar slides: (k,) bool: slip is left; the floor carries the others along
    """

    changes: Floats
    slides: Flags


def friction_of(slips: Floats, surface: LimitSurface) -> Friction:
    """
    Return the friction of bodies with the floor.

    :param slips: (k, 3) float64: velocity [m/s] and spin [rad/s] relative to the floor that each
        would have after the step without friction
    :param surface: of the bodies
    """
    changes, slides = -slips, surface.squares(slips) > 1.0
    rows = slides.nonzero()[0]
    if len(rows):
        lever, most, most_around = (each.take(rows) for each in surface[:3])
        slips = slips.take(rows, axis=0)
        # Turns count by the speed at the lever.
        across, around = norms(slips[:, :2]), lever * np.abs(slips[:, 2])
        changes[rows] *= _shares(across, around, most, most_around)[:, (0, 0, 1)]
    return Friction(changes, slides)


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
