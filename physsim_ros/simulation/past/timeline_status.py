# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The status of a timeline: where the world is in its time, and what can be gone back to."""

from __future__ import annotations

from physsim_ros.model.timeline import CourseSpan, TimelineStatus
from physsim_ros.simulation.past.records import Moment
from physsim_ros.simulation.past.undo import Undo


def status_of(undo: Undo, shown: Moment, *, speed: float, dt: float) -> TimelineStatus:
    """
    Return the status of the timeline in force.

    :param undo: that has it
    :param shown: the moment that is shown
    :param speed: simulation seconds a second
    :param dt: of a step [s]
    """
    history, courses = undo.timeline.history, undo.timeline.courses
    if speed < 0.0:
        state = 'rewinding'
    elif shown != history.end:
        state = 'in the past'
    else:
        state = 'playing' if speed else 'paused'
    return TimelineStatus(
        state=state,
        speed=speed,
        oldest=history.oldest * dt,
        now=shown[0] * dt,
        newest=history.head * dt,
        course=courses.current,
        undo=undo.undo_words(shown[1]),
        redo=undo.redo_words,
        courses=tuple(
            CourseSpan(course.number, course.begins[0] * dt, course.tail.head * dt)
            for course in courses.reachable(history)
        ),
    )
