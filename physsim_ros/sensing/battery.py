# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Readings of batteries."""

from __future__ import annotations

from typing import NamedTuple

from physsim_ros.model.robots import Battery
from physsim_ros.model.shapes import contains
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import world_to_local

# Seconds in an hour.
_HOUR = 3600.0


class BatteryReading(NamedTuple):
    """
    The state of a battery.

    :ivar level: share of its capacity, 0 .. 1
    :ivar current: into it; negative as it is drained [A]
    :ivar is_docked: whether a dock charges it, or keeps it full
    """

    level: float
    current: float
    is_docked: bool


def read_battery(snapshot: Snapshot, row: int) -> BatteryReading | None:
    """
    Return the state of the battery of a robot; None where it has none.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    """
    robot = snapshot.scene.bodies[row].robot
    if robot is None or robot.battery is None:
        return None
    battery = robot.battery
    state = snapshot.robots[snapshot.scene.robot_number(row)]
    level = battery.level - float(state['drawn']) / (battery.capacity * _HOUR)
    is_docked = _is_docked(snapshot, row, battery)
    current = battery.charging if is_docked else 0.0
    if level > 0.0 or is_docked:
        current -= battery.idle + battery.moving * bool(state['wheels'].any())
    if level >= 1.0:
        current = min(current, 0.0)
    return BatteryReading(min(max(level, 0.0), 1.0), current, is_docked)


def _is_docked(snapshot: Snapshot, row: int, battery: Battery) -> bool:
    scene = snapshot.scene
    x, y = snapshot.centers[row].tolist()
    for name in battery.docks:
        dock = scene.row_of.get(name, -1)
        if dock >= 0 and dock != row:
            local = world_to_local((x, y), tuple(snapshot.poses[dock].tolist()))
            if contains(scene.bodies[dock].shape.form.pieces, *local):
                return True
    return False
