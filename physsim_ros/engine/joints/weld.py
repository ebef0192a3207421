# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Weld (`pin` in markers and files): two anchors coincide, and neither body turns on the other."""

from __future__ import annotations

from physsim_ros.engine.joints import constraint_rows as rows
from physsim_ros.engine.joints.axle import pivot
from physsim_ros.engine.joints.constraint_rows import Batch, EQUAL, Kind
from physsim_ros.engine.joints.engine_joint import Ends
from physsim_ros.engine.joints.gear import gear
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Joint
import pymunk


def _constraints(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    return [pivot(ends), gear(joint, ends)]


def _bounds(joint: Joint) -> list[tuple[float, float]]:
    return [EQUAL, EQUAL, (joint.seat.phase, joint.seat.phase)]


def _rows(batch: Batch, poses: Floats) -> tuple[Floats, Floats]:
    return rows.both(rows.point(batch, poses), rows.angle(batch, poses))


KIND = Kind(_constraints, _bounds, _rows)
