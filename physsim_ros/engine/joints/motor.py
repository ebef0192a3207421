# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Motor: an axle that turns one body against the other at a rate, with so much torque at most."""

from __future__ import annotations

from physsim_ros.engine.joints import constraint_rows as rows
from physsim_ros.engine.joints.axle import pivot
from physsim_ros.engine.joints.constraint_rows import EQUAL, Kind
from physsim_ros.engine.joints.engine_joint import Ends
from physsim_ros.model.scene import Joint
import pymunk


def _constraints(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    motor = pymunk.SimpleMotor(ends.a, ends.b, joint.number('rate'))
    motor.max_force = joint.number('max_torque')
    return [pivot(ends), motor]


KIND = Kind(_constraints, lambda _: [EQUAL, EQUAL], rows.point)
