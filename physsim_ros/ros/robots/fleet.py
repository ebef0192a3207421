# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The fleet: all robots of the world, whose topics come and go with their bodies.

Laws: a command that comes while the past is shown is refused, so that a rewind repeats what was
driven. Topics of many robots that come or go at once take a second: they are made and taken back
in slices, and time waits for them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
import itertools
import math
import time
from typing import Any

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import InPast, Refusal
from physsim_ros.model.requests import DriveRobot
from physsim_ros.model.robots import Robot
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.ros.robots.command_topic import CommandTopic
from physsim_ros.ros.robots.drive_topic import DriveTopic
from physsim_ros.ros.robots.frames import RobotTf
from physsim_ros.ros.robots.lockstep import Lockstep
from physsim_ros.ros.robots.messages import StampedFrame
from physsim_ros.ros.robots.robot_topics import RobotTopics
from physsim_ros.ros.robots.timeout_notice import TimeoutNotice
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.entries import Origin
from physsim_ros.simulation.past import Past
from physsim_ros.simulation.request_queue import RequestQueue
from rclpy.node import Node

# Time that a frame has for the topics of robots that have come or gone [ns]: four have theirs with
# their first frame.
_MOST_UPDATE_NS = 20_000_000
# Least time from one match of the publishers on the graph to the next [s].
MATCH_PERIOD = 0.25
_IN_PAST = 'the past is shown, with the commands of that time; new commands count again at its end'


