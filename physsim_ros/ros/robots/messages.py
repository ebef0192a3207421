# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Messages of robots: odometry, and one function for each kind of sensor.

Messages are those of rclpy, which copies an `array` as it is: there is no need for bytes by hand.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable
from functools import cached_property
import math
from typing import Any, NamedTuple

from builtin_interfaces.msg import Time as TimeMessage
from geometry_msgs.msg import Point, PoseArray, Vector3
from geometry_msgs.msg import Pose as PoseMessage
from nav_msgs.msg import Odometry
from physsim_ros.model.robots import Battery
from physsim_ros.model.robots.sensors import (
    Bumper,
    FloorEye,
    Gps,
    Imu,
    Landmarks,
    Laser,
    RangeFinder,
    Sensor,
    WheelEncoders,
)
from physsim_ros.model.states import Covariance
from physsim_ros.ros.planar import pose_message, rotation_of
from physsim_ros.sensing import OdometryReading, read_battery, read_sensor, SensedFrame
from rclpy.time import Time
from sensor_msgs.msg import (
    BatteryState,
    Image,
    JointState,
    LaserScan,
    NavSatFix,
    NavSatStatus,
    Range,
)
from sensor_msgs.msg import Imu as ImuMessage
from std_msgs.msg import Bool, Header

# Least variance that is told of a pose [m², rad²] or a twist [m²/s², rad²/s²]: localisers take 0
# for unknown.
LEAST_VARIANCE = 1e-9
# Variance of what a planar robot does not measure, as other robots tell it.
_UNKNOWN = 1e6
# By the key `status` of a receiver that has a fix.
_STATUSES = {
    'fix': NavSatStatus.STATUS_FIX,
    'sbas': NavSatStatus.STATUS_SBAS_FIX,
    'gbas': NavSatStatus.STATUS_GBAS_FIX,
}
# Places in a covariance of 6 × 6: of the variances of x, y and yaw; of those of the other parts;
# of xx, xy, yy, x yaw, y yaw, yaw yaw, above and below the diagonal.
_PLANAR, _OTHERS = (0, 7, 35), (14, 21, 28)
_ABOVE, _BELOW = (0, 1, 7, 5, 11, 35), (0, 6, 7, 30, 31, 35)


class StampedFrame(SensedFrame):
    """A frame as the sensors of all robots see it, with its time as ROS has it."""

    @cached_property
    def stamp(self) -> TimeMessage:
        """Time of the frame, in the simulation."""
        return Time(nanoseconds=self.snapshot.stamp).to_msg()


def odometry_message(
    sensed: StampedFrame,
    motion: OdometryReading,
    *,
    parent: str,
    child: str,
    covariances: tuple[Covariance, Covariance],
) -> Odometry:
    """
    Return a pose and the twist there.

    :param motion: the pose in the parent frame, the twist in the child frame
    :param covariances: of the pose in the parent frame, of the twist in the child frame
    """
    message = Odometry(child_frame_id=child)
    message.header.stamp, message.header.frame_id = sensed.stamp, parent
    message.pose.pose = pose_message(motion.pose)
    message.pose.covariance, message.twist.covariance = map(_covariance, covariances)
    vx, vy, turn = motion.twist
    message.twist.twist.linear = Vector3(x=vx, y=vy)
    message.twist.twist.angular.z = turn
    return message


def _covariance(planar: Covariance) -> list[float]:
    covariance = [0.0] * 36
    for above, below, value in zip(_ABOVE, _BELOW, planar, strict=True):
        covariance[above] = covariance[below] = value
    for place in _PLANAR:
        covariance[place] = max(covariance[place], LEAST_VARIANCE)
    for place in _OTHERS:
        covariance[place] = _UNKNOWN
    return covariance


def scan_message(sensed: StampedFrame, row: int, laser: Laser) -> LaserScan:
    """Return the scan of a laser."""
    least, greatest = laser.range
    ranges = read_sensor(sensed, row, laser)
    return LaserScan(
        angle_min=laser.angle[0],
        angle_max=laser.angle[0] + (laser.beams - 1) * laser.increment,
        angle_increment=laser.increment,
        scan_time=1.0 / laser.rate,
        range_min=least,
        range_max=greatest,
        ranges=array('f', ranges.astype('f4').tobytes()),
    )


def range_message(sensed: StampedFrame, row: int, finder: RangeFinder) -> Range:
    """Return the reading of a range finder."""
    least, greatest = finder.range
    sonar = finder.radiation == 'sonar'
    return Range(
        radiation_type=Range.ULTRASOUND if sonar else Range.INFRARED,
        field_of_view=finder.cone,
        min_range=least,
        max_range=greatest,
        range=read_sensor(sensed, row, finder),
        # 0 is an unknown variance.
        variance=max(finder.noise**2, LEAST_VARIANCE),
    )


