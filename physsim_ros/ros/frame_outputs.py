# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The outputs of the node: the topics, the viewer and the sketchpad, each with frames and answers.

Law: an answer that a frame carries is published with it, every other one by `report_answers`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
import time
from typing import Any

from physsim_ros.drawing import DrawingSession
from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.model.timeline import TimelineStatus
from physsim_ros.ros.publishers.frame_statistics import FrameStatistics
from physsim_ros.ros.publishers.publishers import Publishers
from physsim_ros.sketchpad import Sketchpad
from physsim_ros.view import FrameContext, Viewer, ViewerMode
from rclpy.node import Node

# Least time from one logged refusal to the next [s]. The throttling of rclpy (7.1.6) inspects the
# call stack for each message, logged or not, which takes 0.5 ms.
_WARNING_PERIOD = 1.0


class FrameOutputs:
    """
    The outputs of the node.

    :param node: that owns the publishers
    :param values: of the parameters of the node, by name, always up to date
    :param session: the drawing session, whose preview is added to each frame
    :param boundary: of each output

    :ivar topics: the publishers of the world
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
        boundary: ErrorBoundary,
    ) -> None:
        self.topics = Publishers(
            node,
            boundary,
            frame_id=values['frame_id'],
            map_resolution=lambda: values['map_resolution'],
            publish_tf=values['publish_tf'],
        )
        self.viewer = Viewer(boundary, context=self._context)
        self.sketchpad: Sketchpad | None = None
        self.statistics = FrameStatistics()
        self.frame: Frame | None = None
        self.records_contacts = False
        self._node = node
        self._values = values
        self._session = session
        self._boundary = boundary
        # Whether the last frame is one of the past.
        self._in_past = False
        self.update_clock()
        # Steady time from which on a refusal is logged again [s].
        self._warning_due = 0.0

    @property
    def wants_contacts(self) -> bool:
        """Whether a test, a subscriber, the viewer or a page reads contacts."""
        return (
            self.records_contacts
            or self.topics.contacts.subscriptions > 0
            or self.viewer.is_open
            or (self.sketchpad is not None and self.sketchpad.wants_contacts)
        )

    def publish_frame(self, frame: Frame, status: TimelineStatus) -> None:
        """
        Publish a new frame.

        :param status: of the timeline at the frame
        """
        for answer in frame.answers:
            self._log_answer(answer)
        self._in_past = frame.past
        self.update_clock()
        self.topics.publish_frame(frame)
        with self._boundary.output('~/timeline'):
            self.topics.timeline.publish(status, moving=frame.moved)
        self._show(frame)

    def republish(self) -> None:
        """Publish the last frame to late subscribers; called at ticks without a new frame."""
        if self.frame is not None and self.frame.preview != self._session.preview:
            # Only the preview has changed: an unfinished gesture was dropped.
            self._show(replace(self.frame, answers=(), moved=False))
        self.topics.publish_to_late_subscribers()

    def publish_preview(self) -> None:
        """Publish the preview of the session if it has changed."""
        self.topics.publish_preview(self._session.preview)

    def report_answers(self, answers: tuple[Answer, ...]) -> None:
        """Publish and log answers that no frame carries."""
        if answers and self.sketchpad is not None:
            with self._boundary.output('page'):
                self.sketchpad.report(answers)
        for answer in answers:
            self.topics.publish_answer(answer)
            self._log_answer(answer)

    def update_clock(self) -> None:
        """Publish simulation time on `clock` as `publish_clock` and `robots_in_past` say."""
        frozen = self._in_past and self._values['robots_in_past'] == 'freeze'
        self.topics.clock.open = self._values['publish_clock'] and not frozen

    def open_viewer(self) -> None:
        """Open the viewer of parameter `viewer`, in place of the one before."""
        self.viewer.open_viewer(ViewerMode(self._values['viewer']), self._values['viewer_url'])

    def close_sketchpad(self) -> None:
        """Close the sketchpad, if it is served."""
        if self.sketchpad is not None:
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

    def _show(self, frame: Frame) -> None:
        """Send a frame, with the current preview, to viewer and sketchpad."""
        if self._session.preview != frame.preview:
            frame = replace(frame, preview=self._session.preview)
        self.frame = frame
        with self._boundary.output('viewer'):
            self.viewer.show(frame)
        if self.sketchpad is not None:
            with self._boundary.output('page'):
                self.sketchpad.show(frame)

    def _log_answer(self, answer: Answer) -> None:
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