class Fleet:
    """
    The robots of the world.

    :param node: that owns their topics
    :param values: of the parameters of the node, by name, always up to date
    :param requests: the queue that commands are submitted to
    :param past: whose cached frames have what was on its way at a moment of it
    :param boundary: of the node
    :param expected: type of commands that is subscribed to while nobody publishes, so that
        `cmd_vel` is listed; None is none, where the process has other nodes: it takes one type for
        a topic

    :ivar name: of the output
    :ivar robots: topics of each, by the name of its body, in the order of the scene
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
        self.robots: dict[str, RobotTopics] = {}
        self.lockstep = Lockstep(values, lambda: self._drive_topics)
        self.sensed: StampedFrame | None = None
        self._node = node
        self._values = values
        self._requests = requests
        self._past = past
        self._boundary = boundary
        self._expected = expected
        self._scene: Scene | None = None
        # The rest of the work after which the topics are those of the robots of that scene.
        self._updating: Iterator[None] = iter(())
        # Beams and angles that the parameters set for all lasers.
        self._lasers: dict[str, Any] = {}
        # Steady time of the next match [s].
        self._match_due = 0.0
        # Whether time went back at the last frame: messages are on their way that are of before.
        self._went_back = False
        self._timeout_notice = TimeoutNotice(values, self._tell_timeout)

    @property
    def is_read(self) -> bool:
        """Whether there are robots, whose sensors compare each frame with the one before."""
        return bool(self.robots)

    @property
    def wants_contacts(self) -> bool:
        """Whether a bumper has subscribers."""
        return any(robot.wants_contacts for robot in self.robots.values())

    # Commands

    def submit_commands(self, *, in_past: bool) -> None:
        """
        Submit the last command of each robot since the last call.

        Of commands that are refused for one reason the first is answered, until commands have
        been carried out for some time.

        :param in_past: whether the past is shown
        """
        if not self.robots:
            return
        self._match_when_due()
        for body, robot in self.robots.items():
            for topic in robot.command_topics:
                self._submit_command(body, topic, in_past=in_past)

    def _submit_command(self, body: str, commands: CommandTopic, *, in_past: bool) -> None:
        topic = commands.topic
        try:
            with self._boundary.message(topic):
                request = commands.take()
            if request is None:
                return
            timeout = self._values['drive_timeout']
            if isinstance(request, DriveRobot) and timeout >= 0.0:
                request = replace(request, timeout=timeout)
            if in_past:
                raise InPast(_IN_PAST)
        except Refusal as refusal:
            if commands.note_refused(refusal.code):
                self._refuse(body, refusal, topic)
        else:
            commands.note_carried_out()
            # Undone together with what was asked before it: nobody undoes a tick.
            self._requests.submit(request, topic=topic, joined=True)

    @property
    def _drive_topics(self) -> list[DriveTopic]:
        """Return the topics of the robots that have a drive."""
        topics = (each.drive_topic for each in self.robots.values())
        return [each for each in topics if each is not None]

    def match_publishers(self) -> bool:
        """Subscribe to commands as they are published now; return whether anything is new."""
        new = [topic.match_publishers() for topic in self._drive_topics]
        return any(new)

    def match_new_publishers(self) -> bool:
        """Subscribe to topics with more or fewer publishers; return whether anything is new."""
        new = [topic.match_new_publishers() for topic in self._drive_topics]
        return any(new)

    def _match_when_due(self) -> None:
        now = time.monotonic()
        if now >= self._match_due:
            self._match_due = now + MATCH_PERIOD
            with self._boundary.containing('cmd_vel'):
                self.match_publishers()

    def _refuse(self, body: str, refusal: Refusal, topic: str) -> None:
        self._requests.refuse(refusal, Origin(topic), subject=body)

    # Frames

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
        self._match_scene(snapshot.scene)
        self._went_back |= goes_back
        if stands or frozen or not self.robots:
            return
        if self._went_back and not goes_back:
            self._send_again(frame, before)
            self._went_back = False
        self.lockstep.note_frame()
        for row in snapshot.scene.robot_rows.tolist():
            robot = self.robots.get(snapshot.scene.names[row])
            with self._boundary.containing('robots'):
                if robot is None:
                    continue
                scanned = robot.publish(sensed, row)
                if scanned is not None and robot.drive_topic is not None:
                    robot.drive_topic.expect_answer(scanned)
                self._timeout_notice.tell_if_stopped(robot, sensed, row)

    def _send_again(self, frame: Frame, last: Snapshot | None) -> None:
        """Send the messages that were on their way at a snapshot from which time goes on again."""
        longest = max(robot.longest_latency for robot in self.robots.values())
        if last is None or longest == 0.0:
            return
        step, stamp = frame.snapshot.step - last.step, frame.snapshot.stamp - last.stamp
        begin = last.step - math.ceil(longest * 1e9 * step / stamp)
        frames = self._past.frames.frames_after(begin - 1, last.step)
        seen: dict[str, list[tuple[StampedFrame, int]]] = {name: [] for name in self.robots}
        for (before, _), (snapshot, contacts) in itertools.pairwise(frames):
            sensed = StampedFrame(replace(frame, snapshot=snapshot, contacts=contacts), before)
            for row in snapshot.scene.robot_rows.tolist():
                seen.get(snapshot.scene.names[row], []).append((sensed, row))
        for name, robot in self.robots.items():
            with self._boundary.containing('robots'):
                robot.send_again(seen[name], last.stamp)

    def _tell_timeout(self, answer: Answer) -> None:
        self._node.get_logger().warning(answer.message)
        self._requests.tell(answer)

    def update_topics(self, is_overdue: Callable[[], bool] = lambda: False) -> bool:
        """
        Go on to make the topics of robots that have come, and to take those of others back.

        :param is_overdue: whether the rest is left for another call; asked after each robot
        :return: whether all is done
        """
        return not any(is_overdue() for _ in self._updating)

    def _match_scene(self, scene: Scene) -> None:
        """Begin to have the topics of a scene, with lasers as the parameters are now."""
        lasers = self._laser_changes
        if scene is not self._scene or lasers != self._lasers:
            self._scene, self._lasers = scene, lasers
            self._updating = self._slices_of_update(scene)
        began = time.perf_counter_ns()
        self.update_topics(lambda: time.perf_counter_ns() - began > _MOST_UPDATE_NS)

    def _slices_of_update(self, scene: Scene) -> Iterator[None]:
        """Take topics of robots that have gone back, and make new ones; yield after each robot."""
        bodies = [scene.bodies[row] for row in scene.robot_rows.tolist()]
        there = {body.name: body.robot for body in bodies}
        for name, topics in [*self.robots.items()]:
            if (topics.robot, topics.lasers) != (there.get(name), self._lasers):
                with self._boundary.containing('robots'):
                    self.robots.pop(name).close()
                yield
        for body, robot in zip(bodies, scene.robots, strict=True):
            with self._boundary.containing('robots'):
                if body.name not in self.robots:
                    self.robots[body.name] = self._make(body.name, robot)
                self.robots[body.name].describe(body, scene)
            yield
        self.robots = {name: self.robots[name] for name in there if name in self.robots}

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
