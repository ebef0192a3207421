# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.


"""The timeline as a page gets it: at once where something else changes than the time."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from physsim_ros.model.timeline import CourseSpan, TimelineStatus

# From one message to the next while nothing but the time changes [s].
PERIOD = 0.1


class TimelineReport:
    """Chooses which statuses of the timeline are sent."""

    def __init__(self) -> None:
        self._sent: TimelineStatus | None = None
        self._sent_at = 0.0

    def is_due(self, status: TimelineStatus, now: float) -> bool:
        """
        Tell whether a status is to be sent, and take it as sent.

        :param now: steady time [s]
        """
        last = self._sent
        if last == status:
            return False
        if last is not None and status.speed != 0.0 and now - self._sent_at < PERIOD:
            then = replace(status, oldest=last.oldest, now=last.now, newest=last.newest)
            if then == last:
                return False
        self._sent, self._sent_at = status, now
        return True


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
        'undo': status.undo,
        'redo': status.redo,
        'courses': [
            {'id': each.number, 'from': each.begins, 'to': each.ends} for each in status.courses
        ],
    }


def course_beside(status: TimelineStatus) -> CourseSpan | None:
    """Return the course that was left last of those that reach over the time that is shown."""
    beside = [each for each in status.courses if each.begins <= status.now <= each.ends]
    return max(beside, key=lambda each: each.number, default=None)
