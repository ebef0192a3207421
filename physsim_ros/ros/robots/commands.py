# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The commands of robots on their way from topics to requests.

Law: a command that comes while the past is shown is refused, so that a rewind repeats what was
driven.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
import time
from typing import Any

from physsim_ros.model.errors import InPast, Refusal
from physsim_ros.model.requests import DriveRobot
from physsim_ros.ros.robots.command_topic import CommandTopic
from physsim_ros.ros.robots.scene_robots import SceneRobots
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.entries import Origin
from physsim_ros.simulation.request_queue import RequestQueue

# Least time from one match of the publishers on the graph to the next [s].
MATCH_PERIOD = 0.25


class Commands:
    """
    The commands of all robots.

    :param robots: whose topics they come on
    :param values: of the parameters of the node, by name, always up to date
    :param requests: the queue that commands are submitted to
    :param boundary: of the node
    """

    def __init__(
        self,
        robots: SceneRobots,
        values: Mapping[str, Any],
        requests: RequestQueue,
        boundary: ErrorBoundary,
    ) -> None:
        self._robots = robots
        self._values = values
        self._requests = requests
        self._boundary = boundary
        # Steady time of the next match [s].
        self._match_due = 0.0

    def submit(self, *, in_past: bool) -> None:
        """
        Submit the last command of each robot since the last call.

        Of commands that are refused for one reason the first is answered, until commands have
        been carried out for some time.

        :param in_past: whether the past is shown
        """
        if not self._robots.topics:
            return
        self._match_when_due()
        for body, robot in self._robots.topics.items():
            for topic in robot.command_topics:
                self._submit(body, topic, in_past=in_past)

    def _submit(self, body: str, commands: CommandTopic, *, in_past: bool) -> None:
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
                raise InPast(
                    'the past is shown, with the commands of that time; new commands count again '
                    'at its end'
                )
        except Refusal as refusal:
            if commands.note_refused(refusal.code):
                self._requests.refuse(refusal, Origin(topic), subject=body)
        else:
            commands.note_carried_out()
            # Undone together with what was asked before it: nobody undoes a tick.
            self._requests.submit(request, topic=topic, joined=True)

    def _match_when_due(self) -> None:
        now = time.monotonic()
        if now >= self._match_due:
            self._match_due = now + MATCH_PERIOD
            with self._boundary.containing('cmd_vel'):
                self._robots.match_publishers()
