# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Axle: two anchors coincide; the turn of one body against the other may have limits.

Of `lower` and `upper` [rad], turns of a against b from where they were, the engine and the rows
know the turn of b against a, from zero.
"""

from __future__ import annotations

import math

from physsim_ros.engine.joints import constraint_rows as rows
from physsim_ros.engine.joints.constraint_rows import Batch, EQUAL, Kind
from physsim_ros.engine.joints.engine_joint import Ends
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Joint
import pymunk

# With 1 Chipmunk takes a limit whose bias is 0 for one that is not reached: this leaves a share of
# 4e-7 of an angle to be corrected in a step of 1/240 s.
_NEARLY_NONE = 1.0 - 1e-4


def pivot(ends: Ends) -> pymunk.PivotJoint:
    """Return the constraint of two anchors that coincide."""
    constraint = pymunk.PivotJoint(ends.a, ends.b, ends.at_a, ends.at_b)
    # Without a bias: a share of 0 of the gap is closed in a step.
    constraint.error_bias = 1.0
    return constraint


def _constraints(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    limits = [pymunk.RotaryLimitJoint(ends.a, ends.b, *each) for each in _bounds(joint)[2:]]
    for limit in limits:
        limit.error_bias = _NEARLY_NONE
    return [pivot(ends), *limits]


def _bounds(joint: Joint) -> list[tuple[float, float]]:
    lower, upper, phase = joint.properties.lower, joint.properties.upper, joint.seat.phase
    if lower is None and upper is None:
        return [EQUAL, EQUAL]
    least = -math.inf if upper is None else phase - upper
    return [EQUAL, EQUAL, (least, math.inf if lower is None else phase - lower)]


def _rows(batch: Batch, poses: Floats) -> tuple[Floats, Floats]:
    point = rows.point(batch, poses)
    return rows.both(point, rows.angle(batch, poses)) if batch.lower.shape[1] > 2 else point


KIND = Kind(_constraints, _bounds, _rows)
