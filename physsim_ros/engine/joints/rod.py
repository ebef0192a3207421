# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Rod: two anchors keep their distance."""

from __future__ import annotations

import numpy as np
from physsim_ros.engine.joints import rows
from physsim_ros.engine.joints.kind import Batch, Ends, Kind, Motion
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Joint
import pymunk
from pymunk._chipmunk_cffi import lib

# Anchors nearer than this turn about each other at no rate that counts [m].
_NEAR = 1e-6


def _constraints(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    rod = pymunk.PinJoint(ends.a, ends.b, ends.at_a, ends.at_b)
    rod.distance, rod.error_bias = joint.seat.length, 0.0
    return [rod]


def lengths(batch: Batch, motion: Motion) -> tuple[Floats, Floats]:
    """
    Return the distances `|d|` of the anchors [m], and the rates to solve for [m/s].

    With `d = p_a - p_b` and `n = d / |d|`, dJ/dt v is n . (w_b^2 r_b - w_a^2 r_a) plus the square
    of the velocity of d across n over `|d|`; the rate is - dt / 2 times that.

    :return: (k,) float64 each
    """
    arm_a, arm_b, apart = rows.arms(batch, motion.a[:, :3], motion.b[:, :3])
    length = np.hypot(apart[:, 0], apart[:, 1])
    n = apart / np.maximum(length, _NEAR)[:, None]
    change = rows.velocity(motion.a, arm_a) - rows.velocity(motion.b, arm_b)
    # Further than its own length nothing swings in a step.
    swing = np.minimum(np.abs(rows.dot(rows.across(n), change)) * motion.dt, length) ** 2
    rate = rows.dot(n, motion.pull[:, :1] * arm_a - motion.pull[:, 1:] * arm_b)
    return length, rate - swing / np.maximum(length, _NEAR) / (2.0 * motion.dt)


def _set_targets(batch: Batch, motion: Motion) -> None:
    """Have each `PinJoint` solve for its rate: Chipmunk solves for `(distance - |d|) / dt`."""
    length, rate = lengths(batch, motion)
    for pointer, aimed in zip(
        batch.constraints, (length + rate * motion.dt).tolist(), strict=True
    ):
        lib.cpPinJointSetDist(pointer, aimed)


KIND = Kind(
    _constraints,
    lambda joint: [(joint.seat.length, joint.seat.length)],
    rows.distance,
    _set_targets,
)
