# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0


"""The interface of the node to pages, apart from requests of the world."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Protocol

from physsim_ros.drawing import DrawingSettings
from physsim_ros.model.snapshot import Answer, Snapshot
from physsim_ros.simulation.deferred_calls import Wait
from physsim_ros.simulation.simulation import Simulation


class WorldControl(Protocol):
    """The actions of a node that its pages ask for."""

    @property
    def simulation(self) -> Simulation:
        """Return the world and its time."""

    @property
    def drawing_settings(self) -> DrawingSettings:
        """Return the settings of drawing."""

    def current_snapshot(self) -> Snapshot:
        """Apply the waiting requests, and return the snapshot that is shown."""

    def wait_of(self, action: str) -> Wait:
        """Return the time at which the action of a service may come."""

    def submit_call(self, call: Callable[[], Iterable[Answer]], wait: Wait) -> None:
        """
        Call something when it may come, and tell its answers.

        :param wait: time at which it may come
        :raises Busy: too many requests wait
        """

    def perform(self, action: str, world: str) -> str:
        """
        Perform what a service does, and return a message about it.

        :param action: name of the service
        :param world: name of the world to save or load; '' is that of parameter `world_file`
        :raises PhysSimError: it is refused
        """

    def world_text(self, *, longest: int) -> str:
        """
        Return the world as the text of a world file.

        :param longest: greatest length [characters]
        :raises WorldFull: it is longer
        """

    def replace_world(self, content: Mapping[Any, Any]) -> str:
        """
        Replace the world by that of a file, and return a message about it.

        :param content: of the file
        :raises Refusal: it is refused
        """

    def set_speed(self, speed: float) -> str:
        """
        Set the speed of time, and return a message about it.

        :raises Refusal: it is out of range
        """

    def seek(self, stamp: int) -> str:
        """
        Go to a simulation time [ns], and return a message about it.

        :raises Refusal: it is not in the history
        """
