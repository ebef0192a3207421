# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The outputs of the node: a frame goes to each in a list, from one loop.

Law: an answer that a frame carries is published with it, every other one by `report_answers`. An
output that fails leaves out a frame, and the others have it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
import time
from typing import Any, TYPE_CHECKING

from physsim_ros.drawing import DrawingSession
from physsim_ros.model.answer import Answer
from physsim_ros.model.snapshot import Frame
from physsim_ros.ros.frame_statistics import FrameStatistics
from physsim_ros.ros.publishers.publishers import Output, Publishers
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.view import FrameContext, Viewer, ViewerMode
from rclpy.node import Node

if TYPE_CHECKING:
    from physsim_ros.sketchpad import Sketchpad

# Least time from one logged refusal to the next [s]. The throttling of rclpy (7.1.6) inspects the
# call stack for each message, logged or not, which takes 0.5 ms.
_WARNING_PERIOD = 1.0


class Outputs:
    """
    The outputs of the node.

    :param node: that owns the publishers
    :param values: of the parameters of the node, by name, always up to date
    :param session: the drawing session, whose preview is added to each frame
    :param simulation: whose frames are shown
    :param boundary: of each output
    :param parameters: of the node, which mirror the world before others are told of it
    :param robots: the topics of robots

    :ivar publishers: the publishers of the world
    :ivar viewer: of the world
    :ivar sketchpad: of the world; None where it is not served
    :ivar statistics: cost of the frames
    :ivar frame: the last frame that was shown; None before the first
    :ivar records_contacts: whether `frame` has contacts even without subscriber, viewer and page
    """

    def __init__(
        self,
        node: Node,
        values: Mapping[str, Any],
        session: DrawingSession,
        simulation: Simulation,
        boundary: ErrorBoundary,
        *,
        parameters: Output,
        robots: Output,
    ) -> None:
        self.publishers = Publishers(node, values, lambda: simulation.status)
        self.viewer = Viewer(boundary, context=self._context)
        self.sketchpad: Sketchpad | None = None
        self.statistics = FrameStatistics()
        self.frame: Frame | None = None
        self.records_contacts = False
        self._log = _Log(node)
        # In the order in which they are shown a frame.
        self._all = [parameters, self._log, *self.publishers.outputs, self.viewer, robots]
        self._values = values
        self._session = session
        self._boundary = boundary

    @property
    def is_read(self) -> bool:
        """Whether a subscriber, the viewer, a recording or a page reads each frame."""
        is_shown = self.sketchpad is not None and self.sketchpad.is_read
        return is_shown or self.viewer.is_read or self.publishers.is_read

    @property
    def wants_contacts(self) -> bool:
        """Whether a test, a subscriber, the viewer or a page reads contacts."""
        return (
            self.records_contacts
            or self.publishers.contacts.subscriptions > 0
            or self.viewer.reads_contacts
            or (self.sketchpad is not None and self.sketchpad.wants_contacts)
        )

    def show(self, frame: Frame) -> None:
        """Show a frame."""
        self._show_on(self._all, frame)

    def _show_on(self, outputs: Iterable[Output], frame: Frame) -> None:
        """Show a frame, with the preview of now, on some outputs."""
        if self._session.preview != frame.preview:
            frame = replace(frame, preview=self._session.preview)
        self.frame = frame
        for output in outputs:
            with self._boundary.containing(output.name):
                output.show(frame)

    def show_late(self) -> None:
        """Show the last frame to late subscribers; called at ticks without a new frame."""
        if self.frame is None:
            return
        for output in self.publishers.late:
            with self._boundary.containing(output.name):
                output.show_late(self.frame)

    def report_answers(self, answers: tuple[Answer, ...]) -> None:
        """Publish and log answers that no frame carries."""
        if answers and self.sketchpad is not None:
            with self._boundary.containing('page'):
                self.sketchpad.report(answers)
        for answer in answers:
            with self._boundary.containing('~/events'):
                self.publishers.events.publish(answer)
            self._log.add(answer)
        with self._boundary.containing('~/events'):
            self.publishers.events.flush()

    def show_preview(self) -> None:
        """Show a preview that has changed since the last frame."""
        if self.frame is not None and self.frame.preview != self._session.preview:
            frame = replace(self.frame, answers=(), stepped=False)
            self._show_on((self.publishers.preview, self.viewer), frame)

    def open_viewer(self) -> None:
        """Open the viewer of parameter `viewer`, in place of the one before."""
        self.viewer.open_viewer(ViewerMode(self._values['viewer']), self._values['viewer_url'])

    def open_sketchpad(self, sketchpad: Sketchpad) -> None:
        """Show frames on a sketchpad, the last one at once."""
        self.sketchpad = sketchpad
        self._all.append(sketchpad)
        if self.frame is not None:
            sketchpad.show(replace(self.frame, answers=()))

    def close_sketchpad(self) -> None:
        """Close the sketchpad, if it is served."""
        if self.sketchpad is not None:
            self._all.remove(self.sketchpad)
            self.sketchpad.close()
            self.sketchpad = None

    def close(self) -> None:
        """Close the sketchpad and the viewer."""
        self.close_sketchpad()
        self.viewer.close()

    def _context(self) -> FrameContext:
        """Return the facts about the program that the viewer shows."""
        return FrameContext(
            real_time_factor=self.statistics.real_time_factor,
            title=Path(self._values['world_file']).stem or 'empty world',
        )


class _Log:
    """
    The log of the node, which has refusals, and what a person at the terminal needs.

    :param node: whose log it is
    """

    name = 'log'

    def __init__(self, node: Node) -> None:
        self._node = node
        # Steady time from which on a refusal is logged again [s].
        self._warning_due = 0.0

    def show(self, frame: Frame) -> None:
        """Log the answers of a frame."""
        for answer in frame.answers:
            self.add(answer)

    def add(self, answer: Answer) -> None:
        """Log an answer."""
        if answer.code:
            now = time.monotonic()
            if now < self._warning_due:
                return
            self._warning_due = now + _WARNING_PERIOD
            # The topic of an event without a request is its code, which is named once.
            names = dict.fromkeys((answer.topic, answer.code))
            self._node.get_logger().warning(f'{": ".join(names)}: {answer.message}')
        elif answer.topic == 'viewer':
            # The address of the viewer, for the person at the terminal.
            self._node.get_logger().info(answer.message)
