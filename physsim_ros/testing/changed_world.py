# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world that a test changes: bodies, joints and robots, by the requests of a client."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import count
from typing import Any

from geometry_msgs.msg import PointStamped
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.testing.client import RequestClient
from physsim_ros.testing.observed_world import index_of, ObservedWorld
from physsim_ros.testing.robot import Robot, robot_marker
from physsim_ros.testing.values import refusals_as_refused
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import Marker, MarkerArray


class ChangedWorld(ObservedWorld):
    """
    The state of a world, and the requests that change it; each waits for its answer.

    :param node: that owns the world
    :param client: publishes the requests
    """

    def __init__(self, node: PhysSimNode, client: RequestClient) -> None:
        super().__init__(node)
        self._client = client

    def spawn(self, marker: Marker | MarkerArray) -> str:
        """
        Publish a marker, or an array of markers, and return the name of the (last) body.

        Many bodies are faster in one array: each request makes a frame of all bodies, which takes
        7 µs a body.

        :raises Refused: with the code; of an array, the first refusal
        """
        if isinstance(marker, MarkerArray):
            # An empty array has an answer, too.
            return self._client.request('spawn_array', marker, max(1, len(marker.markers)))
        return self._client.request('spawn', marker)

    def robot(
        self,
        robot: str | Mapping[str, Any],
        *,
        at: Sequence[float] = (0.0, 0.0),
        name: str = '',
        namespace: str | None = None,
    ) -> Robot:
        """
        Spawn a robot, and return it.

        A world that is loaded replaces it, so load first.

        :param robot: name of a shipped one, or a mapping with that as `from` and what is different
        :param at: x, y [m] and, where there are three, yaw [rad]
        :param name: of its body; '' is robot/0, robot/1 and so on
        :param namespace: of its topics; None is its name with _ for /
        :raises Refused: with the code
        :raises ValueError: the name has no number after a slash
        """
        names = self.names
        name = name or next(f'robot/{n}' for n in count() if f'robot/{n}' not in names)
        with refusals_as_refused():
            message = robot_marker(robot, name, at, namespace)
        return Robot(self.node, self._client.request('spawn', message))

    def find_robot(self, name: str) -> Robot:
        """
        Return a robot that is in the world, as one of a world file.

        :param name: of its body
        :raises UnknownName: there is no such robot
        """
        index_of(name, (*self.node.fleet.robots,), 'robot')
        return Robot(self.node, name)

    def anchor(self, point: PointStamped | tuple[float, float]) -> str:
        """
        Anchor the topmost body under a point [m], and return its name.

        :raises Refused: with the code
        """
        return self._client.request('anchor', _stamped(point))

    def release(self, point: PointStamped | tuple[float, float]) -> str:
        """
        Release the topmost body under a point [m], and return its name.

        :raises Refused: with the code
        """
        return self._client.request('release', _stamped(point))

    def join(self, marker: Marker) -> str:
        """
        Join two bodies by a marker, and return the joint's name.

        :raises Refused: with the code
        """
        return self._client.request('join', marker)

    def pin(self, point: PointStamped | tuple[float, float]) -> str:
        """
        Weld the bodies under a point [m] together, and return the joint's name.

        :raises Refused: with the code
        """
        return self._client.request('pin', _stamped(point))

    def axle(self, point: PointStamped | tuple[float, float]) -> str:
        """
        Join the bodies under a point [m] by an axle, and return the joint's name.

        :raises Refused: with the code
        """
        return self._client.request('axle', _stamped(point))

    def command(self, command: MultiDOFJointState) -> str:
        """
        Set poses, twists or wrenches, and return the name of the body where it is only one.

        :raises Refused: with the code
        """
        return self._client.request('command', command)


def _stamped(point: PointStamped | tuple[float, float]) -> PointStamped:
    if not isinstance(point, tuple):
        return point
    message = PointStamped()
    message.point.x, message.point.y = map(float, point)
    return message
