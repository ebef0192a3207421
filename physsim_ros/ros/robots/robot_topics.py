# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The topics of one robot, below its namespace.

Laws: a reading that nobody subscribes to is not made, and one of a moment is the same whoever
subscribes; a topic that ROS refuses, as another type has it, is refused, and the others are there.
"""

from __future__ import annotations

from collections.abc import Callable
import math
from typing import Any, TypeGuard

from builtin_interfaces.msg import Time
from nav_msgs.msg import Odometry
from physsim_ros.model.errors import BadProperty, Refusal
from physsim_ros.model.robot_states import SPAWNED
from physsim_ros.model.robots import Robot, Sensor
from physsim_ros.model.robots.sensors import Bumper, Laser
from physsim_ros.model.scene import Body
from physsim_ros.ros.robots.commands import Commands
from physsim_ros.ros.robots.frames import (
    BASE,
    FOOTPRINT,
    ODOM,
    RobotFrames,
    RobotTf,
    TF_DEPTH,
    tf_message_type,
    urdf_of,
)
from physsim_ros.ros.robots.messages import odometry_message, READINGS, StampedView
from physsim_ros.sensing import is_due, true_motion
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String


class RobotTopics:
    """
    The topics of a robot.

    :param node: that owns them
    :param body: name of the robot's body
    :param robot: that it is
    :param robot_tf: where its transforms are published
    :param world_frame: name of the world frame
    :param refuse: reports a topic that cannot be; takes the refusal and the topic
    :param expected: type of commands that is subscribed to while nobody publishes; None is none

    :ivar commands: that it hears
    """

    def __init__(
        self,
        node: Node,
        body: str,
        robot: Robot,
        *,
        robot_tf: RobotTf,
        world_frame: str,
        refuse: Callable[[Refusal, str], None],
        expected: type | None = None,
    ) -> None:
        self.body, self.robot = body, robot
        self._node = node
        self._refuse = refuse
        self._world_frame = world_frame
        namespace = robot.namespace_of(body)
        self._frames = RobotFrames(namespace, robot_tf)
        root = node.get_namespace().rstrip('/')
        self._below = f'{root}/{namespace}/' if namespace else f'{root}/'
        self._publishers: list[Publisher] = []
        self._odometry = self._publisher(Odometry, 'odom')
        self._truth = self._publisher(Odometry, 'ground_truth')
        self._sensors = [
            (sensor, self._publisher(READINGS[type(sensor)].kind, sensor.name))
            for sensor in robot.sensors
        ]
        durability = DurabilityPolicy.TRANSIENT_LOCAL
        self._description = self._publisher(
            String, 'robot_description', depth=1, durability=durability
        )
        # Colour and shape of the last description.
        self._described: object = None
        topic = f'{self._below}cmd_vel'
        self.commands = Commands(node, topic, body, robot.drive, refuse, expected=expected)
        self._tf: Publisher | None = None
        self._tf_message: Any = None if robot_tf is RobotTf.NONE else tf_message_type()
        if (kind := self._tf_message) is not None:
            below = self._below if robot_tf is RobotTf.NAMESPACED else '/'
            self._tf = self._publisher(kind, 'tf', below=below, depth=TF_DEPTH)
            fixed = self._publisher(
                kind,
                'tf_static',
                below=below,
                durability=durability,
            )
            if fixed is not None:
                fixed.publish(kind(transforms=self._frames.fixed(Time(), robot)))

    def _publisher(
        self,
        kind: type,
        topic: str,
        *,
        below: str | None = None,
        depth: int = 5,
        durability: DurabilityPolicy = DurabilityPolicy.VOLATILE,
    ) -> Publisher | None:
        # Publishers are reliable by default, and serve subscribers of both reliabilities.
        qos = QoSProfile(depth=depth, durability=durability)
        topic = (self._below if below is None else below) + topic
        try:
            publisher = self._node.create_publisher(kind, topic, qos)
        except rclpy_implementation.RCLError:
            # Within a process a topic has one type.
            message = f'{topic} is a topic of another type already'
            self._refuse(BadProperty(message, field='name'), topic)
            return None
        self._publishers.append(publisher)
        return publisher

    def describe(self, body: Body) -> None:
        """Publish how the robot looks, if that is new."""
        looks = body.shape, body.color, body.total_mass
        if self._description is not None and looks != self._described:
            self._described = looks
            self._description.publish(String(data=urdf_of(body, self._frames)))

    @property
    def has_subscribers(self) -> bool:
        """Whether one of its topics has subscribers."""
        return any(map(_is_heard, self._publishers))

    def wants_contacts(self) -> bool:
        """Return whether a bumper has subscribers."""
        return any(
            isinstance(sensor, Bumper) and _is_heard(publisher)
            for sensor, publisher in self._sensors
        )

    def publish(self, view: StampedView, row: int, number: int) -> bool:
        """
        Publish what is due at a frame and has subscribers.

        :param view: of the frame
        :param row: of the robot's body in the scene
        :param number: of the robot among those of the scene
        :return: whether a scan is among it
        """
        scanned = False
        # Before the readings, which are looked up in it by their stamps.
        if _is_heard(self._tf):
            odometry = view.snapshot.robots.odometry[number].tolist()
            moving = self._frames.moving(view.stamp, tuple(odometry))
            self._tf.publish(self._tf_message(transforms=[moving]))
        if _is_heard(self._truth):
            self._truth.publish(self.truth(view, row))
        odometry = self.robot.odometry
        if _is_heard(self._odometry) and self._is_due('odom', odometry.rate, view):
            self._odometry.publish(self.odometry(view, number))
        for sensor, publisher in self._sensors:
            if _is_heard(publisher) and self._is_due(sensor.name, sensor.rate, view):
                publisher.publish(self.reading(view, row, sensor))
                scanned |= isinstance(sensor, Laser)
        return scanned

    def odometry(self, view: StampedView, number: int) -> Odometry:
        """Return where wheels and gyroscope tell that the robot is, and how it moves."""
        states = view.snapshot.robots
        ahead, aside, turn = states.wheels[number].tolist()
        way, heading = (deviation**2 for deviation in self.robot.odometry.slip)
        # Drifts are random walks along the path. That of the twist is their mean rate from one
        # message to the next: of the velocity along it, none across.
        speed, rate = math.hypot(ahead, aside), self.robot.odometry.rate
        share = way * rate / speed if speed > 0.0 else 0.0
        along = ahead * ahead * share, ahead * aside * share, aside * aside * share
        of_turn = heading * (speed + abs(turn)) * rate
        return odometry_message(
            view,
            tuple(states.odometry[number].tolist()),
            (ahead, aside, turn),
            parent=self._frames.name(ODOM),
            child=self._frames.name(FOOTPRINT),
            covariances=(
                tuple(states.covariance[number].tolist()),
                (*along, 0.0, 0.0, of_turn),
            ),
        )

    def truth(self, view: StampedView, row: int) -> Odometry:
        """Return where the robot is, and how it moves."""
        return odometry_message(
            view,
            *true_motion(view.snapshot, row),
            parent=self._world_frame,
            child=self._frames.name(BASE),
            covariances=(SPAWNED.covariance, SPAWNED.covariance),
        )

    def reading(self, view: StampedView, row: int, sensor: Sensor) -> Any:
        """Return the message of a sensor of it."""
        reading = READINGS[type(sensor)]
        message = reading.message(view, row, sensor)
        if reading.stamped:
            message.header.stamp = view.stamp
            message.header.frame_id = self._frames.name(sensor.name)
        return message

    def close(self) -> None:
        """Take the topics back."""
        self.commands.close()
        for publisher in self._publishers:
            self._node.destroy_publisher(publisher)

    def _is_due(self, name: str, rate: float, view: StampedView) -> bool:
        """Return whether what has a rate [Hz] reads at a frame, a past one as before."""
        now, before = view.snapshot.stamp, view.before
        if before is None:
            return True
        # In a rewind, the frame before is a later one: the period that counts ends with this one.
        period = abs(now - before.stamp)
        return is_due(f'{self.body}|{name}', rate, now - period, now)


def _is_heard(publisher: Publisher | None) -> TypeGuard[Publisher]:
    """Return whether a topic is there and has subscribers."""
    return publisher is not None and publisher.get_subscription_count() > 0
