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

"""Motor: an axle that turns one body against the other at a rate, with so much torque at most."""

from __future__ import annotations

from physsim_ros.engine.joints import rows
from physsim_ros.engine.joints.axle import pivot, set_targets
from physsim_ros.engine.joints.kind import Ends, EQUAL, Kind
from physsim_ros.model.scene import Joint
import pymunk


def _constraints(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    motor = pymunk.SimpleMotor(ends.a, ends.b, joint.number('rate'))
    motor.max_force = joint.number('max_torque')
    return [pivot(ends), motor]


KIND = Kind(_constraints, lambda _: [EQUAL, EQUAL], rows.point, set_targets)
