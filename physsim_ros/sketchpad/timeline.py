# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The timeline for pages, and the ghost: the bodies of the course that was left last.

Law: the timeline is sent at once where more than its time changes, else each 0.1 s.
"""

from __future__ import annotations

from typing import Any

from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.model.timeline import CourseSpan, TimelineStatus
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad.message import text_content

# Time from one timeline to the next while nothing but its time changes [s].
TIMELINE_PERIOD = 0.1


class TimelineReport:
    """
    The status of the timeline that was sent last, and the course of the ghost.

    :param simulation: of the timeline
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._sent: TimelineStatus | None = None
        self._read_at = 0.0
        # The course that was left last.
        self._beside: CourseSpan | None = None

    def take_status(self, frame: Frame, now: float) -> TimelineStatus | None:
        """
        Return the status with a frame; None where it need not be sent.

        :param now: steady time [s]
        """
        last = self._sent
        # A running world without requests changes nothing but its time.
        runs = frame.passing and not frame.answers
        known = last is not None and last.speed == frame.speed
        if runs and known and now - self._read_at < TIMELINE_PERIOD:
            return None
        status = self.status_to_send(now)
        return None if status == last else status

    def status_to_send(self, now: float) -> TimelineStatus:
        """
        Return the status, to be sent to all pages.

        :param now: steady time [s]
        """
        self._sent = status = self._simulation.status
        self._read_at = now
        self._beside = max(status.courses, key=lambda each: each.number, default=None)
        return status

    def ghost(self, snapshot: Snapshot) -> Snapshot | None:
        """Return the snapshot of the course that was left last at the time of a snapshot."""
        course, seconds = self._beside, snapshot.stamp * 1e-9
        if course is None or not course.begins <= seconds <= course.ends:
            return None
        return self._simulation.past.course_snapshot(course.number, seconds)


def timeline_content(status: TimelineStatus) -> dict[str, Any]:
    """Return the message of a status; times in [s]."""
    return {
        'type': 'timeline',
        'state': status.state,
        'speed': status.speed,
        'oldest': status.oldest,
        'now': status.now,
        'newest': status.newest,
        'course': status.course,
        'line': status.line,
        'parts': status.differs_from,
        'undo': status.undo,
        'redo': status.redo,
        'undo_text': text_content(status.undo),
        'redo_text': text_content(status.redo),
        'courses': [
            {'id': each.number, 'from': each.begins, 'to': each.ends} for each in status.courses
        ],
    }
