# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Readings of how a robot moves: odometry, encoders of the wheels, inertial units; and in truth.

Felt by an inertial unit is the acceleration less gravity: at rest on a floor that is seen from the
side it is upward; the gravity of a world that is seen from above is not in its plane. The
acceleration is the mean since the frame before, that of the sensor's place, centripetal part
included, in the axes that the sensor had in the middle of that time.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.robots.sensors import Imu
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Point, Pose, rotated, Twist
from physsim_ros.sensing.mounting import noise_of, placed


class OdometryReading(NamedTuple):
    """
    A pose, and the velocity there.

    :ivar pose: x, y [m], yaw [rad]
    :ivar twist: vx forward, vy to the left [m/s], turn counter-clockwise [rad/s]; of the robot's
        origin, in its own axes
    """

    pose: Pose
    twist: Twist


def read_odometry(snapshot: Snapshot, row: int) -> OdometryReading:
    """
    Return what wheels and gyroscope tell, from the pose in which the robot was spawned.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    """
    place = int(np.searchsorted(snapshot.scene.robot_rows, row))
    states = snapshot.robots
    (x, y, yaw), twist = states['odometry'][place].tolist(), states['wheels'][place].tolist()
    return OdometryReading((x, y, yaw), tuple(twist))


def true_motion(snapshot: Snapshot, row: int) -> OdometryReading:
    """
    Return the pose in the world, and the velocity.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    """
    vx, vy, turn = snapshot.twists[row].tolist()
    x, y, yaw = snapshot.poses[row].tolist()
    center_x, center_y = snapshot.centers[row].tolist()
    ahead, aside = rotated((vx - turn * (y - center_y), vy + turn * (x - center_x)), -yaw)
    return OdometryReading((x, y, yaw), (ahead, aside, turn))


class WheelReading(NamedTuple):
    """
    The wheels of a drive, then the axles and motors that hold other bodies.

    :ivar names: of their joints
    :ivar positions: (w,) float64: turned since the robot was spawned [rad]; of an axle, angle of
        the other body as seen from the robot
    :ivar velocities: (w,) float64: of now [rad/s]
    """

    names: tuple[str, ...]
    positions: Floats
    velocities: Floats


def read_wheels(snapshot: Snapshot, row: int) -> WheelReading:
    """
    Return how far and how fast the wheels of a robot have turned, slipping or not, and its axles.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    """
    robot = snapshot.scene.bodies[row].robot
    assert robot is not None  # noqa: S101 - by the contract above
    place = int(np.searchsorted(snapshot.scene.robot_rows, row))
    # The speed of each rim is the sum of these times the velocity of the drive.
    wheels = robot.drive.wheels
    rims = np.array([*wheels.values()], float).reshape(-1, 3) / robot.drive.wheel_radius
    states = snapshot.robots
    names, angles, rates = _read_axles(snapshot, row)
    return WheelReading(
        (*wheels, *names),
        np.append((rims * states['travel'][place]).sum(axis=1), angles),
        np.append((rims * states['wheels'][place]).sum(axis=1), rates),
    )


def _read_axles(snapshot: Snapshot, row: int) -> tuple[list[str], Floats, Floats]:
    """Return the names, angles [rad] and rates [rad/s] of the axles and motors on a body."""
    scene = snapshot.scene
    # The background does not turn.
    yaws, spins = np.append(snapshot.poses[:, 2], 0.0), np.append(snapshot.twists[:, 2], 0.0)
    pairs = [
        (joint.name.replace('/', '_'), a if b == row else b)
        for joint, (a, b) in zip(scene.joints, scene.joint_rows.tolist(), strict=True)
        if row in (a, b) and joint.kind in (JointKind.AXLE, JointKind.MOTOR)
    ]
    others = [other for _, other in pairs]
    return [name for name, _ in pairs], yaws[others] - yaws[row], spins[others] - spins[row]


class InertialReading(NamedTuple):
    """
    A reading, in the frame of the sensor; the acceleration in that of half a frame ago.

    :ivar yaw: of the sensor in the world [rad]
    :ivar turn_rate: counter-clockwise [rad/s]
    :ivar acceleration: x, y [m/s²]
    """

    yaw: float
    turn_rate: float
    acceleration: Point


def read_imu(snapshot: Snapshot, before: Snapshot | None, row: int, imu: Imu) -> InertialReading:
    """
    Return the reading of an inertial measurement unit.

    :param snapshot: of the world
    :param before: an earlier one; None, or one without the body, is no acceleration but gravity
    :param row: of the robot's body in the scene
    :param imu: on it
    """
    yaw = placed(snapshot, row, imu)[2]
    turn_rate = float(snapshot.twists[row, 2])
    change, seconds, turn = _velocity(snapshot, row, imu), 0.0, 0.0
    earlier = None if before is None else _row_before(snapshot, before, row)
    if before is not None and earlier is not None:
        seconds = (snapshot.stamp - before.stamp) * 1e-9
        was = _velocity(before, earlier, imu)
        change = change[0] - was[0], change[1] - was[1]
        # Not that of the poses, which a command may have set.
        turn = (turn_rate + float(before.twists[earlier, 2])) / 2.0 * seconds
    share = 1.0 / seconds if seconds > 0.0 else 0.0
    gravity = snapshot.scene.settings.gravity
    felt = change[0] * share - gravity[0], change[1] * share - gravity[1]
    ahead, aside = rotated(felt, turn / 2.0 - yaw)
    if any(imu.noise):
        noise = noise_of(snapshot, row, imu, 3).tolist()
        ahead += imu.noise[0] * noise[0]
        aside += imu.noise[0] * noise[1]
        turn_rate += imu.noise[1] * noise[2]
    return InertialReading(yaw, turn_rate, (ahead, aside))


def _row_before(snapshot: Snapshot, before: Snapshot, row: int) -> int | None:
    """Return the row that a body had; None where it was not there, or time went back."""
    if before.stamp >= snapshot.stamp:
        return None
    if before.scene is snapshot.scene:
        return row
    names, name = before.scene.names, snapshot.scene.names[row]
    return names.index(name) if name in names else None


def _velocity(snapshot: Snapshot, row: int, imu: Imu) -> Point:
    """Return the velocity of the sensor's place in the world [m/s]."""
    vx, vy, spin = snapshot.twists[row].tolist()
    x, y, _ = placed(snapshot, row, imu)
    center_x, center_y = snapshot.centers[row].tolist()
    return vx - spin * (y - center_y), vy + spin * (x - center_x)
