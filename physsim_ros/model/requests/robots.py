# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests for robots."""

from __future__ import annotations

from dataclasses import dataclass

from physsim_ros.model.checks import check_finite, FASTEST
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.transform import Twist


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveRobot:
    """
    Drive at a velocity, until the next command or the timeout of the drive.

    The drive does what it can of it: a velocity beyond its limits is cut off.

    :param name: of the body of the robot
    :param velocity: vx forward, vy to the left [m/s], turn counter-clockwise [rad/s]
    :raises Malformed: a number is not finite, or there are not three
    :raises BadProperty: it is faster than anything may be
    """

    name: str
    velocity: Twist

    def __post_init__(self) -> None:
        check_finite(self.velocity, 3, 'velocity')
        object.__setattr__(self, 'velocity', tuple(map(float, self.velocity)))
        if max(map(abs, self.velocity)) > FASTEST:
            raise BadProperty(
                f'velocity is faster than {FASTEST:g} m/s or rad/s', field='velocity'
            )
