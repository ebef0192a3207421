# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Constraint rows of joints: what a kind of joint provides, and the rows that several kinds share.

A constraint row is a number x of the poses of two bodies with lower <= x <= upper; of an equality
both bounds are the same. C is how far x lies outside its bounds [m, rad], J = dx/dq its Jacobian.
Poses are (k, 3) float64: x, y [m], yaw [rad] of the centres of mass. The columns of J are x, y,
yaw of the first body, then of the second.
Source: Catto, "Modeling and Solving Constraints", GDC 2009.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from physsim_ros.engine.graph_search import Rows
from physsim_ros.engine.joints.engine_joint import Ends
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Joint
from physsim_ros.model.transform import dots, rotated_each
import pymunk

# Bounds of an equality.
EQUAL = (0.0, 0.0)


class Batch(NamedTuple):
    """
    Joints of one kind, by column.

    :ivar numbers: (k,) of the joints in their set
    :ivar ends: (2, k) rows of the first and of the second body in the states
    :ivar anchors: (2, k, 2) float64: in the frames of these [m]
    :ivar axis: (k, 2) float64: unit vector of a slider in the frame of the second body
    :ivar ratio: (k,) float64: of a gear
    :ivar lower: (k, r) float64: least value of each row [m, rad]
    :ivar upper: (k, r) float64: greatest value of each row [m, rad]
    :ivar constraints: (k,) the engine's pointer to the first constraint of each
    """

    numbers: Rows
    ends: Rows
    anchors: Floats
    axis: Floats
    ratio: Floats
    lower: Floats
    upper: Floats
    constraints: list[Any]


class Kind(NamedTuple):
    """
    The functions of one kind of joint.

    :ivar constraints: makes the Pymunk constraints; their impulses, but those of motors and
        springs, are those of the rows in the same order
    :ivar bounds: returns (lower, upper) of each constraint row of a joint [m, rad]
    :ivar rows: returns the (k, r) values x and the (k, r, 6) Jacobian J at the (2, k, 3) poses of
        the first and the second bodies; None where the engine alone solves the joint
    :ivar prepare: changes constraints before a step, at the poses that it will have; None where
        they do not depend on poses
    """

    constraints: Callable[[Joint, Ends], list[pymunk.Constraint]]
    bounds: Callable[[Joint], Sequence[tuple[float, float]]] = lambda _: ()
    rows: Callable[[Batch, Floats], tuple[Floats, Floats]] | None = None
    prepare: Callable[[Batch, Floats], None] | None = None


def arms(batch: Batch, poses: Floats) -> tuple[Floats, Floats, Floats]:
    """
    Return the arms to both anchors, and from the second anchor to the first [m].

    :return: (k, 2) float64 each, world axes
    """
    both_arms = rotated_each(batch.anchors, poses[..., 2])
    place_a, place_b = poses[..., :2] + both_arms
    return both_arms[0], both_arms[1], place_a - place_b


def point(batch: Batch, poses: Floats) -> tuple[Floats, Floats]:
    """Return the rows of two anchors that coincide: x = p_a - p_b."""
    arm_a, arm_b, apart = arms(batch, poses)
    jacobian = np.zeros((len(apart), 2, 6))
    jacobian[:, 0, 0] = jacobian[:, 1, 1] = 1.0
    jacobian[:, 0, 3] = jacobian[:, 1, 4] = -1.0
    jacobian[:, 0, 2], jacobian[:, 1, 2] = -arm_a[:, 1], arm_a[:, 0]
    jacobian[:, 0, 5], jacobian[:, 1, 5] = arm_b[:, 1], -arm_b[:, 0]
    return apart, jacobian


def angle(batch: Batch, poses: Floats) -> tuple[Floats, Floats]:
    """Return the row of the turn of the second body against the first: x = ratio yaw_b - yaw_a."""
    yaw_a, yaw_b = poses[..., 2]
    jacobian = np.zeros((len(yaw_a), 1, 6))
    jacobian[:, 0, 2], jacobian[:, 0, 5] = -1.0, batch.ratio
    return (batch.ratio * yaw_b - yaw_a)[:, None], jacobian


def distance(batch: Batch, poses: Floats) -> tuple[Floats, Floats]:
    """Return the row of the distance of two anchors: `x = |p_a - p_b|`."""
    arm_a, arm_b, apart = arms(batch, poses)
    length = np.hypot(apart[:, 0], apart[:, 1])
    # Anchors on each other have no direction; any one parts them.
    direction = apart / np.maximum(length, 1e-300)[:, None]
    direction = np.where(length[:, None] > 0.0, direction, (1.0, 0.0))
    return length[:, None], along(direction, arm_a, arm_b)


def on_line(batch: Batch, poses: Floats) -> tuple[Floats, Floats]:
    """Return the row of the distance of an anchor from a line that turns with the second body."""
    return _place_on_line(batch, poses, across)


def along_line(batch: Batch, poses: Floats) -> tuple[Floats, Floats]:
    """Return the row of the way of an anchor along a line that turns with the second body."""
    return _place_on_line(batch, poses, lambda axis: axis)


def _place_on_line(
    batch: Batch, poses: Floats, direction_of: Callable[[Floats], Floats]
) -> tuple[Floats, Floats]:
    """Return x = direction . (p_a - p_b), the direction turning with the second body."""
    arm_a, arm_b, apart = arms(batch, poses)
    direction = direction_of(rotated_each(batch.axis, poses[1, :, 2]))
    # The line reaches from the second body to where the first anchor is.
    return dots(direction, apart)[:, None], along(direction, arm_a, arm_b + apart)


def both(first: tuple[Floats, Floats], second: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
    """Return the rows of both."""
    return np.concatenate((first[0], second[0]), 1), np.concatenate((first[1], second[1]), 1)


def across(vectors: Floats) -> Floats:
    """Return (k, 2) vectors turned counter-clockwise by a quarter."""
    return np.stack((-vectors[:, 1], vectors[:, 0]), axis=1)


def along(direction: Floats, arm_a: Floats, arm_b: Floats) -> Floats:
    """Return the (k, 1, 6) Jacobian of direction . (p_a - p_b)."""
    jacobian = np.empty((len(direction), 1, 6))
    jacobian[:, 0, :2], jacobian[:, 0, 3:5] = direction, -direction
    jacobian[:, 0, 2] = arm_a[:, 0] * direction[:, 1] - arm_a[:, 1] * direction[:, 0]
    jacobian[:, 0, 5] = arm_b[:, 1] * direction[:, 0] - arm_b[:, 0] * direction[:, 1]
    return jacobian
