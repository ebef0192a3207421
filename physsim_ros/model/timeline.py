# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Timeline status: the time that is shown, what can be undone, and the courses that were left."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

from physsim_ros.model.translation import Text


class RunState(StrEnum):
    """
    The run state of a world.

    :cvar PAST: it stands or plays where something lies ahead
    """

    PLAYING = 'playing'
    PAUSED = 'paused'
    REWINDING = 'rewinding'
    PAST = 'in the past'

    @classmethod
    def of(cls, speed: float) -> RunState:
        """Return the run state at the newest moment, by the speed."""
        if speed == 0.0:
            return cls.PAUSED
        return cls.PLAYING if speed > 0.0 else cls.REWINDING


def run_state(speed: float) -> Text:
    """Return the word for a speed: paused, playing or rewinding, with its factor if not 1."""
    state = RunState.of(speed)
    if abs(speed) in {0.0, 1.0}:
        return Text(state)
    return Text('{state} at {speed:g}', state=Text(state), speed=abs(speed))


def stamp_of(step: int, physics_rate: float) -> int:
    """
    Return the simulation time of a step [ns].

    :param physics_rate: steps a second of simulation time [Hz]
    """
    return round(step * 1e9 / physics_rate)


def frames_in(seconds: float, publish_rate: float) -> int:
    """
    Return the number of publish periods in a time, at least 1.

    :param publish_rate: frames a second at speed 1 [Hz]
    """
    return max(1, round(seconds * publish_rate))


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

    :param state: of the world, at the moment that is shown
    :param speed: simulation seconds a second; 0 is paused, negative goes back
    :param oldest: the oldest simulation time that can be gone back to [s]
    :param now: simulation time that is shown [s]
    :param newest: the last simulation time that was reached [s]
    :param course: number of the course of events that is in force
    :param line: number of the line of events in force, which undo and redo change, too
    :param differs_from: simulation time from which on it may differ from the line before [s]
    :param undo: phrase for the gesture that `undo` would undo; '' is none
    :param redo: phrase for the gesture that `redo` would repeat; '' is none
    :param courses: those that were left, in the order of their numbers
    """

    state: RunState
    speed: float
    oldest: float
    now: float
    newest: float
    course: int
    line: int
    differs_from: float
    undo: str = ''
    redo: str = ''
    courses: tuple[CourseSpan, ...] = ()
