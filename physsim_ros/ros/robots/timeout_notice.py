# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The notice that a robot has stopped since no command came: people expect it to drive on."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from physsim_ros.model.answer import Answer
from physsim_ros.model.transform import REST
from physsim_ros.model.translation import Text
from physsim_ros.ros.robots.messages import StampedFrame
from physsim_ros.ros.robots.robot_topics import RobotTopics


class TimeoutNotice:
    """
    The notice, which is told once by a node.

    :param values: of the parameters of the node, by name, always up to date
    :param tell: reports the answer
    """

    def __init__(self, values: Mapping[str, Any], tell: Callable[[Answer], object]) -> None:
        self._values = values
        self._tell = tell
        self._is_told = False

    def tell_if_stopped(self, robot: RobotTopics, sensed: StampedFrame, row: int) -> None:
        """Tell that the last command of a robot has ended, unless that was to rest."""
        topic, drive = robot.drive_topic, robot.robot.drive
        if self._is_told or topic is None or drive is None or topic.velocity == REST:
            return
        if not _has_stopped(sensed, row):
            return
        self._is_told = True
        asked = self._values['drive_timeout']
        timeout = drive.timeout if asked < 0.0 else asked
        message = Text(
            '{body} has stopped: no command has come for {time:g} s, the timeout of its drive. '
            'Publish commands again and again, or set the parameter drive_timeout to 0',
            body=robot.body,
            time=timeout,
        )
        self._tell(Answer(topic=topic.topic, subject=robot.body, message=message))


def _has_stopped(sensed: StampedFrame, row: int) -> bool:
    """Return whether the command of a robot has ended since the frame before."""
    now, before = sensed.snapshot, sensed.before
    if before is None or before.scene is not now.scene:
        return False
    until = int(now.robots['until'][now.scene.robot_number(row)])
    return before.step < until <= now.step
