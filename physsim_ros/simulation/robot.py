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
    true_motion,
    View,
)
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world.robot_requests import robot_of_name


class Robot:
    """
    A robot of a simulation, which reports contacts from now on, for `bumped`.

    :param simulation: that it is in
    :param name: of its body
    :raises UnknownBody: there is no such body
    :raises BadProperty: it is no robot

    :ivar simulation: that it is in
    :ivar name: of its body
    """

    def __init__(self, simulation: Simulation, name: str) -> None:
        self.simulation = simulation
        self.name = name
        # After the requests that wait, one of which may spawn it.
        simulation.apply_up_to_seek()
        robot_of_name(simulation.world.space, name)
        simulation.reports_contacts = True

    @property
    def description(self) -> RobotDescription:
        """
        Return its drive, odometry and sensors.

        :raises UnknownBody: it is no longer there
        """
        view, row = self._seen
        robot = view.snapshot.scene.bodies[row].robot
        assert robot is not None  # noqa: S101 - others are refused above
        return robot

    def drive(self, speed: float, turn: float = 0.0, *, sideways: float = 0.0) -> None:
        """
        Drive from the next step on, until told otherwise.

        A reset, a seek and another world end it. The drive does what it can: a velocity beyond
        its limits is cut off.

        :param speed: forward [m/s]
        :param turn: counter-clockwise [rad/s]
        :param sideways: to the left, of an omnidirectional drive [m/s]
        :raises Malformed: a number is not finite
        """
        command = DriveRobot(name=self.name, velocity=(speed, sideways, turn))
        self.simulation.driving[self.name] = command

    def place(self, x: float, y: float, yaw: float = 0.0) -> None:
        """
        Put it at a pose in the world [m, m, rad], at rest; its odometry does not note it.

        :raises Malformed: a number is not finite
        """
        self.simulation.place(self.name, x, y, yaw)

    def scan(self, sensor: str = '') -> Floats:
        """
        Return (beams,) float64: the ranges of a laser [m], by the conventions of REP 117.

        Infinity is nothing within its greatest range, minus infinity nearer than its least one.

        :param sensor: its name; '' is the first laser
        :raises BadProperty: there is no such sensor
        """
        if sensor:
            ranges: Floats = self.read(sensor)
        else:
            view, row = self._seen
            ranges = read_sensor(view, row, self.first_laser)
        return ranges

    def read(self, sensor: str) -> Any:
        """
        Return the reading of a sensor: what the function of its kind in `sensing` returns.

        :param sensor: its name
        :raises BadProperty: there is no such sensor
        """
        sensors = self.description.sensors
        for each in sensors:
            if each.name == sensor:
                view, row = self._seen
                return read_sensor(view, row, each)
        names = [each.name for each in sensors]
        message = f'{self.name} has no sensor {sensor!r}{nearest_name(sensor, names)}'
        raise BadProperty(message, field='sensors')

    def odom(self) -> OdometryReading:
        """Return where its wheels and its gyroscope tell that it is, and how it moves."""
        view, row = self._seen
        return read_odometry(view.snapshot, row)

    def truth(self) -> OdometryReading:
        """Return where it is, and how it moves."""
        view, row = self._seen
        return true_motion(view.snapshot, row)

    def battery(self) -> BatteryReading | None:
        """Return the state of its battery; None where it has none."""
        view, row = self._seen
        return read_battery(view.snapshot, row)

    @property
    def bumped(self) -> bool:
        """
        Whether it has touched something since the frame before: within its bumpers, if any.

        It is false where contacts are not reported any more.
        """
        view, row = self._seen
        return is_bumped(view.snapshot, view.contacts, row, self.description)

    @property
    def _seen(self) -> tuple[View, int]:
        """
        Return the frame of now, and the row of its body in it.

        :raises UnknownBody: it is no longer there
        """
        view = self.simulation.view
        return view, view.snapshot.row(self.name)

    @property
    def first_laser(self) -> Laser:
        """
        Return its first laser.

        :raises BadProperty: it has none
        """
        for each in self.description.sensors:
            if isinstance(each, Laser):
                return each
        raise BadProperty(f'{self.name} has no laser', field='sensors')
