# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A robot of a simulation: driven, and read, by a program without ROS.

Law: a reading is that of the frame of now, with the noise of its step, so that reading twice, or
not at all, changes nothing.
"""

from __future__ import annotations

from typing import Any

from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.requests import DriveRobot
from physsim_ros.model.robots import Robot as RobotDescription
from physsim_ros.model.robots.sensors import Laser
from physsim_ros.model.texts import nearest_name
from physsim_ros.sensing import (
    BatteryReading,
    is_bumped,
    OdometryReading,
    read_battery,
    read_odometry,
    read_sensor,
    SensedFrame,
    true_motion,
)
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world.robot_requests import drive_of_name, robot_of_name


class Robot:
    """
    A robot of a simulation: a program drives it, and reads its sensors.

    The simulation reports contacts from then on, for `bumped`.

    >>> from physsim_ros import find_world, load_world, Robot, Simulation
    >>> simulation = Simulation()
    >>> simulation.load(load_world(find_world('burger')))
    'loaded 4 bodies'
    >>> robot = Robot(simulation, 'burger/0')
    >>> robot.drive(0.2)  # m/s
    >>> simulation.run(1.0)
    >>> robot.bumped, len(robot.scan()), round(float(robot.truth().twist[0]), 3)
    (False, 360, 0.2)

    :param simulation: simulation that the robot is in
    :param name: name of the robot's body
    :raises UnknownBody: no body has that name
    :raises BadProperty: the body is not a robot

    :ivar simulation: simulation that the robot is in
    :ivar name: name of the robot's body
    """

    def __init__(self, simulation: Simulation, name: str) -> None:
        self.simulation = simulation
        self.name = name
        # After the requests that wait, one of which may spawn it.
        simulation.applier.apply_all()
        robot_of_name(simulation.world.space, name)
        simulation.reports_contacts = True

    @property
    def description(self) -> RobotDescription:
        """
        Return the description of its drive, odometry, sensors and parts.

        :raises UnknownBody: the robot was deleted
        """
        sensed, row = self._seen
        robot = sensed.snapshot.scene.bodies[row].robot
        assert robot is not None  # noqa: S101 - others are refused above
        return robot

    def drive(self, speed: float, turn: float = 0.0, *, sideways: float = 0.0) -> None:
        """
        Drive from the next step on, until the next call.

        A reset, a seek, a rewind, another course and another world end the command. The drive cuts
        off a velocity beyond its limits.

        :param speed: forward speed [m/s]
        :param turn: turn rate, counter-clockwise [rad/s]
        :param sideways: speed to the left, for an omnidirectional drive [m/s]
        :raises Malformed: a number is not finite
        :raises BadProperty: the robot has no drive
        :raises UnknownBody: the robot was deleted
        """
        command = DriveRobot(name=self.name, velocity=(speed, sideways, turn))
        drive_of_name(self.simulation.world.space, self.name)
        self.simulation.keep_driving(command)

    def place(self, x: float, y: float, yaw: float = 0.0) -> None:
        """
        Put the robot at a pose in the world, at rest, without a change of its odometry.

        :param x: x of its origin [m]
        :param y: y of its origin [m]
        :param yaw: its heading, counter-clockwise [rad]
        :raises Malformed: a number is not finite
        """
        self.simulation.place(self.name, x, y, yaw)

    def scan(self, sensor: str = '') -> Floats:
        """
        Return (beams,) float64: the ranges of a laser [m], by the conventions of REP 117.

        A beam without an echo is infinity, one below the least range minus infinity, and a
        blind one NaN.

        :param sensor: name of the laser; '' is the first one
        :raises BadProperty: the robot has no such sensor
        """
        if sensor:
            ranges: Floats = self.read(sensor)
        else:
            sensed, row = self._seen
            ranges = read_sensor(sensed, row, self.first_laser)
        return ranges

    def read(self, sensor: str) -> Any:
        """
        Return the reading of a sensor: what the function of its kind in `sensing` returns.

        :param sensor: name of the sensor
        :raises BadProperty: the robot has no such sensor
        """
        sensors = self.description.sensors
        for each in sensors:
            if each.name == sensor:
                sensed, row = self._seen
                return read_sensor(sensed, row, each)
        names = [each.name for each in sensors]
        raise BadProperty(
            '{name} has no sensor {sensor!r}{near}',
            field='sensors',
            name=self.name,
            sensor=sensor,
            near=nearest_name(sensor, names),
        )

    def odom(self) -> OdometryReading:
        """Return the pose [m, m, rad] and twist [m/s, m/s, rad/s] by its wheels and gyroscope."""
        sensed, row = self._seen
        return read_odometry(sensed.snapshot, row)

    def truth(self) -> OdometryReading:
        """Return the true pose [m, m, rad] and twist [m/s, m/s, rad/s]."""
        sensed, row = self._seen
        return true_motion(sensed.snapshot, row)

    def battery(self) -> BatteryReading | None:
        """Return the state of its battery; None if it has no battery."""
        sensed, row = self._seen
        return read_battery(sensed.snapshot, row)

    @property
    def bumped(self) -> bool:
        """
        Whether the robot has touched something since the frame before.

        If it has bumpers, only what they touched counts. False if the simulation no longer reports
        contacts.
        """
        sensed, row = self._seen
        return is_bumped(sensed.snapshot, sensed.contacts, row, self.description)

    @property
    def _seen(self) -> tuple[SensedFrame, int]:
        """
        Return the frame of now, and the row of its body in it.

        :raises UnknownBody: it is no longer there
        """
        sensed = self.simulation.sensed
        return sensed, sensed.snapshot.row(self.name)

    @property
    def first_laser(self) -> Laser:
        """
        Return its first laser.

        :raises BadProperty: the robot has no laser
        """
        for each in self.description.sensors:
            if isinstance(each, Laser):
                return each
        raise BadProperty('{name} has no laser', field='sensors', name=self.name)
