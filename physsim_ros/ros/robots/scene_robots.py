# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The robots of the scene: their topics come and go with their bodies.

Law: topics of many robots that come or go at once take a second: they are made and taken back in
slices, and time waits for them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
import time
from typing import Any

from physsim_ros.model.errors import Refusal
from physsim_ros.model.robots import Robot
from physsim_ros.model.scene import Scene
from physsim_ros.ros.robots.drive_topic import DriveTopic
from physsim_ros.ros.robots.frames import RobotTf
from physsim_ros.ros.robots.robot_topics import RobotTopics
from physsim_ros.runtime.error_boundary import ErrorBoundary
from rclpy.node import Node

# Time that a frame has for the topics of robots that have come or gone [ns]: four have theirs with
# their first frame.
_MOST_UPDATE_NS = 20_000_000


class SceneRobots:
    """
    The robots of the scene that was shown last, with their topics.

    :param node: that owns the topics
    :param values: of the parameters of the node, by name, always up to date
    :param refuse: refuses what came to a robot, by the name of its body, on a topic
    :param boundary: of the node
    :param expected: type of commands that is subscribed to while nobody publishes, so that
        `cmd_vel` is listed; None is none, where the process has other nodes: it takes one type for
        a topic

    :ivar topics: of each, by the name of its body, in the order of the scene
    """

    def __init__(
        self,
        node: Node,
        values: Mapping[str, Any],
        refuse: Callable[[str, Refusal, str], None],
        boundary: ErrorBoundary,
        expected: type | None,
    ) -> None:
        self.topics: dict[str, RobotTopics] = {}
        self._node = node
        self._values = values
        self._refuse = refuse
        self._boundary = boundary
        self._expected = expected
        self._scene: Scene | None = None
        # The rest of the work after which the topics are those of the robots of that scene.
        self._updating: Iterator[None] = iter(())
        # Beams and angles that the parameters set for all lasers.
        self._lasers: dict[str, Any] = {}

    @property
    def drive_topics(self) -> list[DriveTopic]:
        """Return the topics of the robots that have a drive."""
        topics = (each.drive_topic for each in self.topics.values())
        return [each for each in topics if each is not None]

    def match_publishers(self) -> bool:
        """Subscribe to commands as they are published now; return whether anything is new."""
        new = [topic.match_publishers() for topic in self.drive_topics]
        return any(new)

    def match_new_publishers(self) -> bool:
        """Subscribe to topics with more or fewer publishers; return whether anything is new."""
        new = [topic.match_new_publishers() for topic in self.drive_topics]
        return any(new)

    def match_scene(self, scene: Scene) -> None:
        """Begin to have the topics of a scene, with lasers as the parameters are now."""
        lasers = self._laser_changes
        if scene is not self._scene or lasers != self._lasers:
            self._scene, self._lasers = scene, lasers
            self._updating = self._slices_of_update(scene)
        began = time.perf_counter_ns()
        self.update(lambda: time.perf_counter_ns() - began > _MOST_UPDATE_NS)

    def update(self, is_overdue: Callable[[], bool] = lambda: False) -> bool:
        """
        Go on to make the topics of robots that have come, and to take those of others back.

        :param is_overdue: whether the rest is left for another call; asked after each robot
        :return: whether all is done
        """
        return not any(is_overdue() for _ in self._updating)

    def _slices_of_update(self, scene: Scene) -> Iterator[None]:
        """Take topics of robots that have gone back, and make new ones; yield after each robot."""
        bodies = [scene.bodies[row] for row in scene.robot_rows.tolist()]
        there = {body.name: body.robot for body in bodies}
        for name, topics in [*self.topics.items()]:
            if (topics.robot, topics.lasers) != (there.get(name), self._lasers):
                with self._boundary.containing('robots'):
                    self.topics.pop(name).close()
                yield
        for body, robot in zip(bodies, scene.robots, strict=True):
            with self._boundary.containing('robots'):
                if body.name not in self.topics:
                    self.topics[body.name] = self._make(body.name, robot)
                self.topics[body.name].describe(body, scene)
            yield
        self.topics = {name: self.topics[name] for name in there if name in self.topics}

    @property
    def _laser_changes(self) -> dict[str, Any]:
        """Return the fields of all lasers that parameters set."""
        beams, angle = self._values['laser_beams'], self._values['laser_angle']
        return {
            **({'beams': beams} if beams else {}),
            **({'angle': tuple(angle)} if len(angle) else {}),
        }

    def _make(self, body: str, robot: Robot) -> RobotTopics:
        return RobotTopics(
            self._node,
            body,
            robot,
            robot_tf=RobotTf(self._values['robot_tf']),
            world_frame=self._values['frame_id'],
            refuse=partial(self._refuse, body),
            lasers=self._lasers,
            expected=self._expected,
        )
