# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The pages of the node: served as parameter `sketchpad` says.

Law: a value of the parameter that cannot have its effect is refused before it is set.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from physsim_ros.model.errors import BadProperty, PhysSimError
from physsim_ros.ros.frame_outputs import FrameOutputs
from physsim_ros.ros.page_control import PageControl
from rclpy.node import Node


class Pages:
    """
    The pages of a node.

    :param node: whose executor handles their messages before the node has started
    :param outputs: of the node, with the sketchpad
    :param control: of the node, for its pages
    :param world_dir: directory of the user's worlds
    :param apply_requests: applies the waiting requests, and publishes what they changed
    :param is_started: returns whether the node has started: its ticks handle the messages then
    """

    def __init__(
        self,
        node: Node,
        outputs: FrameOutputs,
        control: PageControl,
        *,
        world_dir: Path,
        apply_requests: Callable[[], object],
        is_started: Callable[[], bool],
    ) -> None:
        self._node = node
        self._outputs = outputs
        self._control = control
        self._world_dir = world_dir
        self._apply_requests = apply_requests
        self._is_started = is_started

    def open_for(self, value: str) -> None:
        """
        Open the sketchpad if a value of its parameter, which is not yet set, asks for it.

        :raises BadProperty: it cannot listen
        """
        if value != 'serve' or self._outputs.sketchpad is not None:
            return
        try:
            self._outputs.open_sketchpad(self._control, world_dir=self._world_dir, wake=self._wake)
        except PhysSimError as error:
            raise BadProperty(str(error), field='sketchpad') from error
        if self._is_started():
            self._outputs.print_addresses()

    def update(self, value: str) -> None:
        """Close the sketchpad, or show the world on it, as its parameter says."""
        if value != 'serve':
            self._outputs.close_sketchpad()
        elif self._outputs.frame is None:
            # A page shows the world before its time has begun.
            self._apply_requests()

    def handle_messages(self) -> None:
        """Handle the messages of pages."""
        if self._outputs.sketchpad is not None:
            self._outputs.sketchpad.handle_messages()

    def _wake(self) -> None:
        """Queue the handling of messages; called on the thread of the sketchpad."""
        executor = self._node.executor
        # A started node handles them at its next tick.
        if not self._is_started() and executor is not None:
            executor.create_task(self._handle_now)

    def _handle_now(self) -> None:
        self.handle_messages()
        self._apply_requests()
