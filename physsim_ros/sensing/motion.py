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

from collections.abc import Iterator
import math
from typing import NamedTuple

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.robots import part_name, Robot
from physsim_ros.model.robots.sensors import Imu
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.states import Covariance
from physsim_ros.model.transform import local_to_world, ORIGIN, Point, Pose, rotated, Twist
from physsim_ros.sensing.mounting import mounted_row, placed
from physsim_ros.sensing.sampling import noise_of


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
    number = snapshot.scene.robot_number(row)
    states = snapshot.robots
    (x, y, yaw), twist = states['odometry'][number].tolist(), states['wheels'][number].tolist()
    return OdometryReading((x, y, yaw), tuple(twist))


def odometry_covariances(snapshot: Snapshot, row: int) -> tuple[Covariance, Covariance]:
    """
    Return the covariances of odometry: of the pose where it began, of the twist in its own axes.

    Drifts are random walks along the path. That of the twist is their mean rate from one message
    to the next: of the velocity along it, none across.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    """
    robot = snapshot.scene.bodies[row].robot
    assert robot is not None  # noqa: S101 - by the contract above
    states, number = snapshot.robots, snapshot.scene.robot_number(row)
    ahead, aside, turn = states['wheels'][number].tolist()
    way, heading = (deviation**2 for deviation in robot.odometry.slip)
    speed, rate = math.hypot(ahead, aside), robot.odometry.rate
    share = way * rate / speed if speed > 0.0 else 0.0
    along = ahead * ahead * share, ahead * aside * share, aside * aside * share
    of_turn = heading * (speed + abs(turn)) * rate
    of_pose = tuple(states['covariance'][number].tolist())
    return of_pose, (*along, 0.0, 0.0, of_turn)


def true_motion(snapshot: Snapshot, row: int) -> OdometryReading:
    """
    Return the pose in the world, and the velocity.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    """
    pose = _pose(snapshot, row)
    ahead, aside = rotated(_velocity_at(snapshot, row, pose[:2]), -pose[2])
    return OdometryReading(pose, (ahead, aside, float(snapshot.twists[row, 2])))


class WheelReading(NamedTuple):
    """
    The wheels of a drive, then the joints of a robot, then axles and motors with other bodies.

    :ivar names: of the joints: of the robot's own as its file has them, of others in the world,
        with `_` for `/`
    :ivar positions: (w,) float64: wheels: turned since the robot was spawned [rad]; joints of the
        robot: [rad, m], 0 as in its file; others: angle of the other body as seen from the robot
    :ivar velocities: (w,) float64: of now [rad/s, m/s]
    """

    names: tuple[str, ...]
    positions: Floats
    velocities: Floats


# Position and velocity of a joint.
_JointState = tuple[str, float, float]


def read_wheels(snapshot: Snapshot, row: int) -> WheelReading:
    """
    Return how far and how fast the wheels of a robot have turned, slipping or not, and its joints.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    """
    robot = snapshot.scene.bodies[row].robot
    assert robot is not None  # noqa: S101 - by the contract above
    states = [*_read_wheels(snapshot, row, robot), *_read_joints(snapshot, row, robot)]
    names, positions, velocities = zip(*states, strict=True) if states else ((), (), ())
    return WheelReading(names, np.array(positions, float), np.array(velocities, float))


def _read_wheels(snapshot: Snapshot, row: int, robot: Robot) -> Iterator[_JointState]:
    if robot.drive is None:
        return
    number = snapshot.scene.robot_number(row)
    # The speed of each rim is the sum of these times the velocity of the drive.
    wheels = robot.drive.wheels
    rims = np.array([*wheels.values()], float) / robot.drive.wheel_radius
    states = snapshot.robots
    yield from zip(
        wheels,
        (rims * states['travel'][number]).sum(axis=1).tolist(),
        (rims * states['wheels'][number]).sum(axis=1).tolist(),
        strict=True,
    )


def _read_joints(snapshot: Snapshot, row: int, robot: Robot) -> Iterator[_JointState]:
    scene = snapshot.scene
    joints = {joint.name: number for number, joint in enumerate(scene.joints)}
    own = {part_name(scene.names[row], each.name): each.name for each in robot.joints}
    for name, local in own.items():
        if name in joints and scene.joints[joints[name]].kind in _MOVING:
            yield local, *joint_motion(snapshot, joints[name])
    for number, (joint, (a, b)) in enumerate(
        zip(scene.joints, scene.joint_rows.tolist(), strict=True)
    ):
        if joint.name not in own and row in (a, b) and joint.kind in _TURNING:
            angle, rate = joint_motion(snapshot, number)
            sign = 1.0 if b == row else -1.0
            turned = angle - joint.seat.phase
            yield joint.name.replace('/', '_'), sign * turned, sign * rate


_TURNING = (JointKind.AXLE, JointKind.MOTOR)
_MOVING = (*_TURNING, JointKind.SLIDER)


def joint_motion(snapshot: Snapshot, number: int) -> tuple[float, float]:
    """
    Return position and velocity of an axle, a motor [rad, rad/s] or a slider [m, m/s].

    They are those of its body a against b, from where they were joined.

    :param snapshot: of the world
    :param number: of the joint in the scene
    """
    joint, (a, b) = snapshot.scene.joints[number], snapshot.scene.joint_rows[number].tolist()
    pose_b, spin_b = (ORIGIN, 0.0) if b < 0 else (_pose(snapshot, b), snapshot.twists[b, 2])
    poses = {joint.a: _pose(snapshot, a), joint.b: pose_b}
    position = joint.position(poses)
    if not joint.kind.schema.has_axis:
        return position, float(snapshot.twists[a, 2] - spin_b)
    seat = joint.seat
    point = local_to_world((seat.ax, seat.ay), poses[joint.a])
    ux, uy = rotated((seat.ux, seat.uy), pose_b[2])
    ahead, aside = _velocity_at(snapshot, a, point)
    back, below = (0.0, 0.0) if b < 0 else _velocity_at(snapshot, b, point)
    return position, ux * (ahead - back) + uy * (aside - below)


def _pose(snapshot: Snapshot, row: int) -> Pose:
    x, y, yaw = snapshot.poses[row].tolist()
    return x, y, yaw


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
    turn_rate = _spin(snapshot, row, imu)
    change, seconds, turn = _velocity(snapshot, row, imu), 0.0, 0.0
    earlier = None if before is None else _row_before(snapshot, before, row)
    if before is not None and earlier is not None:
        seconds = (snapshot.stamp - before.stamp) * 1e-9
        was = _velocity(before, earlier, imu)
        change = change[0] - was[0], change[1] - was[1]
        # Not that of the poses, which a command may have set.
        turn = (turn_rate + _spin(before, earlier, imu)) / 2.0 * seconds
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
    x, y, _ = placed(snapshot, row, imu)
    return _velocity_at(snapshot, mounted_row(snapshot, row, imu), (x, y))


def _spin(snapshot: Snapshot, row: int, imu: Imu) -> float:
    """Return the spin of the body that the sensor is on [rad/s]."""
    return float(snapshot.twists[mounted_row(snapshot, row, imu), 2])


def _velocity_at(snapshot: Snapshot, row: int, point: Point) -> Point:
    """Return the velocity at a point of the world that is fixed to a body [m/s]."""
    vx, vy, spin = snapshot.twists[row].tolist()
    center_x, center_y = snapshot.centers[row].tolist()
    return vx - spin * (point[1] - center_y), vy + spin * (point[0] - center_x)
