# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The node as the pages of the sketchpad use it: services, speed, time, and worlds by name.

Law: a page can do nothing that a service, a topic or a parameter cannot.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from physsim_ros.drawing import DrawingSettings
from physsim_ros.files import state_from, text_of
from physsim_ros.model.errors import BadWorldFile, PhysSimError
from physsim_ros.model.snapshot import Answer, Snapshot
from physsim_ros.ros import parameters
from physsim_ros.ros.requests.services import Service
from physsim_ros.ros.time_control import TimeControl
from physsim_ros.simulation.deferred_calls import Wait
from physsim_ros.simulation.simulation import Simulation
from rclpy.parameter import Parameter

SetParameters = Callable[[list[Parameter]], object]


class PageControl:
    """
    The node, as its pages use it (`sketchpad.WorldControl`).

    :param simulation: of the node
    :param values: of the parameters, by name, always up to date
    :param time_control: of the node
    :param services: by name
    :param submit_call: calls something when it may come, and tells its answers
    :param set_parameters: sets parameters of the node
    :param current_snapshot: applies the waiting requests, and returns the snapshot that is shown
    """

    def __init__(
        self,
        *,
        simulation: Simulation,
        values: Mapping[str, Any],
        time_control: TimeControl,
        services: Mapping[str, Service],
        submit_call: Callable[[Callable[[], Iterable[Answer]], Wait], None],
        set_parameters: SetParameters,
        current_snapshot: Callable[[], Snapshot],
    ) -> None:
        self.simulation = simulation
        self.current_snapshot = current_snapshot
        self._values = values
        self._time_control = time_control
        self._services = services
        self.submit_call = submit_call
        self._set_parameters = set_parameters

    @property
    def drawing_settings(self) -> DrawingSettings:
        """Return the settings of drawing."""
        return parameters.drawing_settings(self._values)

    def wait_of(self, action: str) -> Wait:
        """Return the time at which the action of a service may come."""
        return self._services[action].wait

    def perform(self, action: str, world: str) -> str:
        """
        Perform the action of a service, and return its message.

        :raises PhysSimError: it is refused
        """
        before = self._values['world_file']
        if world:
            if action not in ('load_world', 'save_world'):
                raise BadWorldFile(f'~/{action} takes no world', field='world')
            self._set_parameters([Parameter('world_file', value=world)])
        try:
            return self._services[action].perform()
        except PhysSimError:
            if world:
                self._set_parameters([Parameter('world_file', value=before)])
            raise

    def world_text(self, *, longest: int) -> str:
        """
        Return the world as the text of a world file.

        :param longest: greatest length [characters]
        :raises WorldFull: it is longer
        """
        simulation = self.simulation
        return text_of(simulation.save(), simulation.physics_rate, longest=longest)

    def replace_world(self, content: Mapping[Any, Any]) -> str:
        """
        Replace the world by that of a file, and return a message about it.

        :param content: of the file
        :raises Refusal: it is refused
        """
        simulation = self.simulation
        return simulation.load(state_from(content, simulation.settings, simulation.physics_rate))

    def set_speed(self, speed: float) -> str:
        """
        Set the speed of time, and return a message about it.

        :raises Refusal: it is out of range
        """
        return self._time_control.set_speed(speed)

    def seek(self, stamp: int) -> str:
        """
        Go to a simulation time [ns], and return a message about it.

        :raises Refusal: it is not in the history
        """
        return self._time_control.seek(stamp)
