# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The control of a node, as its services and pages have it.

Law: services, topics, pages and `simulation_interfaces` do it all by this one control. Time is
controlled by `time_control`, and world files by `world_files`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from physsim_ros.drawing import DrawingSettings
from physsim_ros.model.translation import Text
from physsim_ros.ros import parameters
from physsim_ros.ros.frame_loop import FrameLoop
from physsim_ros.ros.live_parameters import LiveParameters
from physsim_ros.ros.outputs import Outputs
from physsim_ros.ros.requests.services import Service
from physsim_ros.ros.time_control import NodeTimeControl
from physsim_ros.ros.world_files import WorldFiles
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.runtime.slices import Slices
from physsim_ros.simulation.simulation import Simulation
from rclpy.parameter import Parameter


class NodeControl:
    """
    The control of a node; a returned text is a message about what was done.

    :param simulation: of the node
    :param time: of the world
    :param services: by their names
    :param loop: of the node, which applies requests
    :param outputs: of the node
    :param files: reads and writes the world
    :param live: the parameters of the node
    :param boundary: of the node

    :ivar values: of the parameters of the node, by name, always up to date
    :ivar on_quit: ends the program, where a service may; None where it has other worlds as well
    """

    def __init__(
        self,
        simulation: Simulation,
        time: NodeTimeControl,
        services: Mapping[str, Service],
        *,
        loop: FrameLoop,
        outputs: Outputs,
        files: WorldFiles,
        live: LiveParameters,
        boundary: ErrorBoundary,
    ) -> None:
        self.boundary = boundary
        self.simulation = simulation
        self.time = time
        self.services = services
        self.values: Mapping[str, Any] = live.values
        self.on_quit: Callable[[], object] | None = None
        self._is_quitting = False
        self.loop = loop
        self._outputs = outputs
        self.files = files
        self._live = live
        # The world whose bodies are locked: the one that was loaded last when they were.
        self._locked_in = simulation.loaded.world

    # Values

    @property
    def drawing_settings(self) -> DrawingSettings:
        """Return the settings of drawing."""
        return parameters.drawing_settings(self.values)

    @property
    def recording_address(self) -> str:
        """Return the address of the viewer's web page on this machine; '' while there is none."""
        return self._outputs.viewer.page_address

    @property
    def locked_bodies(self) -> tuple[str, ...]:
        """Return patterns of the names of bodies that pupils do not change, in this world."""
        if self._locked_in is not self.simulation.loaded.world:
            return ()
        return parameters.listed_names(self.values['sketchpad_locked'])

    def note_locked(self) -> None:
        """Note that `sketchpad_locked` is about the world of now."""
        self._locked_in = self.simulation.loaded.world

    def set_parameter(self, name: str, value: Any) -> None:
        """
        Set a parameter.

        :raises Refusal: it is refused
        """
        self._live.set_together([Parameter(name, value=value)])

    # World files

    async def load_world(self, world: str) -> Text:
        """
        Replace the world by that of a name; time goes on.

        :raises PhysSimError: it is refused, and nothing has changed
        """
        return await self._with_file(world, self.files.load(world))

    async def open_world(self, world: str) -> Text:
        """
        Begin with the world of a name, at time 0; undo reverts it.

        :raises PhysSimError: it is refused, and nothing has changed
        """
        return await self._with_file(world, self.files.open_world(world))

    async def save_world(self, world: str) -> Text:
        """
        Save the world under a name; time goes on.

        :raises PhysSimError: it is refused, and nothing has changed
        """
        return await self._with_file(world, self.files.save(world))

    async def _with_file(self, world: str, work: Slices[Text]) -> Text:
        """Carry out work on the world of a name, and have parameter `world_file` name it then."""
        message = await work
        self.set_parameter('world_file', world)
        return message

    def note_change(self) -> None:
        """Have the parameters mirror the world, and a short seek be done at once."""
        self._live.mirror_world()
        self.loop.finish_short_seek()

    # The end of the program

    def end_program(self) -> bool:
        """Have the next tick end the program; return whether it may."""
        self._is_quitting = self.on_quit is not None
        return self._is_quitting

    def quit_if_asked(self) -> None:
        """End the program where that was asked for; called at each tick."""
        if self._is_quitting and self.on_quit is not None:
            self._is_quitting = False
            self.on_quit()
