# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Rope: two anchors are no further from each other than its length."""

from __future__ import annotations

from physsim_ros.engine.joints import constraint_rows as rows
from physsim_ros.engine.joints.constraint_rows import Kind
from physsim_ros.engine.joints.engine_joint import Ends
from physsim_ros.model.scene import Joint
import pymunk


def _constraints(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    rope = pymunk.SlideJoint(ends.a, ends.b, ends.at_a, ends.at_b, 0.0, joint.rest_length)
    rope.error_bias = 1.0
    return [rope]


KIND = Kind(_constraints, lambda joint: [(0.0, joint.rest_length)], rows.distance)
