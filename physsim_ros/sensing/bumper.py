# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The reading of a bumper: a contact in its sector."""

from __future__ import annotations

import math

from physsim_ros.model.robots import Robot
from physsim_ros.model.robots.sensors import Bumper
from physsim_ros.model.snapshot import Contacts, Snapshot
from physsim_ros.sensing.mounting import placed

# A contact as far round as the end of the sector lies in it [rad], however it rounds.
_ROUNDING = 1e-9

# A bumper all around.
_ALL_ROUND = Bumper(sector=math.tau)


def is_bumped(snapshot: Snapshot, contacts: Contacts, row: int, robot: Robot) -> bool:
    """
    Return whether a robot has touched something: within its bumpers, if it has any.

    :param snapshot: of the world
    :param contacts: since the frame before
    :param row: of the robot's body in the scene
    :param robot: that the body is
    """
    bumpers = [each for each in robot.sensors if isinstance(each, Bumper)] or [_ALL_ROUND]
    return any(read_bumper(snapshot, contacts, row, each) for each in bumpers)


def read_bumper(snapshot: Snapshot, contacts: Contacts, row: int, bumper: Bumper) -> bool:
    """
    Return whether the body has touched another one, or a wall, within the sector.

    :param snapshot: of the world
    :param contacts: since the frame before
    :param row: of the robot's body in the scene
    :param bumper: on it
    """
    bodies = snapshot.scene.bodies
    x, y, yaw = placed(snapshot, row, bumper)
    touching = (contacts.pairs == row).any(axis=1)
    for pair, point in zip(
        contacts.pairs[touching].tolist(), contacts.points[touching].tolist(), strict=True
    ):
        other = pair[1] if pair[0] == row else pair[0]
        if other >= 0 and bodies[other].sensor:
            continue
        angle = math.atan2(point[1] - y, point[0] - x) - yaw
        if abs(math.remainder(angle, math.tau)) <= bumper.sector / 2 + _ROUNDING:
            return True
    return False
