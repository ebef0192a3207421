# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The pages of the node: the sketchpad is served while parameter `sketchpad` says so.

Law: a value of the parameter that cannot have its effect is refused before it is set.
"""

from __future__ import annotations

import sys

from physsim_ros.model.errors import BadProperty, PhysSimError
from physsim_ros.model.translation import verbatim
from physsim_ros.ros import parameters
from physsim_ros.ros.frame_loop import FrameLoop
from physsim_ros.ros.live_parameters import LiveParameters
from physsim_ros.ros.node_control import NodeControl
from physsim_ros.ros.outputs import Outputs
from rclpy.node import Node


class Pages:
    """
    The pages of a node.

    :param node: whose executor handles their messages before the node has started
    :param outputs: of the node; they have the sketchpad while it is served
    :param control: the actions of the node that pages use
    :param loop: of the node; once it has started, its ticks handle the messages
    :param live: the parameters of the node; those of the page are checked and take effect here
    :raises BadProperty: the page is to be served, and cannot listen; or a parameter of the page is
        out of range
    """

    def __init__(
        self,
        node: Node,
        outputs: Outputs,
        control: NodeControl,
        loop: FrameLoop,
        live: LiveParameters,
    ) -> None:
        self._node = node
        self._outputs = outputs
        self._control = control
        self._loop = loop
        live.prepare['sketchpad_locked'] = self.check_locks
        # The last one: what it has opened stays open.
        live.prepare['sketchpad'] = self.open_for
        live.effects['sketchpad'] = self.update
        live.effects['sketchpad_locked'] = control.note_locked
        self.check_locks(control.values['sketchpad_locked'])
        self.open_for(control.values['sketchpad'])
        self.update()

    def open_for(self, value: str) -> None:
        """
        Serve the sketchpad if a value of its parameter, which is not set yet, asks for it.

        :raises BadProperty: it cannot listen
        """
        if value != 'serve' or self._outputs.sketchpad is not None:
            return
        # A node without a page starts without a web server, in a tenth less time.
        from physsim_ros.sketchpad import Sketchpad  # noqa: PLC0415 - see above

        values = self._control.values
        try:
            sketchpad = Sketchpad(
                self._control,
                directory=self._control.files.directory,
                lessons=self._control.files.lessons,
                address=values['sketchpad_address'],
                port=values['sketchpad_port'],
                wake=self._wake,
            )
        except PhysSimError as error:
            raise BadProperty(verbatim(str(error)), field='sketchpad') from error
        self._outputs.open_sketchpad(sketchpad)
        if self._loop.started:
            self.print_addresses()

    @staticmethod
    def check_locks(value: str) -> None:
        """
        Check the value of `sketchpad_locked`.

        :raises BadProperty: it has too many patterns
        """
        if names := parameters.listed_names(value):
            from physsim_ros.sketchpad import locks_of  # noqa: PLC0415 - see `open_for`

            try:
                locks_of(names)
            except BadProperty as refusal:
                field = 'sketchpad_locked'
                raise BadProperty(
                    '{field}: {refusal}', field=field, refusal=refusal.text
                ) from refusal

    def update(self) -> None:
        """Close the sketchpad, or show the world on it, as its parameter says."""
        if self._control.values['sketchpad'] != 'serve':
            self._outputs.close_sketchpad()
        elif self._outputs.frame is None:
            # A page shows the world before its time has begun.
            self._loop.apply_requests()

    def print_addresses(self) -> None:
        """Print the addresses of the page, for the person at the terminal."""
        if (sketchpad := self._outputs.sketchpad) is None:
            return
        from physsim_ros.sketchpad import Role  # noqa: PLC0415 - see `open_for`

        with self._control.boundary.containing('sketchpad'):
            sys.stdout.write(
                '\n'
                '  The page is at\n\n'
                f'      {sketchpad.url()}\n\n'
                f'  and for those who only watch: {sketchpad.url(Role.VIEW)}\n'
                f'  and for a teacher:            {sketchpad.url(Role.TEACH)}\n\n'
            )
            sys.stdout.flush()

    def _wake(self) -> None:
        """Queue the handling of messages; called on another thread."""
        executor = self._node.executor
        # A started node handles them at its next tick.
        if not self._loop.started and executor is not None:
            executor.create_task(self._handle_now)

    def _handle_now(self) -> None:
        self._loop.handle_messages()
        self._loop.apply_requests()
