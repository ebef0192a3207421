# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The parameters of a running node.

Laws: a parameter that is set takes effect before the next frame, and is refused if it cannot;
after each frame the parameters equal settings and speed of the world, whichever was changed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

from physsim_ros.drawing import DrawingSession, Tool
from physsim_ros.model.errors import BadProperty, Refusal
from physsim_ros.model.requests import Configure
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.texts import abbreviated, nearest_name
from physsim_ros.model.translation import verbatim
from physsim_ros.ros import parameters
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.simulation import Simulation
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter


class LiveParameters:
    """
    The parameters of a running node.

    :param node: that has declared them
    :param values: of the parameters, by name; updated when one is set
    :param simulation: whose settings, speed and history they are
    :param session: whose settings and tool they are
    :param boundary: of the node

    :ivar name: of the output
    :ivar values: of the parameters, by name
    :ivar effects: called when a parameter has been set, by its name
    :ivar prepare: called in this order with the value that a parameter is to have, by its name, if
        no other check refuses it; raises a Refusal where the value cannot have its effect
    """

    name = 'parameters'

    def __init__(
        self,
        node: Node,
        values: dict[str, Any],
        simulation: Simulation,
        session: DrawingSession,
        boundary: ErrorBoundary,
    ) -> None:
        self.values = values
        self.effects: dict[str, Callable[[], object]] = {
            'speed': self._run_at_speed,
            'history': lambda: simulation.limit_history(values['history']),
            'history_memory': lambda: simulation.limit_memory(values['history_memory']),
        }
        self.prepare: dict[str, Callable[[Any], object]] = {}
        self._node = node
        self._simulation = simulation
        self._session = session
        self._boundary = boundary
        # Why the last parameters were refused; rclpy hands on the text alone.
        self._refusal: Refusal | None = None
        # The settings of the world that the parameters have; None where they may differ.
        self._mirrored: WorldSettings | None = parameters.world_settings(values)
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._note_set)

    def set_together(self, given: Iterable[Parameter]) -> None:
        """
        Set parameters, all or none.

        :raises Refusal: one is refused, which the field of the refusal names where it is about one
        """
        wanted = [parameters.converted(each) for each in given]
        for each in wanted:
            self._check_descriptor(each)
        self._refusal = None
        result = self._node.set_parameters_atomically(wanted)
        if not result.successful:
            raise self._refusal or BadProperty(verbatim(result.reason))

    def _check_descriptor(self, parameter: Parameter) -> None:
        """
        Check what rclpy checks of a parameter, and does not say of which one.

        :raises Refusal: it is not declared, is fixed, or has another type or range
        """
        name = parameter.name
        if not self._node.has_parameter(name):
            nearest = nearest_name(abbreviated(name), parameters.SPECS)
            raise parameters.no_parameter(name, nearest)
        parameters.check(parameter)
        # rclpy 7.1 has no public name for it.
        result = self._node._apply_descriptor(parameter)  # noqa: SLF001
        if not result.successful:
            raise BadProperty(verbatim(result.reason), field=name)

    def show(self, _: Frame) -> None:
        """Set the parameters to the settings and speed of the world at a frame."""
        self.mirror_world()

    def mirror_world(self) -> None:
        """Set the parameters to the settings and speed of the world."""
        settings, mirrored = self._simulation.settings, self._mirrored
        if settings is not mirrored:
            self._mirrored = settings
            if settings != mirrored:
                self._node.set_parameters(parameters.world_parameters(settings))
        if self._simulation.speed != self.values['speed']:
            self._node.set_parameters([Parameter('speed', value=self._simulation.speed)])

    def _check(self, changed: list[Parameter]) -> SetParametersResult:
        try:
            with self._boundary.refusing('parameters'):
                self._check_and_prepare(changed)
        except Refusal as refusal:
            self._refusal = refusal
            return SetParametersResult(successful=False, reason=f'{refusal.code}: {refusal}')
        return SetParametersResult(successful=True)

    def _check_and_prepare(self, changed: list[Parameter]) -> None:
        """
        Check parameters that are to be set, and prepare what takes effect with them.

        :raises Refusal: a value is out of range, or cannot have its effect
        """
        for parameter in changed:
            parameters.check(parameter)
        settings = replace(self._simulation.settings, **parameters.world_changes(changed))
        if settings != self._simulation.settings:
            self._simulation.world.capacity.check_settings(settings)
        values = {parameter.name: parameter.value for parameter in changed}
        parameters.drawing_settings(self.values | values)
        for name, prepare in self.prepare.items():
            if name in values:
                prepare(values[name])

    def _note_set(self, changed: list[Parameter]) -> None:
        with self._boundary.containing('parameters'):
            self._apply(changed)

    def _apply(self, changed: list[Parameter]) -> None:
        for parameter in changed:
            self.values[parameter.name] = parameter.value
        changes = parameters.world_changes(changed)
        settings = self._simulation.settings
        if replace(settings, **changes) != settings:
            self._simulation.perform(Configure(changes=changes))
            # Requests that waited before may have changed other settings.
            self._mirrored = None
        self._session.settings = parameters.drawing_settings(self.values)
        self._session.tool = Tool(self.values['tool'])
        names = {parameter.name for parameter in changed}
        for name, effect in self.effects.items():
            if name in names:
                effect()

    def _run_at_speed(self) -> None:
        if self._simulation.speed != self.values['speed']:
            self._simulation.speed = self.values['speed']
