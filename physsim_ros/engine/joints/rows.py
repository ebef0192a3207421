# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Constraint rows that several kinds of joints share: their values x and their Jacobians J.

Poses are (k, 3) float64: x, y [m], yaw [rad] of the centres of mass. The columns of J are x, y,
yaw of the first body, then of the second.
Source: Catto, "Modeling and Solving Constraints", GDC 2009.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from physsim_ros.engine.joints.kind import Batch
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import rotated_each


def arms(batch: Batch, a: Floats, b: Floats) -> tuple[Floats, Floats, Floats]:
    """
    Return the arms to both anchors, and from the second anchor to the first [m].

    :return: (k, 2) float64 each, world axes
    """
    arm_a, arm_b = rotated_each(batch.at_a, a[:, 2]), rotated_each(batch.at_b, b[:, 2])
    return arm_a, arm_b, (a[:, :2] + arm_a) - (b[:, :2] + arm_b)


def point(batch: Batch, a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Return the rows of two anchors that coincide: x = p_a - p_b."""
    arm_a, arm_b, apart = arms(batch, a, b)
    jacobian = np.zeros((len(apart), 2, 6))
    jacobian[:, 0, 0] = jacobian[:, 1, 1] = 1.0
    jacobian[:, 0, 3] = jacobian[:, 1, 4] = -1.0
    jacobian[:, 0, 2], jacobian[:, 1, 2] = -arm_a[:, 1], arm_a[:, 0]
    jacobian[:, 0, 5], jacobian[:, 1, 5] = arm_b[:, 1], -arm_b[:, 0]
    return apart, jacobian


def angle(batch: Batch, a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Return the row of the turn of the second body against the first: x = ratio yaw_b - yaw_a."""
    jacobian = np.zeros((len(a), 1, 6))
    jacobian[:, 0, 2], jacobian[:, 0, 5] = -1.0, batch.ratio
    return (batch.ratio * b[:, 2] - a[:, 2])[:, None], jacobian


def distance(batch: Batch, a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Return the row of the distance of two anchors: `x = |p_a - p_b|`."""
    arm_a, arm_b, apart = arms(batch, a, b)
    length = np.hypot(apart[:, 0], apart[:, 1])
    # Anchors on each other have no direction; any one parts them.
    direction = apart / np.maximum(length, 1e-300)[:, None]
    direction = np.where(length[:, None] > 0.0, direction, (1.0, 0.0))
    return length[:, None], along(direction, arm_a, arm_b)


def on_line(batch: Batch, a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Return the row of the distance of an anchor from a line that turns with the second body."""
    return _place_on_line(batch, a, b, across)


def along_line(batch: Batch, a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Return the row of the way of an anchor along a line that turns with the second body."""
    return _place_on_line(batch, a, b, lambda axis: axis)


def _place_on_line(
    batch: Batch, a: Floats, b: Floats, direction_of: Callable[[Floats], Floats]
) -> tuple[Floats, Floats]:
    """Return x = direction . (p_a - p_b), the direction turning with the second body."""
    arm_a, arm_b, apart = arms(batch, a, b)
    direction = direction_of(rotated_each(batch.axis, b[:, 2]))
    # The line reaches from the second body to where the first anchor is.
    return dot(direction, apart)[:, None], along(direction, arm_a, arm_b + apart)


def both(first: tuple[Floats, Floats], second: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
    """Return the rows of both."""
    return np.concatenate((first[0], second[0]), 1), np.concatenate((first[1], second[1]), 1)


def across(vectors: Floats) -> Floats:
    """Return (k, 2) vectors turned counter-clockwise by a quarter."""
    return np.stack((-vectors[:, 1], vectors[:, 0]), axis=1)


def dot(a: Floats, b: Floats) -> Floats:
    """Return (k,) float64: the scalar products of (k, 2) vectors."""
    product: Floats = a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]
    return product


def along(direction: Floats, arm_a: Floats, arm_b: Floats) -> Floats:
    """Return the (k, 1, 6) Jacobian of direction . (p_a - p_b)."""
    jacobian = np.empty((len(direction), 1, 6))
    jacobian[:, 0, :2], jacobian[:, 0, 3:5] = direction, -direction
    jacobian[:, 0, 2] = arm_a[:, 0] * direction[:, 1] - arm_a[:, 1] * direction[:, 0]
    jacobian[:, 0, 5] = arm_b[:, 1] * direction[:, 0] - arm_b[:, 0] * direction[:, 1]
    return jacobian
