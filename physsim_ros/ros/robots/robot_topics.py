# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The topics of one robot, below its namespace.

Law: a topic that ROS refuses, as another type has it, is refused, and the others are there.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from builtin_interfaces.msg import Time
from nav_msgs.msg import Odometry
from physsim_ros.model.errors import Refusal
from physsim_ros.model.robots import BATTERY_TOPIC, part_name, Robot, Sensor
from physsim_ros.model.robots.sensors import Bumper, Laser
from physsim_ros.model.scene import Body, Scene
from physsim_ros.model.transform import Point
from physsim_ros.ros.robots.command_topic import CommandTopic
from physsim_ros.ros.robots.description import urdf_of
from physsim_ros.ros.robots.drive_topic import DriveTopic
from physsim_ros.ros.robots.frames import RobotFrames, RobotTf, TF_DEPTH, tf_message_type
from physsim_ros.ros.robots.messages import SENSOR_MESSAGES, StampedFrame
from physsim_ros.ros.robots.motor_topics import motor_topics
from physsim_ros.ros.robots.robot_messages import RobotMessages
from physsim_ros.ros.robots.timed_topic import TimedTopic
from physsim_ros.ros.topics import LATCHED, Refuse, refusing_another_type
from physsim_ros.sensing import reading_name
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from sensor_msgs.msg import BatteryState
from std_msgs.msg import String


