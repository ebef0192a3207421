# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Rod: two anchors keep their distance."""

from __future__ import annotations

from physsim_ros.engine.joints import constraint_rows as rows
from physsim_ros.engine.joints.constraint_rows import Kind
from physsim_ros.engine.joints.engine_joint import Ends
from physsim_ros.model.scene import Joint
import pymunk


def _constraints(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    rod = pymunk.PinJoint(ends.a, ends.b, ends.at_a, ends.at_b)
    rod.distance, rod.error_bias = joint.seat.length, 1.0
    return [rod]


KIND = Kind(_constraints, lambda joint: [(joint.seat.length, joint.seat.length)], rows.distance)
