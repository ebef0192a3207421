# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The fleet: all robots of the world, whose topics come and go with their bodies.

Laws: a command that comes while the past is shown is refused, so that a rewind repeats what was
driven; with `lockstep` the world waits for the commands that answer a scan, so that a controller
in another process acts at the same simulation time in every run.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
import time
from typing import Any

from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.errors import InPast, Refusal
from physsim_ros.model.robots import Robot
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Frame
from physsim_ros.ros.robots.frames import RobotTf
from physsim_ros.ros.robots.messages import StampedView
from physsim_ros.ros.robots.robot_topics import RobotTopics
from physsim_ros.simulation.request_queue import RequestQueue
from rclpy.node import Node

# Least time from one look at the types of publishers on the graph to the next [s].
_LOOK_PERIOD = 0.25
_IN_PAST = 'the past is shown, with the commands of that time; new commands count again at its end'


class Fleet:
    """
    The robots of the world.

    :param node: that owns their topics
    :param values: of the parameters of the node, by name, always up to date
    :param requests: the queue that commands are submitted to
    :param boundary: of the node

    :ivar name: of the output
    :ivar robots: topics of each, by the name of its body, in the order of the scene
    :ivar view: the last frame, as the sensors of all robots see it; None before the first
    """

    name = 'robots'

    def __init__(
        self,
        node: Node,
        values: Mapping[str, Any],
        requests: RequestQueue,
        boundary: ErrorBoundary,
    ) -> None:
        self.robots: dict[str, RobotTopics] = {}
        self._node = node
        self._values = values
        self._requests = requests
        self._boundary = boundary
        self._scene: Scene | None = None
        self.view: StampedView | None = None
        self._look_due = 0.0
        # Steady time since which a command is waited for [s]; None is none.
        self._waiting_since: float | None = None

    def wants_contacts(self) -> bool:
        """Return whether a bumper has subscribers."""
        return any(robot.wants_contacts() for robot in self.robots.values())

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
        self._look_at_graph()
        for body, robot in self.robots.items():
            commands, topic = robot.commands, robot.commands.topic
            try:
                with self._boundary.message('cmd_vel'):
                    request = commands.take()
                if request is None:
                    continue
                if in_past:
                    raise InPast(_IN_PAST)
            except Refusal as refusal:
                if commands.note_refused(refusal.code):
                    self._requests.refuse(refusal, topic=topic, subject=body, joined=True)
            else:
                commands.note_carried_out()
                # Undone together with what was asked before it: nobody undoes a tick.
                self._requests.submit(request, topic=topic, joined=True)

    def match_publishers(self) -> bool:
        """Subscribe to commands as they are published now; return whether anything is new."""
        new = [robot.commands.match_publishers() for robot in self.robots.values()]
        return any(new)

    def match_new_publishers(self) -> bool:
        """Do the same where the number of publishers has changed."""
        new = [robot.commands.match_new_publishers() for robot in self.robots.values()]
        return any(new)

    def _look_at_graph(self) -> None:
        now = time.monotonic()
        if now >= self._look_due:
            self._look_due = now + _LOOK_PERIOD
            with self._boundary.output('cmd_vel'):
                self.match_publishers()

    def _refuse(self, body: str, refusal: Refusal, topic: str) -> None:
        self._requests.refuse(refusal, topic=topic, subject=body, joined=True)

    @property
    def in_lockstep(self) -> bool:
        """Whether time goes on by single publish periods, each of which robots may answer."""
        return bool(self._values['lockstep'] and self.robots)

    @property
    def is_waiting(self) -> bool:
        """
        Whether the world waits for the commands that answer the last scans (`lockstep`).

        Only robots whose commands are stamped are waited for, and no longer than `lockstep` by
        the wall from the first time it is asked; then no answer to these scans is expected.
        """
        longest = self._values['lockstep']
        if not longest or not any(each.commands.is_awaited for each in self.robots.values()):
            self._waiting_since = None
            return False
        now = time.monotonic()
        if self._waiting_since is None:
            self._waiting_since = now
        if now < self._waiting_since + longest:
            return True
        self._expect_no_answers()
        return False

    def _expect_no_answers(self) -> None:
        """End the wait for commands that answer the scans up to now."""
        self._waiting_since = None
        for robot in self.robots.values():
            robot.commands.awaited = None

    # Frames

    def show(self, frame: Frame) -> None:
        """Publish what is due at a frame, after topics have come and gone with its scene."""
        snapshot, last = frame.snapshot, self.view
        stands = last is not None and last.snapshot.stamp == snapshot.stamp
        before = None
        if last is not None:
            before = last.before if stands else last.snapshot
        self.view = view = StampedView(frame, before)
        frozen = frame.past and self._values['robots_in_past'] == 'freeze'
        if frozen or (before is not None and snapshot.stamp < before.stamp):
            # The scan that was to be answered is of a time that is not shown.
            self._expect_no_answers()
        if snapshot.scene is not self._scene:
            self._scene = snapshot.scene
            self._update(snapshot.scene)
        if stands or frozen or not self.robots:
            return
        self._waiting_since = None
        for number, row in enumerate(snapshot.scene.robot_rows.tolist()):
            robot = self.robots.get(snapshot.scene.names[row])
            with self._boundary.output('robots'):
                if robot is not None and robot.publish(view, row, number):
                    robot.commands.awaited = snapshot.stamp

    def _update(self, scene: Scene) -> None:
        """Make topics for robots that have come, and take those of others back."""
        names = (scene.names[row] for row in scene.robot_rows.tolist())
        there = dict(zip(names, scene.robots, strict=True))
        for body in [*self.robots]:
            if self.robots[body].robot != there.get(body):
                self.robots.pop(body).close()
        before, self.robots = self.robots, {}
        # In the order of the scene.
        for body, robot in there.items():
            with self._boundary.output('robots'):
                self.robots[body] = before.get(body) or self._make(body, robot)

    def _make(self, body: str, robot: Robot) -> RobotTopics:
        return RobotTopics(
            self._node,
            body,
            robot,
            robot_tf=RobotTf(self._values['robot_tf']),
            world_frame=self._values['frame_id'],
            refuse=partial(self._refuse, body),
        )