class RobotTopics:
    """
    The topics of a robot.

    :param node: that owns them
    :param body: name of the robot's body
    :param robot: that it is
    :param robot_tf: where its transforms are published
    :param world_frame: name of the world frame
    :param refuse: reports a topic that cannot be
    :param lasers: fields of lasers that its messages have in place of its own
    :param expected: type of commands that is subscribed to while nobody publishes; None is none

    :ivar lasers: as given
    :ivar messages: of the robot
    :ivar drive_topic: of the commands for its drive; None without a drive
    """

    def __init__(
        self,
        node: Node,
        body: str,
        robot: Robot,
        *,
        robot_tf: RobotTf,
        world_frame: str,
        refuse: Refuse,
        lasers: Mapping[str, Any],
        expected: type | None = None,
    ) -> None:
        self.body, self.robot, self.lasers = body, robot, lasers
        self._node = node
        self._refuse = refuse
        namespace = robot.namespace_of(body)
        self._frames = RobotFrames(namespace, robot_tf)
        root = node.get_namespace().rstrip('/')
        self._below = f'{root}/{namespace}/' if namespace else f'{root}/'
        self._publishers: list[Publisher] = []
        self._topics: list[TimedTopic] = []
        changed = self._changed_lasers(lasers)
        self.messages = messages = RobotMessages(
            body, robot, self._frames, world_frame=world_frame, lasers=changed
        )
        # Before the readings, which are looked up in them by their stamps.
        self._add_transforms(robot_tf)
        self._add_motion()
        for sensor in robot.sensors:
            self._add(
                SENSOR_MESSAGES[type(sensor)].kind,
                sensor.name,
                partial(messages.reading, sensor),
                rate=sensor.rate,
                latency=sensor.latency,
                sensor=sensor,
            )
        self._description = self._publisher(String, 'robot_description', qos=LATCHED)
        # Colour and shape of the last description.
        self._described: object = None
        self.drive_topic: DriveTopic | None = None
        if robot.drive is not None:
            topic = f'{self._below}{robot.command_topic}'
            self.drive_topic = DriveTopic(
                node, topic, body, robot.drive, refuse, expected=expected
            )
        self._motors = motor_topics(node, self._below, body, robot, refuse)

    @property
    def command_topics(self) -> list[CommandTopic]:
        """Return the topics of its commands."""
        return [*([] if self.drive_topic is None else [self.drive_topic]), *self._motors]

    def _add_transforms(self, robot_tf: RobotTf) -> None:
        """Add the transforms that move, and publish those that do not."""
        kind, robot = tf_message_type(), self.robot
        if kind is None or robot_tf is RobotTf.NONE:
            return
        below = self._below if robot_tf is RobotTf.NAMESPACED else '/'
        if robot.drive is not None or robot.links:
            transforms, latency = partial(self.messages.transforms, kind), robot.odometry.latency
            self._add(kind, 'tf', transforms, latency=latency, below=below, qos=TF_DEPTH)
        fixed = self._publisher(kind, 'tf_static', below=below, qos=LATCHED)
        if fixed is not None:
            fixed.publish(kind(transforms=self._frames.fixed(Time(), robot)))

    def _add_motion(self) -> None:
        """Add ground truth, and odometry and battery if it has them."""
        self._add(Odometry, 'ground_truth', self.messages.truth)
        if self.robot.drive is not None:
            odometry = self.robot.odometry
            rate, latency = odometry.rate, odometry.latency
            self._add(Odometry, 'odom', self.messages.odometry, rate=rate, latency=latency)
        if (battery := self.robot.battery) is not None:
            state = partial(self.messages.battery, battery)
            self._add(BatteryState, BATTERY_TOPIC, state, rate=battery.rate)

    def _changed_lasers(self, changes: Mapping[str, Any]) -> dict[str, Laser]:
        """Return its lasers with other fields, by name, but those where that is refused."""
        changed = {}
        for laser in self.robot.sensors:
            if isinstance(laser, Laser) and changes:
                try:
                    changed[laser.name] = replace(laser, **changes)
                except Refusal as refusal:
                    self._refuse(refusal, f'{self._below}{laser.name}')
        return changed

    def _add(
        self,
        kind: type,
        name: str,
        message: Callable[[StampedFrame, int], Any],
        *,
        rate: float | None = None,
        latency: Point = (0.0, 0.0),
        sensor: Sensor | None = None,
        **options: Any,
    ) -> None:
        """Add a topic to those that are published at frames, unless ROS refuses it."""
        publisher = self._publisher(kind, name, **options)
        if publisher is not None:
            name = reading_name(self.body, name)
            self._topics.append(
                TimedTopic(publisher, message, name, rate=rate, latency=latency, sensor=sensor)
            )

    def _publisher(
        self,
        kind: type,
        topic: str,
        *,
        below: str | None = None,
        qos: QoSProfile | int = 5,
    ) -> Publisher | None:
        topic = (self._below if below is None else below) + topic
        with refusing_another_type(topic, self._refuse):
            publisher = self._node.create_publisher(kind, topic, qos)
            self._publishers.append(publisher)
            return publisher
        return None

    def describe(self, body: Body, scene: Scene) -> None:
        """Publish how the robot looks, if that is new."""
        rows = {
            link: scene.row_of.get(part_name(body.name, link.name)) for link in self.robot.links
        }
        parts = [(link, scene.bodies[row]) for link, row in rows.items() if row is not None]
        bodies = body, *(part for _, part in parts)
        looks = [(each.shape, each.color, each.total_mass) for each in bodies]
        # Without one of its links a description is none.
        whole = len(parts) == len(self.robot.links)
        if self._description is not None and whole and looks != self._described:
            self._described = looks
            self._description.publish(String(data=urdf_of(body, self._frames, parts)))

    @property
    def is_read(self) -> bool:
        """Whether one of its topics has subscribers."""
        return any(each.get_subscription_count() for each in self._publishers)

    @property
    def wants_contacts(self) -> bool:
        """Whether a bumper has subscribers."""
        return any(isinstance(each.sensor, Bumper) and each.is_read for each in self._topics)

    @property
    def longest_latency(self) -> float:
        """Return the longest time that a message that is read can be on its way [s]."""
        return max((each.latency[1] for each in self._topics if each.is_read), default=0.0)

    def publish(self, sensed: StampedFrame, row: int) -> int | None:
        """
        Publish what arrives at a frame and has subscribers.

        :param sensed: of the frame
        :param row: of the robot's body in the scene
        :return: stamp of the last scan of the first laser with subscribers [ns], which is the one
            that a controller answers: others may be heard by a recording alone; None without one
        """
        lasers = (each for each in self._topics if isinstance(each.sensor, Laser))
        first = next((each for each in lasers if each.is_read), None)
        stamps = {topic: topic.publish(sensed, row) for topic in self._topics}
        return None if first is None else stamps[first]

    def send_again(self, seen: Sequence[tuple[StampedFrame, int]], now: int) -> None:
        """
        Send the messages that were on their way at a stamp, after a jump to it.

        :param seen: the frames up to that, with the rows, as of `publish`
        :param now: the stamp [ns]
        """
        for topic in self._topics:
            topic.send_again(seen, now)

    def close(self) -> None:
        """Take the topics back."""
        for topic in self.command_topics:
            topic.close()
        for publisher in self._publishers:
            self._node.destroy_publisher(publisher)
