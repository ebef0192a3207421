# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Commands of a drive: `cmd_vel`, as `Twist`, as `TwistStamped`, or of a car as Ackermann drive.

The type is that of a publisher, by `type_choice`. Where the process has other nodes, nothing is
subscribed to before a publisher is there. Of what comes between two frames the last one counts.
"""

from __future__ import annotations

from contextlib import suppress
from functools import partial
import math
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from physsim_ros.model.errors import BadProperty, Malformed, Refusal
from physsim_ros.model.requests import DriveRobot
from physsim_ros.model.robots import Car, Drive
from physsim_ros.model.transform import REST
from physsim_ros.model.transform import Twist as Velocity
from physsim_ros.model.translation import NOTHING, Text
from physsim_ros.ros.robots.command_topic import CommandTopic, MOST_BYTES
from physsim_ros.ros.robots.type_choice import Choice, TypeChoice
from physsim_ros.ros.topics import decoded, Refuse, refusing_another_type
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from rclpy.time import Time

# By their names on the graph.
_TYPES = {'geometry_msgs/msg/Twist': Twist, 'geometry_msgs/msg/TwistStamped': TwistStamped}
_ACKERMANN = 'ackermann_msgs/msg/AckermannDriveStamped'
# Of a burst the last ones count.
_DEPTH = 10


class DriveTopic(CommandTopic):
    """
    The topic of commands for the drive of a robot.

    :param node: that subscribes
    :param topic: of its commands, below its namespace
    :param body: its name
    :param drive: that obeys them
    :param refuse: reports that publishers are ignored
    :param expected: type that is subscribed to while nobody publishes; None is none

    :ivar velocity: of the last command [m/s, rad/s]
    :ivar awaited: stamp of the scan that no command has answered yet [ns]; None is none
    """

    def __init__(
        self,
        node: Node,
        topic: str,
        body: str,
        drive: Drive,
        refuse: Refuse,
        *,
        expected: type | None = None,
    ) -> None:
        super().__init__(topic)
        self.velocity: Velocity = REST
        self.awaited: int | None = None
        self._node = node
        self._body = body
        self._drive = drive
        types: dict[str, type] = dict(_TYPES)
        if isinstance(drive, Car) and (ackermann := ackermann_type()) is not None:
            types[_ACKERMANN] = ackermann
        self._types = TypeChoice(types, expected)
        self._refuse = refuse
        # The reason why some publishers are ignored; `NOTHING` where none is.
        self._ignored = NOTHING
        # Whether the last command had a stamp of 0, which is none.
        self._unstamped = False
        # Type and bytes of the last command.
        self._last: tuple[type, bytes] | None = None
        # Name of the topic on the graph, and number of its publishers at the last look; None where
        # the look is to be repeated.
        self._resolved = node.resolve_topic_name(topic)
        self._count: int | None = None
        # None while nothing is subscribed to.
        self._subscribed: Choice | None = None
        self._subscription: Subscription | None = None
        self.match_publishers()

    @property
    def is_awaited(self) -> bool:
        """Whether a publisher of commands that have stamps has not answered the last scan."""
        stamped = self._subscribed is not None and self._subscribed.kind is not Twist
        return stamped and not self._unstamped and self.awaited is not None

    @property
    def has_publisher(self) -> bool:
        """Whether a publisher of commands is matched."""
        return self._subscription is not None and self._subscription.get_publisher_count() > 0

    def expect_answer(self, stamp: int) -> None:
        """
        Expect a command that answers a scan, where a publisher is matched that may send it.

        What a controller sends before it is matched is lost, and nobody waits for it.

        :param stamp: of the scan [ns]
        """
        if self.has_publisher:
            self.awaited = stamp

    def match_new_publishers(self) -> bool:
        """
        Subscribe as publishers publish, where their number has changed.

        rclpy 7 (Jazzy) does not tell of changes of the graph. A count takes 2 µs, a look at the
        publishers 11 µs and 25 µs for each; a count does not see that one has replaced another.

        :return: whether that is another subscription than before
        """
        return self._count_publishers() != self._count and self.match_publishers()

    def _count_publishers(self) -> int:
        # `Node.count_publishers` expands and validates the name each time, for twice as long.
        with self._node.handle:
            return int(self._node.handle.get_count_publishers(self._resolved))

    def match_publishers(self) -> bool:
        """
        Subscribe as publishers publish; called now and then, as they come and go.

        :return: whether that is another subscription than before
        """
        count = self._count_publishers()
        publishers = self._node.get_publishers_info_by_topic(self.topic)
        wanted, ignored = self._types.choose(publishers)
        changed = wanted != self._subscribed
        if changed:
            before = self._subscribed
            self.close()
            # A process has one type for a topic: the executor drops the subscription only after
            # this, so that one of another type is for the next look.
            if wanted is not None and (before is None or wanted.kind is before.kind):
                ignored = self._subscribe(wanted) or ignored
        if ignored and ignored != self._ignored:
            self._refuse(BadProperty(ignored, field='cmd_vel'), self.topic)
        self._ignored = ignored
        self._count = count if self._subscribed == wanted else None
        return changed

    def _subscribe(self, wanted: Choice) -> Text:
        """Subscribe to messages of a type; return why that cannot be, `NOTHING` where it can."""
        qos = QoSProfile(depth=_DEPTH, reliability=wanted.reliability)
        receive = partial(self._receive, wanted.kind)
        refusals: list[Refusal] = []
        with refusing_another_type(self.topic, lambda refusal, _: refusals.append(refusal)):
            self._subscription = self._node.create_subscription(
                wanted.kind, self.topic, receive, qos, raw=True
            )
            self._subscribed = wanted
        return refusals[0].text if refusals else NOTHING

    def take(self) -> DriveRobot | None:
        """
        Return the request of the last command since the last call; None where none came.

        :raises Malformed: it cannot be decoded, or is not finite
        :raises BadProperty: it is faster than anything may be
        """
        last, self._last = self._last, None
        if last is None:
            return None
        kind, data = last
        message = decoded(data, kind, MOST_BYTES)
        request = DriveRobot(name=self._body, velocity=self._velocity_of(message))
        self.velocity = request.velocity
        return request

    def _velocity_of(self, message: Any) -> Velocity:
        """Return the velocity that a message commands [m/s, rad/s]."""
        if isinstance(message, Twist | TwistStamped):
            twist = message if isinstance(message, Twist) else message.twist
            return twist.linear.x, twist.linear.y, twist.angular.z
        car, speed, angle = self._drive, message.drive.speed, message.drive.steering_angle
        assert isinstance(car, Car)  # noqa: S101 - others do not subscribe to it
        # A bicycle: the angle is that of a front wheel in the middle.
        angle = max(-car.steering, min(angle, car.steering)) if math.isfinite(angle) else angle
        return speed, 0.0, speed * math.tan(angle) / car.wheelbase

    def close(self) -> None:
        """Unsubscribe."""
        self._subscribed, self._unstamped, self.awaited = None, False, None
        if self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
            self._subscription = None

    def _receive(self, kind: type, data: bytes) -> None:
        self._last = kind, data
        self._types.note_message()
        if kind is not Twist:
            with suppress(Malformed):
                message = decoded(data, kind, MOST_BYTES)
                stamp = Time.from_msg(message.header.stamp).nanoseconds
                self._unstamped = stamp == 0
                if self.awaited is not None and stamp >= self.awaited:
                    self.awaited = None


def ackermann_type() -> type | None:
    """Return the type of commands of cars; None where its package is not installed."""
    try:
        from ackermann_msgs.msg import (  # noqa: PLC0415 - no part of common_interfaces
            AckermannDriveStamped,
        )
    except ModuleNotFoundError:
        return None
    kind: type = AckermannDriveStamped
    return kind
