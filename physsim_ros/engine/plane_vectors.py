# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Plane vectors as complex numbers, x + y i, for what is computed contact by contact.

They are built into Python, and ten times as fast as Pymunk's `Vec2d`: a sum takes 0.04 us instead
of 0.5. The product with a unit vector is a rotation. The rounding is that of `Vec2d`.
"""

from __future__ import annotations

import cmath

import numpy as np
from physsim_ros.model.arrays import Floats


def dot(a: complex, b: complex) -> float:
    """Return the dot product of two vectors."""
    return a.real * b.real + a.imag * b.imag


def rotation(yaw: float) -> complex:
    """Return the unit vector whose product with a vector is that rotated by yaw [rad]."""
    return cmath.rect(1.0, yaw)


def coordinates(vector: complex) -> tuple[float, float]:
    """Return x and y of a vector, as Pymunk takes them."""
    return vector.real, vector.imag


def vectors(array: Floats) -> list[complex]:
    """Return the vectors of an array of shape (n, 2)."""
    found: list[complex] = array.view(np.complex128).ravel().tolist()
    return found
