# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Timeline status: the time that is shown, what can be undone, and the courses that were left."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple


class CourseSpan(NamedTuple):
    """
    A course of events that was left, and can be returned to.

    :ivar number: of the course
    :ivar begins: simulation time from which on it differs from the course in force [s]
    :ivar ends: the last simulation time that it reached [s]
    """

    number: int
    begins: float
    ends: float


@dataclass(frozen=True, slots=True, kw_only=True)
class TimelineStatus:
    """
    The status of the timeline.

    :param state: playing, paused, rewinding, or 'in the past' where something lies ahead
    :param speed: simulation seconds a second; 0 is paused, negative goes back
    :param oldest: the oldest simulation time that can be gone back to [s]
    :param now: simulation time that is shown [s]
    :param newest: the last simulation time that was reached [s]
    :param course: number of the course of events that is in force
    :param line: number of the line of events in force, which undo and redo change, too
    :param parts: simulation time from which on it may differ from the line before [s]
    :param undo: phrase for the gesture that `undo` would undo; '' is none
    :param redo: phrase for the gesture that `redo` would repeat; '' is none
    :param courses: those that were left, in the order of their numbers
    """

    state: str
    speed: float
    oldest: float
    now: float
    newest: float
    course: int
    line: int
    parts: float
    undo: str = ''
    redo: str = ''
    courses: tuple[CourseSpan, ...] = ()
