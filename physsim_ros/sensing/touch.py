# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Readings of what touches a robot, and of the colours of the floor below it.

On the floor lie the bodies that are sensors; what is spawned later lies on top. The bare floor is
white, and a colour that is not opaque is mixed with what is below it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats
from physsim_ros.model.robots import Robot
from physsim_ros.model.robots.sensors import Bumper, FloorEye
from physsim_ros.model.shapes import contains
from physsim_ros.model.snapshot import Contacts, Snapshot
from physsim_ros.model.transform import dots, rotated_each
from physsim_ros.sensing.mounting import mounted_row, placed
from physsim_ros.sensing.sampling import noise_of

# Tolerance of rounding [rad]: a contact at the end of the sector lies within the sector.
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

    Parts of the same robot do not count.

    :param snapshot: of the world
    :param contacts: since the frame before
    :param row: of the robot's body in the scene
    :param bumper: on it
    """
    bodies = snapshot.scene.bodies
    x, y, yaw = placed(snapshot, row, bumper)
    owners = snapshot.scene.owners
    on = mounted_row(snapshot, row, bumper)
    touching = (contacts.pairs == on).any(axis=1)
    for pair, point in zip(
        contacts.pairs[touching].tolist(), contacts.points[touching].tolist(), strict=True
    ):
        other = pair[1] if pair[0] == on else pair[0]
        if other >= 0 and (bodies[other].sensor or owners[other] == row):
            continue
        angle = math.atan2(point[1] - y, point[0] - x) - yaw
        if abs(math.remainder(angle, math.tau)) <= bumper.sector / 2 + _ROUNDING:
            return True
    return False


def read_floor(snapshot: Snapshot, row: int, eye: FloorEye) -> NDArray[np.uint8]:
    """
    Return (pixels, 3) uint8: red, green, blue of each photodiode, from left to right.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    :param eye: on it
    """
    x, y, yaw = placed(snapshot, row, eye)
    half = eye.width / 2 if eye.pixels > 1 else 0.0
    left = np.linspace(half, -half, eye.pixels)
    points = rotated_each(np.column_stack((np.zeros(eye.pixels), left)), yaw)
    points += np.array((x, y))
    colors = _floor_colors(snapshot, points)
    if eye.noise:
        noise = noise_of(snapshot, row, eye, 3 * eye.pixels)
        colors += eye.noise * noise.reshape(-1, 3)
    return np.rint(255.0 * np.clip(colors, 0.0, 1.0)).astype(np.uint8)


def _floor_colors(snapshot: Snapshot, points: Floats) -> Floats:
    """
    Return (k, 3) float64: red, green, blue of the floor at points, each 0 .. 1.

    :param points: (k, 2) float64: close together, world [m]
    """
    scene = snapshot.scene
    colors = np.ones((len(points), 3))
    middle = points.mean(axis=0)
    reach = float(np.abs(points - middle).sum(axis=1).max())
    away = snapshot.centers[scene.sensor_rows] - middle
    near = dots(away, away) <= (scene.outer_radii[scene.sensor_rows] + reach) ** 2
    for row in scene.sensor_rows[near].tolist():
        body, pose = scene.bodies[row], snapshot.poses[row]
        local = rotated_each(points - pose[:2], -pose[2])
        inside = contains(body.shape.form.pieces, *local.T)
        alpha = body.color[3]
        colors[inside] = (1.0 - alpha) * colors[inside] + alpha * np.array(body.color[:3])
    return colors
