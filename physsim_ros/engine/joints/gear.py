# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Gear: the turn of one body is that of the other times a ratio, and a phase."""

from __future__ import annotations

from physsim_ros.engine.joints import rows
from physsim_ros.engine.joints.kind import Ends, Kind
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
