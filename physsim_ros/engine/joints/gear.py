# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Gear: the turn of one body is that of the other times a ratio, and a phase."""

from __future__ import annotations

from physsim_ros.engine.joints import constraint_rows as rows
from physsim_ros.engine.joints.constraint_rows import Kind
from physsim_ros.engine.joints.engine_joint import Ends
from physsim_ros.model.scene import Joint
import pymunk


def gear(joint: Joint, ends: Ends) -> pymunk.GearJoint:
    """Return the constraint of ratio yaw_b - yaw_a = phase; dJ/dt is 0."""
    constraint = pymunk.GearJoint(ends.a, ends.b, joint.seat.phase, joint.number('ratio'))
    # Chipmunk corrects a share of 1 - error_bias^dt of an angle: nothing.
    constraint.error_bias = 1.0
    return constraint


def _constraints(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    return [gear(joint, ends)]


KIND = Kind(_constraints, lambda joint: [(joint.seat.phase, joint.seat.phase)], rows.angle)
