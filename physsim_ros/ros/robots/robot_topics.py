# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The topics of one robot, below its namespace.

Laws: a reading that nobody subscribes to is not made, and one of a moment is the same whoever
subscribes; its latency depends on seed and moment alone, so that a rewind repeats it; a topic that
ROS refuses, as another type has it, is refused, and the others are there.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from builtin_interfaces.msg import Time
from nav_msgs.msg import Odometry
from physsim_ros.model.errors import BadProperty, Refusal
from physsim_ros.model.latency import delay
from physsim_ros.model.robots import Battery, BATTERY_TOPIC, part_name, Robot, Sensor
from physsim_ros.model.robots.sensors import Bumper, Laser
from physsim_ros.model.scene import Body, Scene
from physsim_ros.model.states import SPAWNED
from physsim_ros.model.transform import Point
from physsim_ros.ros.robots.command_topic import CommandTopic
from physsim_ros.ros.robots.description import urdf_of
from physsim_ros.ros.robots.drive_topic import DriveTopic
from physsim_ros.ros.robots.frames import (
    BASE,
    FOOTPRINT,
    ODOM,
    RobotFrames,
    RobotTf,
    TF_DEPTH,
    tf_message_type,
)
from physsim_ros.ros.robots.messages import (
    battery_message,
    odometry_message,
    SENSOR_MESSAGES,
    StampedFrame,
)
from physsim_ros.ros.robots.motor_topics import motor_topics
from physsim_ros.ros.topics import of_one_type
from physsim_ros.sensing import is_due, odometry_covariances, read_odometry, true_motion
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import BatteryState
from std_msgs.msg import String


@dataclass(slots=True, kw_only=True)
class _Topic:
    """
    A topic of a robot that is published at frames, while it is read.

    :ivar publisher: of the topic
    :ivar message: makes its message, of a frame and the row of the robot's body in the scene
    :ivar name: that sets the moments of its rate, and the latencies of its messages
    :ivar rate: [Hz]; None is each frame
    :ivar latency: least and greatest time from the frame of a message to its arrival [s]
    :ivar sensor: whose reading it is; None for other topics
    :ivar coming: messages on their way in their order, with the stamps at which they arrive, and
        of their frames [ns]
    """

    publisher: Publisher
    message: Callable[[StampedFrame, int], Any]
    name: str
    rate: float | None = None
    latency: Point = (0.0, 0.0)
    sensor: Sensor | None = None
    coming: deque[tuple[int, int, Any]] = field(default_factory=deque)

    def send(self, message: Any, sensed: StampedFrame) -> None:
        """Send the message of a frame, which arrives after those that were sent before."""
        snapshot = sensed.snapshot
        arrival = snapshot.stamp
        if any(self.latency):
            seed = snapshot.scene.settings.seed
            arrival += round(1e9 * delay(self.latency, seed, self.name, snapshot.step))
        if self.coming:
            arrival = max(arrival, self.coming[-1][0])
        self.coming.append((arrival, snapshot.stamp, message))

    def arrived(self, now: int) -> list[tuple[int, Any]]:
        """Return the messages that have arrived at a stamp, after the stamps of their frames."""
        messages = []
        while self.coming and self.coming[0][0] <= now:
            messages.append(self.coming.popleft()[1:])
        return messages

    @property
    def is_read(self) -> bool:
        """Whether it has subscribers."""
        return self.publisher.get_subscription_count() > 0


