# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
What a node does for its pages, besides requests.

Law: a page can do nothing that a service, a topic or a parameter cannot do; but only people at
pages have names, and an undo of their own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, Protocol

from physsim_ros.drawing import DrawingSettings
from physsim_ros.files import on_thread, state_from
from physsim_ros.model.answer import Answer
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.translation import Text
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.runtime.slices import Sliced
from physsim_ros.simulation.entries import Origin, UNKNOWN, Wait
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import beginning_of


class Loop(Protocol):
    """The loop that applies requests between frames."""

    def bring_up_to_date(self) -> Snapshot:
        """Apply the waiting requests, and return the snapshot that is shown."""

    def make_call(
        self, call: Sliced[Sequence[Answer]], wait: Wait, *, origin: Origin = UNKNOWN
    ) -> None:
        """
        Make a call at its time among the requests, and tell its answers.

        :param origin: the message from which it comes
        :raises Busy: too many requests wait
        """


class TimeControl(Protocol):
    """The control of the time of a world."""

    def set_speed(self, speed: float) -> Text:
        """
        Set the speed [simulation seconds a second], and return a message.

        :raises Refusal: it is out of range
        """

    def submit_seek(self, stamp: int, origin: Origin) -> None:
        """Go to a simulation time [ns], in place of a seek under way; its end is answered."""


class WorldControl(Protocol):
    """
    The control of a world; a returned text is a message about what was done.

    What cannot be done raises a PhysSimError, and nothing has changed.

    :ivar boundary: of the node
    :ivar simulation: the world and its time
    :ivar values: of the parameters of the node, by name, always up to date
    """

    boundary: ErrorBoundary
    simulation: Simulation
    values: Mapping[str, Any]

    @property
    def loop(self) -> Loop:
        """Return the loop of the node."""

    @property
    def time(self) -> TimeControl:
        """Return the control of time."""

    @property
    def services(self) -> Mapping[str, tuple[Sliced[Text], Wait]]:
        """Return the actions of services, and when they are performed, by name."""

    @property
    def drawing_settings(self) -> DrawingSettings:
        """Return the settings of drawing."""

    @property
    def recording_address(self) -> str:
        """Return the address of the viewer's web page on this machine; '' while there is none."""

    @property
    def locked_bodies(self) -> tuple[str, ...]:
        """Return patterns of the names of bodies that pupils do not change."""

    def set_parameter(self, name: str, value: object) -> None:
        """Set a parameter."""

    async def load_world(self, world: str) -> Text:
        """Replace the world by that of a name; time goes on."""

    async def open_world(self, world: str) -> Text:
        """Begin with the world of a name, at time 0; undo reverts it."""

    async def save_world(self, world: str) -> Text:
        """Save the world under a name; time goes on."""


async def open_content(simulation: Simulation, content: Mapping[str, Any]) -> Text:
    """
    Begin with a world at time 0, which undo reverts, and return a message about it.

    :param content: mapping of its file
    :raises Refusal: it is refused
    """
    settings, rate = simulation.settings, simulation.physics_rate
    state = await on_thread(partial(state_from, content, settings, rate))
    return simulation.open_world(await on_thread(partial(beginning_of, state, rate)))