def landmarks_message(sensed: StampedFrame, row: int, finder: Landmarks) -> PoseArray:
    """Return a pose for each landmark, in the frame of the sensor; NaN where it is unseen."""
    readings = read_sensor(sensed, row, finder)
    points = (
        Point(x=distance * math.cos(bearing), y=distance * math.sin(bearing))
        for distance, bearing in readings.tolist()
    )
    return PoseArray(poses=[PoseMessage(position=point) for point in points])


def bumper_message(sensed: StampedFrame, row: int, bumper: Bumper) -> Bool:
    """Return the reading of a bumper."""
    return Bool(data=read_sensor(sensed, row, bumper))


def imu_message(sensed: StampedFrame, row: int, imu: Imu) -> ImuMessage:
    """Return the reading of an inertial measurement unit."""
    reading = read_sensor(sensed, row, imu)
    message = ImuMessage(orientation=rotation_of(reading.yaw))
    message.angular_velocity.z = reading.turn_rate
    message.linear_acceleration.x, message.linear_acceleration.y = reading.acceleration
    message.linear_acceleration.z = imu.gravity
    acceleration, turn_rate = (max(each**2, LEAST_VARIANCE) for each in imu.noise)
    for covariance, variance in (
        (message.orientation_covariance, LEAST_VARIANCE),
        (message.angular_velocity_covariance, turn_rate),
        (message.linear_acceleration_covariance, acceleration),
    ):
        covariance[0] = covariance[4] = covariance[8] = variance
    return message


def wheels_message(sensed: StampedFrame, row: int, encoders: WheelEncoders) -> JointState:
    """Return the turns of the wheels [rad], and their rates [rad/s]."""
    wheels = read_sensor(sensed, row, encoders)
    return JointState(
        name=wheels.names,
        position=array('d', wheels.positions.tobytes()),
        velocity=array('d', wheels.velocities.tobytes()),
    )


def floor_message(sensed: StampedFrame, row: int, eye: FloorEye) -> Image:
    """Return the picture of a line follower's eye."""
    colors = read_sensor(sensed, row, eye)
    return Image(
        height=1,
        width=eye.pixels,
        encoding='rgb8',
        step=3 * eye.pixels,
        data=array('B', colors.tobytes()),
    )


def fix_message(sensed: StampedFrame, row: int, gps: Gps) -> NavSatFix:
    """Return the reading of a receiver of satellite navigation."""
    fix = read_sensor(sensed, row, gps)
    if fix is None:
        return NavSatFix(
            status=NavSatStatus(status=NavSatStatus.STATUS_NO_FIX),
            latitude=math.nan,
            longitude=math.nan,
            altitude=math.nan,
        )
    message = NavSatFix(
        status=NavSatStatus(status=_STATUSES[gps.status], service=NavSatStatus.SERVICE_GPS),
        latitude=fix.latitude,
        longitude=fix.longitude,
        altitude=fix.altitude,
        position_covariance_type=NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN,
    )
    variance = max(gps.noise**2, LEAST_VARIANCE)
    message.position_covariance[0] = message.position_covariance[4] = variance
    message.position_covariance[8] = LEAST_VARIANCE
    return message


def battery_message(sensed: StampedFrame, row: int, battery: Battery) -> BatteryState:
    """Return the state of a battery."""
    reading = read_battery(sensed.snapshot, row)
    assert reading is not None  # noqa: S101 - it has one
    status = BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
    if reading.is_docked:
        status = BatteryState.POWER_SUPPLY_STATUS_CHARGING
    if reading.is_docked and reading.level >= 1.0:
        status = BatteryState.POWER_SUPPLY_STATUS_FULL
    return BatteryState(
        header=Header(stamp=sensed.stamp),
        voltage=battery.voltage,
        temperature=math.nan,
        current=reading.current,
        charge=reading.level * battery.capacity,
        capacity=battery.capacity,
        design_capacity=battery.capacity,
        percentage=reading.level,
        power_supply_status=status,
        power_supply_health=BatteryState.POWER_SUPPLY_HEALTH_GOOD,
        present=True,
    )


class SensorMessage(NamedTuple):
    """
    How the reading of a kind of sensor becomes a message.

    :ivar kind: type of the message
    :ivar message: of a frame, a row of the scene, and the sensor
    :ivar stamped: whether it has a header
    """

    kind: type
    message: Callable[[StampedFrame, int, Any], Any]
    stamped: bool = True


SENSOR_MESSAGES: dict[type[Sensor], SensorMessage] = {
    Laser: SensorMessage(LaserScan, scan_message),
    RangeFinder: SensorMessage(Range, range_message),
    Landmarks: SensorMessage(PoseArray, landmarks_message),
    Bumper: SensorMessage(Bool, bumper_message, stamped=False),
    Imu: SensorMessage(ImuMessage, imu_message),
    WheelEncoders: SensorMessage(JointState, wheels_message),
    FloorEye: SensorMessage(Image, floor_message),
    Gps: SensorMessage(NavSatFix, fix_message),
}