class RobotTopics:
    """
    The topics of a robot.

    :param node: that owns them
    :param body: name of the robot's body
    :param robot: that it is
    :param robot_tf: where its transforms are published
    :param world_frame: name of the world frame
    :param refuse: reports a topic that cannot be; takes the refusal and the topic
    :param lasers: fields of lasers that its messages have in place of its own
    :param expected: type of commands that is subscribed to while nobody publishes; None is none

    :ivar lasers: as given
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
        refuse: Callable[[Refusal, str], None],
        lasers: Mapping[str, Any],
        expected: type | None = None,
    ) -> None:
        self.body, self.robot, self.lasers = body, robot, lasers
        self._node = node
        self._refuse = refuse
        self._world_frame = world_frame
        namespace = robot.namespace_of(body)
        self._frames = RobotFrames(namespace, robot_tf)
        root = node.get_namespace().rstrip('/')
        self._below = f'{root}/{namespace}/' if namespace else f'{root}/'
        self._publishers: list[Publisher] = []
        self._topics: list[_Topic] = []
        # Before the readings, which are looked up in them by their stamps.
        self._add_transforms(robot_tf)
        self._add_motion()
        # Lasers as they are published, by the name of their topic.
        self._lasers: dict[str, Laser] = {}
        self._add_readings(lasers)
        self._description = self._publisher(
            String, 'robot_description', depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL
        )
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
            transforms, latency = partial(self._transforms, kind), robot.odometry.latency
            self._add(kind, 'tf', transforms, latency=latency, below=below, depth=TF_DEPTH)
        latched = DurabilityPolicy.TRANSIENT_LOCAL
        fixed = self._publisher(kind, 'tf_static', below=below, durability=latched)
        if fixed is not None:
            fixed.publish(kind(transforms=self._frames.fixed(Time(), robot)))

    def _add_motion(self) -> None:
        """Add ground truth, and odometry and battery if it has them."""
        self._add(Odometry, 'ground_truth', self.truth)
        if self.robot.drive is not None:
            odometry = self.robot.odometry
            rate, latency = odometry.rate, odometry.latency
            self._add(Odometry, 'odom', self.odometry, rate=rate, latency=latency)
        if (battery := self.robot.battery) is not None:
            state = partial(self._battery, battery)
            self._add(BatteryState, BATTERY_TOPIC, state, rate=battery.rate)

    def _add_readings(self, lasers: Mapping[str, Any]) -> None:
        """Add the readings of sensors; of lasers with some fields in place of their own."""
        for sensor in self.robot.sensors:
            if isinstance(sensor, Laser) and lasers:
                self._lasers[sensor.name] = self._changed(sensor, lasers)
            self._add(
                SENSOR_MESSAGES[type(sensor)].kind,
                sensor.name,
                partial(self.reading, sensor),
                rate=sensor.rate,
                latency=sensor.latency,
                sensor=sensor,
            )

    def _changed(self, laser: Laser, changes: Mapping[str, Any]) -> Laser:
        """Return a laser with other fields; itself, if that is refused."""
        try:
            return replace(laser, **changes)
        except Refusal as refusal:
            self._refuse(refusal, f'{self._below}{laser.name}')
            return laser

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
            topic = _Topic(
                publisher=publisher,
                message=message,
                name=f'{self.body}|{name}',
                rate=rate,
                latency=latency,
                sensor=sensor,
            )
            self._topics.append(topic)

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
            with of_one_type(topic):
                publisher = self._node.create_publisher(kind, topic, qos)
        except BadProperty as refusal:
            self._refuse(refusal, topic)
            return None
        self._publishers.append(publisher)
        return publisher

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

        While time goes back, messages have no latency.

        :param sensed: of the frame
        :param row: of the robot's body in the scene
        :return: stamp of the last scan of the first laser with subscribers [ns], which is the one
            that a controller answers: others may be heard by a recording alone; None without one
        """
        now, before = sensed.snapshot.stamp, sensed.before
        goes_back = before is not None and now < before.stamp
        scanned, first = None, None
        for topic in self._topics:
            if goes_back or not topic.is_read:
                topic.coming.clear()
            if not topic.is_read:
                continue
            if first is None and isinstance(topic.sensor, Laser):
                first = topic
            if self._is_due(topic, sensed):
                message = topic.message(sensed, row)
                if goes_back:
                    topic.publisher.publish(message)
                else:
                    topic.send(message, sensed)
            for stamp, message in topic.arrived(now):
                topic.publisher.publish(message)
                scanned = stamp if topic is first else scanned
        return scanned

    def send_again(self, seen: Sequence[tuple[StampedFrame, int]], now: int) -> None:
        """
        Send the messages that were on their way at a stamp, after a jump to it.

        :param seen: the frames up to that, with the rows, as of `publish`
        :param now: the stamp [ns]
        """
        late = [each for each in self._topics if each.latency[1] > 0.0 and each.is_read]
        for topic in late:
            topic.coming.clear()
            for sensed, row in seen:
                if self._is_due(topic, sensed):
                    topic.send(topic.message(sensed, row), sensed)
            topic.arrived(now)

    def _transforms(self, kind: type, sensed: StampedFrame, row: int) -> Any:
        """Return the message of the transforms that move."""
        transforms = self._frames.of_links(sensed.stamp, sensed.snapshot, self.body, self.robot)
        if self.robot.drive is not None:
            pose = read_odometry(sensed.snapshot, row).pose
            transforms = [self._frames.moving(sensed.stamp, pose), *transforms]
        return kind(transforms=transforms)

    def odometry(self, sensed: StampedFrame, row: int) -> Odometry:
        """Return where wheels and gyroscope tell that the robot is, and how it moves."""
        return odometry_message(
            sensed,
            read_odometry(sensed.snapshot, row),
            parent=self._frames.name(ODOM),
            child=self._frames.name(FOOTPRINT),
            covariances=odometry_covariances(sensed.snapshot, row),
        )

    def truth(self, sensed: StampedFrame, row: int) -> Odometry:
        """Return where the robot is, and how it moves."""
        return odometry_message(
            sensed,
            true_motion(sensed.snapshot, row),
            parent=self._world_frame,
            child=self._frames.name(BASE),
            covariances=(SPAWNED.covariance, SPAWNED.covariance),
        )

    def _battery(self, battery: Battery, sensed: StampedFrame, row: int) -> BatteryState:
        """Return the state of the battery."""
        message = battery_message(sensed, row, battery)
        message.header.frame_id = self._frames.name(BASE)
        return message

    def reading(self, sensor: Sensor, sensed: StampedFrame, row: int) -> Any:
        """Return the message of a sensor of it."""
        reading = SENSOR_MESSAGES[type(sensor)]
        message = reading.message(sensed, row, self._lasers.get(sensor.name, sensor))
        if reading.stamped:
            message.header.stamp = sensed.stamp
            message.header.frame_id = self._frames.name(sensor.name)
        return message

    def close(self) -> None:
        """Take the topics back."""
        for topic in self.command_topics:
            topic.close()
        for publisher in self._publishers:
            self._node.destroy_publisher(publisher)

    def _is_due(self, topic: _Topic, sensed: StampedFrame) -> bool:
        """Return whether a topic is published at a frame, at a past one as before."""
        now, before = sensed.snapshot.stamp, sensed.before
        if topic.rate is None or before is None:
            return True
        # In a rewind, the frame before is a later one: the period that counts ends with this one.
        period = abs(now - before.stamp)
        return is_due(topic.name, topic.rate, now - period, now)
