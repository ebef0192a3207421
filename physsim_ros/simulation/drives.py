# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Commands by which robots drive on, each until another one, or until its robot is gone."""

from __future__ import annotations

from physsim_ros.model.errors import BadProperty, UnknownBody
from physsim_ros.model.requests import DriveRobot
from physsim_ros.simulation.past import Past
from physsim_ros.simulation.playback import Playback
from physsim_ros.simulation.world.robot_requests import is_driving


class Drives:
    """
    The commands by which robots drive on.

    :param past: of the world
    :param playback: the moment that is shown

    :ivar commands: by the names of their bodies
    """

    def __init__(self, past: Past, playback: Playback) -> None:
        self.commands: dict[str, DriveRobot] = {}
        self._past = past
        self._playback = playback

    def drive_on(self) -> None:
        """Have robots obey their commands, unless they do up to the next frame."""
        past = self._past
        for name, drive in [*self.commands.items()]:
            try:
                if not is_driving(self._playback.arrive(), drive, past.frame_steps):
                    # Nobody undoes a tick.
                    past.apply_unasked(drive)
            except (UnknownBody, BadProperty):
                # Its robot is gone, or has no drive any more.
                del self.commands[name]
