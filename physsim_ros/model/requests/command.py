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

"""The request that sets poses, twists or wrenches of bodies."""

from __future__ import annotations

from dataclasses import dataclass
import math

from physsim_ros.model.checks import check_finite, check_pose, FASTEST, HEAVIEST
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.transform import Pose


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """
    Set poses, twists or wrenches of named bodies: all of them, or none if one is refused.

    :param names: the bodies, each once
    :param poses: (x, y, yaw) for each, or empty
    :param twists: (vx, vy, spin) for each, world axes [m/s, rad/s], or empty
    :param wrenches: (fx, fy, torque) for each, world axes [N, N m], or empty; they act at
        the centre of mass until the next one, at most for the world's `command_timeout`
    :param frame: of the poses: '' for the world, or a body's name
    :raises Malformed: lengths do not fit, a name comes twice, a number is not finite
    :raises BadProperty: a value is out of range
    """

    names: tuple[str, ...]
    poses: tuple[Pose, ...] = ()
    twists: tuple[Pose, ...] = ()
    wrenches: tuple[Pose, ...] = ()
    frame: str = ''

    def __post_init__(self) -> None:
        if not self.names:
            raise Malformed('the command names no body', field='joint_names')
        if len(set(self.names)) != len(self.names):
            raise Malformed('the command names a body twice', field='joint_names')
        for name, rows in (
            ('transforms', self.poses),
            ('twist', self.twists),
            ('wrench', self.wrenches),
        ):
            if rows and len(rows) != len(self.names):
                raise Malformed(
                    f'{name} has {len(rows)} entries for {len(self.names)} bodies', field=name
                )
        for pose in self.poses:
            check_pose(pose, 'transforms')
        for twist in self.twists:
            check_finite(twist, 3, 'twist')
            if math.hypot(*twist[:2]) > FASTEST or abs(twist[2]) > FASTEST:
                raise BadProperty(f'twist is faster than {FASTEST:g} m/s or rad/s', field='twist')
        for wrench in self.wrenches:
            check_finite(wrench, 3, 'wrench')
            if max(map(abs, wrench)) > HEAVIEST:
                raise BadProperty(f'wrench exceeds {HEAVIEST:g} N or N m', field='wrench')
