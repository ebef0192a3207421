# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The fleet: all robots of the world as an output, whose sensors publish each frame.

Its topics are those of `SceneRobots`; its commands are submitted by `Commands`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
import itertools
import math
from typing import Any

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Refusal
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.ros.robots.commands import Commands
from physsim_ros.ros.robots.lockstep import Lockstep
from physsim_ros.ros.robots.messages import StampedFrame
from physsim_ros.ros.robots.scene_robots import SceneRobots
from physsim_ros.ros.robots.timeout_notice import TimeoutNotice
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.entries import Origin
from physsim_ros.simulation.past import Past
from physsim_ros.simulation.request_queue import RequestQueue
from rclpy.node import Node


class Fleet:
    """
    The robots of the world.

    :param node: that owns their topics
    :param values: of the parameters of the node, by name, always up to date
    :param requests: the queue that commands are submitted to
    :param past: whose cached frames have what was on its way at a moment of it
    :param boundary: of the node
    :param expected: type of commands that is subscribed to while nobody publishes (`SceneRobots`)

    :ivar name: of the output
    :ivar scene_robots: the robots, with their topics
    :ivar commands: of the robots
    :ivar lockstep: the wait for commands that answer scans
    :ivar sensed: the last frame, as the sensors of all robots see it; None before the first
    """

    name = 'robots'

    def __init__(
        self,
        node: Node,
        values: Mapping[str, Any],
        requests: RequestQueue,
        past: Past,
        boundary: ErrorBoundary,
        *,
        expected: type | None = None,
    ) -> None:
        self.scene_robots = SceneRobots(node, values, self._refuse, boundary, expected)
        self.commands = Commands(self.scene_robots, values, requests, boundary)
        self.lockstep = Lockstep(values, lambda: self.scene_robots.drive_topics)
        self.sensed: StampedFrame | None = None
        self._node = node
        self._values = values
        self._requests = requests
        self._past = past
        self._boundary = boundary
        # Whether time went back at the last frame: messages are on their way that are of before.
        self._went_back = False
        self._timeout_notice = TimeoutNotice(values, self._tell_timeout)

    @property
    def is_read(self) -> bool:
        """Whether there are robots, whose sensors compare each frame with the one before."""
        return bool(self.scene_robots.topics)

    @property
    def wants_contacts(self) -> bool:
        """Whether a bumper has subscribers."""
        return any(robot.wants_contacts for robot in self.scene_robots.topics.values())

    def _refuse(self, body: str, refusal: Refusal, topic: str) -> None:
        self._requests.refuse(refusal, Origin(topic), subject=body)

    def show(self, frame: Frame) -> None:
        """Publish what is due at a frame, after topics have come and gone with its scene."""
        snapshot, last = frame.snapshot, self.sensed
        stands = last is not None and last.snapshot.stamp == snapshot.stamp
        before = None
        if last is not None:
            before = last.before if stands else last.snapshot
        self.sensed = sensed = StampedFrame(frame, before)
        frozen = frame.past and self._values['robots_in_past'] == 'freeze'
        goes_back = before is not None and snapshot.stamp < before.stamp
        if frozen or goes_back:
            # The scan that was to be answered is of a time that is not shown.
            self.lockstep.expect_no_answers()
        self.scene_robots.match_scene(snapshot.scene)
        self._went_back |= goes_back
        if stands or frozen or not self.scene_robots.topics:
            return
        if self._went_back and not goes_back:
            self._send_again(frame, before)
            self._went_back = False
        self.lockstep.note_frame()
        for row in snapshot.scene.robot_rows.tolist():
            robot = self.scene_robots.topics.get(snapshot.scene.names[row])
            with self._boundary.containing('robots'):
                if robot is None:
                    continue
                scanned = robot.publish(sensed, row)
                if scanned is not None and robot.drive_topic is not None:
                    robot.drive_topic.expect_answer(scanned)
                self._timeout_notice.tell_if_stopped(robot, sensed, row)

    def _send_again(self, frame: Frame, last: Snapshot | None) -> None:
        """Send the messages that were on their way at a snapshot from which time goes on again."""
        longest = max(robot.longest_latency for robot in self.scene_robots.topics.values())
        if last is None or longest == 0.0:
            return
        step, stamp = frame.snapshot.step - last.step, frame.snapshot.stamp - last.stamp
        begin = last.step - math.ceil(longest * 1e9 * step / stamp)
        frames = self._past.frames.frames_after(begin - 1, last.step)
        seen: dict[str, list[tuple[StampedFrame, int]]] = {
            name: [] for name in self.scene_robots.topics
        }
        for (before, _), (snapshot, contacts) in itertools.pairwise(frames):
            sensed = StampedFrame(replace(frame, snapshot=snapshot, contacts=contacts), before)
            for row in snapshot.scene.robot_rows.tolist():
                seen.get(snapshot.scene.names[row], []).append((sensed, row))
        for name, robot in self.scene_robots.topics.items():
            with self._boundary.containing('robots'):
                robot.send_again(seen[name], last.stamp)

    def _tell_timeout(self, answer: Answer) -> None:
        self._node.get_logger().warning(answer.message)
        self._requests.tell(answer)
