# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A robot in the world of a test: driven, and read, without topics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import json
from typing import Any

from nav_msgs.msg import Odometry
from physsim_ros.files import shipped_robot
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.shapes import SHAPES
from physsim_ros.model.texts import nearest_name
from physsim_ros.ros.marker_shapes import geometry_of
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.robots.messages import StampedFrame
from physsim_ros.ros.robots.robot_topics import RobotTopics
from physsim_ros.sensing import is_bumped
from physsim_ros.simulation.robot import Robot as SimulatedRobot
from physsim_ros.testing.messages import marker
from physsim_ros.testing.values import UnknownName
from sensor_msgs.msg import LaserScan
from visualization_msgs.msg import Marker


class Robot:
    """
    A robot of a world.

    :param node: that owns the world
    :param body: its name

    :ivar name: of its body
    """

    def __init__(self, node: PhysSimNode, body: str) -> None:
        self.name = body
        self._node = node
        self._robot = SimulatedRobot(node.simulation, body)

    def drive(self, speed: float, turn: float = 0.0, *, sideways: float = 0.0) -> None:
        """
        Drive until told otherwise; a rewind ends it.

        :param speed: forward [m/s]
        :param turn: counter-clockwise [rad/s]
        :param sideways: to the left, of an omnidirectional drive [m/s]
        """
        self._robot.drive(speed, turn, sideways=sideways)

    def scan(self, sensor: str = '') -> LaserScan:
        """
        Return the scan of a laser, as of now.

        :param sensor: its name; '' is the first laser
        :raises UnknownName: there is no such sensor
        """
        return self.read(sensor or self._first('laser'))

    def read(self, sensor: str) -> Any:
        """
        Return the message of a sensor, as of now.

        :param sensor: its name
        :raises UnknownName: there is no such sensor
        """
        topics, sensed, row = self._now()
        sensors = {each.name: each for each in topics.robot.sensors}
        if sensor not in sensors:
            raise UnknownName(
                f'{self.name} has no sensor {sensor!r}{nearest_name(sensor, sensors)}'
            )
        return topics.messages.reading(sensors[sensor], sensed, row)

    def odom(self) -> Odometry:
        """
        Return its pose and velocity as wheels and gyroscope measure them, as of now.

        :raises UnknownName: the robot is not there
        """
        topics, sensed, row = self._now()
        return topics.messages.odometry(sensed, row)

    def truth(self) -> Odometry:
        """
        Return its true pose and velocity, as of now.

        :raises UnknownName: the robot is not there
        """
        topics, sensed, row = self._now()
        return topics.messages.truth(sensed, row)

    @property
    def bumped(self) -> bool:
        """Whether it touched something in the last frame: within its bumpers, if it has any."""
        topics, sensed, row = self._now()
        return is_bumped(sensed.snapshot, sensed.contacts, row, topics.robot)

    @property
    def has_controller(self) -> bool:
        """Whether another node publishes its commands and subscribes to one of its topics."""
        topics, _, _ = self._now()
        drive = topics.drive_topic
        return drive is not None and drive.has_publisher and topics.is_read

    def _now(self) -> tuple[RobotTopics, StampedFrame, int]:
        """Return its topics, the last frame, and the row of its body in the scene."""
        fleet = self._node.fleet
        if fleet.sensed is None or self.name not in fleet.scene_robots.topics:
            raise UnknownName(f'there is no robot {self.name!r}')
        row = fleet.sensed.snapshot.scene.row_of[self.name]
        return fleet.scene_robots.topics[self.name], fleet.sensed, row

    def _first(self, kind: str) -> str:
        topics, _, _ = self._now()
        names = [each.name for each in topics.robot.sensors if kind == each.KIND]
        if not names:
            raise UnknownName(f'{self.name} has no {kind}')
        return names[0]


def robot_marker(
    robot: str | Mapping[str, Any], name: str, at: Sequence[float], namespace: str | None
) -> Marker:
    """
    Return the marker of a shipped robot.

    :param robot: its name, or a mapping with that as `from`, and what is different
    :param name: of the body
    :param at: x, y [m] and, where there are three, yaw [rad]
    :param namespace: of its topics; None is by the name of the body
    :raises BadProperty: there is no such robot, or none is named
    """
    changes = {'from': robot} if isinstance(robot, str) else dict(robot)
    if changes.get('from') is None:
        raise BadProperty(
            'name a shipped robot as from; a robot with a shape of its own is spawned by '
            "box('own/0', robot={{...}})",
            field='from',
        )
    entry = shipped_robot(str(changes['from']))
    key = next(key for key in SHAPES if key in entry)
    kind, scale, points = geometry_of(SHAPES[key].from_value(entry[key], key))
    if namespace is not None:
        changes['namespace'] = namespace
    text = {key: entry[key] for key in ('mass', 'density') if key in entry} | {'robot': changes}
    return marker(kind, name, at=at, scale=scale, points=points, text=json.dumps(text))
