# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Commands of a drive: `cmd_vel`, as `Twist`, as `TwistStamped`, or of a car as Ackermann drive.

The type is that of the publisher, as the graph has it. A process takes one type for a topic: where
it has other nodes, nothing is subscribed to before a publisher is there. Of publishers of several
types that of the newest is subscribed to, as long as it publishes: one that died without a
shutdown stays on the graph for some 20 s. Of what comes between two frames the last one counts.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
import math
from time import monotonic
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from physsim_ros.model.errors import BadProperty, Malformed, Refusal
from physsim_ros.model.requests import DriveRobot
from physsim_ros.model.robots import Car, Drive
from physsim_ros.model.transform import REST
from physsim_ros.model.transform import Twist as Velocity
from physsim_ros.ros.robots.command_topic import CommandTopic, MOST_BYTES
from physsim_ros.ros.topics import decoded, of_one_type
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from rclpy.time import Time
from rclpy.topic_endpoint_info import TopicEndpointInfo

# By their names on the graph.
_TYPES = {'geometry_msgs/msg/Twist': Twist, 'geometry_msgs/msg/TwistStamped': TwistStamped}
_ACKERMANN = 'ackermann_msgs/msg/AckermannDriveStamped'
# Type and reliability of a subscription.
_Subscribed = tuple[type, ReliabilityPolicy]
# Of a burst the last ones count.
_DEPTH = 10
# Time without a message of the subscribed type after which another type is subscribed to, where
# there are both [s]: twice the timeout of the shipped drives, in which a command is due. It is
# doubled by each change that brings no command: on a busy machine a publisher takes seconds to
# find a new subscription.
_TIMEOUT, _LONGEST_TIMEOUT = 1.0, 8.0


class DriveTopic(CommandTopic):
    """
    The topic of commands for the drive of a robot.

    :param node: that subscribes
    :param topic: of its commands, below its namespace
    :param body: its name
    :param drive: that obeys them
    :param refuse: reports what publishers are ignored; takes the refusal and the topic
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
        refuse: Callable[[Refusal, str], None],
        *,
        expected: type | None = None,
    ) -> None:
        super().__init__(topic)
        self.velocity: Velocity = REST
        self.awaited: int | None = None
        self._node = node
        self._body = body
        self._drive = drive
        self._expected = expected
        self._types: dict[str, type] = dict(_TYPES)
        if isinstance(drive, Car) and (ackermann := ackermann_type()) is not None:
            self._types[_ACKERMANN] = ackermann
        self._refuse = refuse
        # Why some publishers are ignored; '' where none is.
        self._ignored = ''
        # Whether the last command had a stamp of 0, which is none.
        self._unstamped = False
        # Type that was chosen last, and steady time of that or of the last message [s].
        self._chosen: type | None = None
        self._last_message_at = math.inf
        # Time without a message after which the type changes [s].
        self._timeout = _TIMEOUT
        # Identifiers of the publishers at the last look.
        self._known: set[bytes] = set()
        # Type and bytes of the last command.
        self._last: tuple[type, bytes] | None = None
        # Name of the topic on the graph, and number of its publishers at the last look; None where
        # the look is to be repeated.
        self._resolved = node.resolve_topic_name(topic)
        self._count: int | None = None
        # None while nothing is subscribed to.
        self._subscribed: _Subscribed | None = None
        self._subscription: Subscription | None = None
        self.match_publishers()

    @property
    def is_awaited(self) -> bool:
        """Whether a publisher of commands that have stamps has not answered the last scan."""
        stamped = self._subscribed is not None and self._subscribed[0] is not Twist
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
        wanted, ignored = self._choose(self._node.get_publishers_info_by_topic(self.topic))
        changed = wanted != self._subscribed
        if wanted is not None and wanted[0] is not self._chosen:
            if self._chosen is not None:
                self._timeout = min(2.0 * self._timeout, _LONGEST_TIMEOUT)
            self._chosen, self._last_message_at = wanted[0], monotonic()
        if changed:
            of_other_type = wanted and self._subscribed and wanted[0] is not self._subscribed[0]
            self.close()
            # A process has one type for a topic: the executor drops the subscription only after
            # this, so that one of the other type is for the next look.
            if wanted is not None and not of_other_type:
                ignored = self._subscribe(*wanted) or ignored
        if ignored and ignored != self._ignored:
            self._refuse(BadProperty(ignored, field='cmd_vel'), self.topic)
        self._ignored = ignored
        self._count = count if self._subscribed == wanted else None
        return changed

    def _choose(self, publishers: Sequence[TopicEndpointInfo]) -> tuple[_Subscribed | None, str]:
        """Return the subscription, and why some publishers are ignored; '' where none is."""
        names = {each.topic_type for each in publishers}
        types = [kind for name, kind in self._types.items() if name in names]
        ignored = ''
        if unknown := sorted(names - self._types.keys()):
            words = ' or '.join(kind.__name__ for kind in self._types.values())
            ignored = f'{" and ".join(unknown)} is published; {words} is heard'
        reliable, best_effort = ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT
        if not types:
            return None if self._expected is None else (self._expected, reliable), ignored
        kind = self._choose_type(types, self._take_new_types(publishers))
        if len(types) > 1:
            words = ' and of '.join(sorted(each.__name__ for each in types))
            ignored = f'publishers of {words} are there; the newest is heard, as long as it speaks'
        # Best effort matches publishers of both reliabilities, and may lose a message.
        is_lossy = any(
            each.qos_profile.reliability == best_effort
            for each in publishers
            if each.topic_type in self._types
        )
        return (kind, best_effort if is_lossy else reliable), ignored

    def _take_new_types(self, publishers: Sequence[TopicEndpointInfo]) -> set[type]:
        """Return the types of the publishers that have come since the last call."""
        before = self._known
        self._known = {bytes(each.endpoint_gid) for each in publishers}
        new = (each for each in publishers if bytes(each.endpoint_gid) not in before)
        return {kind for each in new if (kind := self._types.get(each.topic_type)) is not None}

    def _choose_type(self, types: Sequence[type], new: set[type]) -> type:
        """
        Return the type to subscribe to: of a new publisher, else as before, else the next one.

        :param types: that are published
        :param new: of the publishers that have come since the last look
        """
        if self._chosen not in types or (new and self._chosen not in new):
            return next((each for each in types if each in new), types[0])
        is_over = monotonic() > self._last_message_at + self._timeout
        return types[(types.index(self._chosen) + is_over) % len(types)]

    def _subscribe(self, kind: type, reliability: ReliabilityPolicy) -> str:
        """Subscribe to messages of a type; return why that cannot be, '' where it can."""
        qos = QoSProfile(depth=_DEPTH, reliability=reliability)
        receive = partial(self._receive, kind)
        try:
            with of_one_type(self.topic):
                self._subscription = self._node.create_subscription(
                    kind, self.topic, receive, qos, raw=True
                )
        except BadProperty as refusal:
            return str(refusal)
        self._subscribed = kind, reliability
        return ''

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
        self._last, self._last_message_at, self._timeout = (kind, data), monotonic(), _TIMEOUT
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
