# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Slider: an anchor of one body stays on a line of another, and neither turns against the other.

The way along the line may have limits.

Chipmunk's `GrooveJoint` solves both directions and then drops what is along the line, which is not
the velocity constraint of a line where masses and arms make the two directions unequal (7.0.3, as
in Pymunk 7.3.1): sliders that are loaded off centre would gain energy. In its place a `PinJoint`
pulls across the line: from a point of the second body that is put beside the anchor in each step.
"""

from __future__ import annotations

import math

from physsim_ros.engine.joints import constraint_rows as rows
from physsim_ros.engine.joints.constraint_rows import Batch, EQUAL, Kind
from physsim_ros.engine.joints.engine_joint import Ends
from physsim_ros.engine.joints.gear import gear
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Joint
from physsim_ros.model.shapes import SMALLEST
from physsim_ros.model.transform import Point, rotated_each
import pymunk
from pymunk._chipmunk_cffi import lib

# Length of the arm with which the pin pulls across the line [m]; any will do.
_ARM = 1.0


def is_locked(joint: Joint) -> bool:
    """Return whether the limits leave no way along the line, so that the joint is a pin."""
    lower, upper = joint.properties.lower, joint.properties.upper
    return lower is not None and upper is not None and upper - lower < SMALLEST


def stop(joint: Joint, at_b: Point) -> Point:
    """Return where on the second body the anchor of a slider that has no way stays [m]."""
    middle = ((joint.properties.lower or 0.0) + (joint.properties.upper or 0.0)) / 2.0
    return at_b[0] + joint.seat.ux * middle, at_b[1] + joint.seat.uy * middle


def _constraints(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    pin = pymunk.PinJoint(ends.b, ends.a, ends.at_b, ends.at_a)
    # Without a bias: a share of 0 of the gap is closed in a step.
    pin.error_bias = 1.0
    lower, upper = _limits(joint)
    if math.isinf(lower) and math.isinf(upper):
        return [pin, gear(joint, ends)]
    # Distances from a point of the line that lies behind its lower limit.
    back = _ARM if math.isinf(lower) else _ARM - lower
    (x, y), (ux, uy) = ends.at_b, (joint.seat.ux, joint.seat.uy)
    least = 0.0 if math.isinf(lower) else back + lower
    origin = x - ux * back, y - uy * back
    limit = pymunk.SlideJoint(ends.b, ends.a, origin, ends.at_a, least, back + upper)
    limit.error_bias = 1.0
    return [pin, gear(joint, ends), limit]


def _limits(joint: Joint) -> tuple[float, float]:
    lower, upper = joint.properties.lower, joint.properties.upper
    return -math.inf if lower is None else lower, math.inf if upper is None else upper


def _bounds(joint: Joint) -> list[tuple[float, float]]:
    phase, limits = joint.seat.phase, _limits(joint)
    return [EQUAL, (phase, phase), *([] if limits == (-math.inf, math.inf) else [limits])]


def _rows(batch: Batch, poses: Floats) -> tuple[Floats, Floats]:
    found = rows.both(rows.on_line(batch, poses), rows.angle(batch, poses))
    return rows.both(found, rows.along_line(batch, poses)) if batch.lower.shape[1] > 2 else found


def _prepare(batch: Batch, poses: Floats) -> None:
    """Put the other end of each `PinJoint` across the line from the anchor."""
    _, arm_b, apart = rows.arms(batch, poses)
    yaw = poses[1, :, 2]
    across = rows.across(rotated_each(batch.axis, yaw))
    anchors = rotated_each(arm_b + apart - across * _ARM, -yaw)
    for pointer, anchor in zip(batch.constraints, anchors.tolist(), strict=True):
        lib.cpPinJointSetAnchorA(pointer, anchor)


KIND = Kind(_constraints, _bounds, _rows, _prepare)
