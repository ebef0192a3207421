# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Actors: bodies that move on their own, along a path or as people walk (SDF: actor).

An actor has points of the world and a kind: a path has the times of its points, pedestrians walk
from point to point by a model of how they avoid each other. The core moves them
(`engine/core/actors.c`).
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
import itertools
import math
from typing import Annotated, ClassVar

from physsim_ros.model.checks import (
    check_point,
    check_yaw,
    FASTEST,
    ListOf,
    LONGEST,
    must_be,
    number,
    OneOf,
    Within,
)
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.spelling import canonical
from physsim_ros.model.texts import Words

# Greatest number of points of an actor.
MOST_POINTS = 1000
# Distance [1, of the coordinates and of the path up to there, at least of 1 m] and turn [rad] up
# to which a point of a path is the one before: a circle by sine and cosine closes within these,
# and the times of all other points increase.
_SAME_PLACE, _SAME_YAW = 1e-12, 1e-9
# In the order of `ONCE`, `LOOP`, `TO_AND_FRO` of `engine/core/core.h`.
_REPEATS = ('once', 'loop', 'to_and_fro')
PACE = Within(1e-3, FASTEST, 'm/s')

# x, y [m] of a point, and where a path turns its body, yaw [rad].
Waypoint = tuple[float, ...]


def _name(value: object, name: str) -> str:
    if not isinstance(value, str) or not value:
        raise must_be('the name of a body', value, name)
    return canonical(value)


def _points(value: object, name: str) -> tuple[Waypoint, ...]:
    points: tuple[Waypoint, ...] = ListOf(_point, 'points', MOST_POINTS)(value, name)
    if not points:
        raise BadProperty('{field} is an empty list', field=name)
    if len({len(each) for each in points}) != 1:
        raise Malformed('all {field} are [x, y], or all are [x, y, yaw]', field=name)
    return points


def _point(value: object, name: str) -> Waypoint:
    if not isinstance(value, list | tuple) or len(value) not in (2, 3):
        raise must_be('[x, y] or [x, y, yaw]', value, name, Malformed)
    place = check_point([number(each, name) for each in value[:2]], name)
    return place if len(value) == 2 else (*place, check_yaw(number(value[2], name), name))


def _times(value: object, name: str) -> tuple[float, ...]:
    times = ListOf(Within(0.0, LONGEST, 's'), 'numbers')(value, name)
    if any(after <= before for before, after in itertools.pairwise(times)):
        raise BadProperty('{field} must increase', field=name)
    return times


@dataclass(frozen=True, slots=True, kw_only=True)
class Start(Checked):
    """
    What an actor waits for: a gate, or a distance, or neither; and then a time.

    :raises BadProperty: a value is of the wrong kind or out of range, or does not go with another
    """

    gate: Annotated[
        str | None,
        _name,
        'name of a body; waits until the centre of mass of another body lies in it',
    ] = None
    by: Annotated[
        str | None,
        _name,
        'name of that other body; by default, any body that is neither anchored nor a sensor',
    ] = None
    near: Annotated[
        str | None,
        _name,
        'name of a body; waits until their centres of mass are within `distance`',
    ] = None
    distance: Annotated[
        float | None, Within(0.0, 1e7, 'm'), 'between the centres of mass of `near` and the actor'
    ] = None
    time: Annotated[
        float | None,
        Within(0.0, LONGEST, 's'),
        'delay after that condition, or after the actor was spawned',
    ] = None

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if self.gate is not None and self.near is not None:
            raise BadProperty('an actor waits for a gate or a distance, not both', field='gate')
        if self.by is not None and self.gate is None:
            raise BadProperty('by says who opens a gate, and there is no gate', field='by')
        if (self.near is None) != (self.distance is None):
            lacking = 'near' if self.near is None else 'distance'
            raise BadProperty('near and distance go together', field=lacking)

    @property
    def bodies(self) -> dict[str, str]:
        """Return the names of bodies that it waits for, by field."""
        named = {'gate': self.gate, 'by': self.by, 'near': self.near}
        return {key: name for key, name in named.items() if name is not None}


@dataclass(frozen=True, slots=True, kw_only=True)
class Actor(Checked, ABC):
    """
    What makes a body an actor.

    :raises Malformed: a number is not finite, or a list has the wrong length
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    points: Annotated[
        tuple[Waypoint, ...],
        _points,
        '1 to 1,000: `[x, y]` in the world [m]; of a path also `[x, y, yaw]`',
    ]
    repeat: Annotated[
        str,
        OneOf(_REPEATS),
        'after the last point: `once` it stays, `loop` goes on to the first one, `to_and_fro` '
        'goes back',
    ] = 'once'
    start: Annotated[Start, Start.from_value, 'the condition for its start'] = field(
        default_factory=Start
    )
    traction: Annotated[
        float,
        Within(0.0, 10.0),
        'coefficient of friction with the floor, which moves an actor that is neither kinematic '
        'nor a robot',
    ] = 0.8

    @property
    @abstractmethod
    def track(self) -> list[tuple[float, float, float, float]]:
        """Return its points: time of a path [s], x, y [m], yaw [rad]."""

    @property
    @abstractmethod
    def parameters(self) -> tuple[float, ...]:
        """Return the numbers of its struct in `engine/core/core.h`, in their order."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Path(Actor):
    """
    A path: straight from point to point at given times, or at one speed.

    The body is brought to where the path is at each moment; points with a yaw turn it too. At one
    speed, consecutive points at one place count as one point.
    """

    KIND: ClassVar = 'path'
    KIND_WORDS: ClassVar = Words('trajectory', 'waypoints', 'loop', 'patrol')

    times: Annotated[
        tuple[float, ...] | None,
        _times,
        'times of the points since the start [s], increasing; a `loop` has one more, for its '
        'first point',
    ] = None
    speed: Annotated[float | None, PACE, 'between all points; not together with `times`'] = None

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if (self.times is None) == (self.speed is None):
            raise BadProperty('a path has times or a speed', field='times')
        count = len(self.points) + (self.repeat == 'loop')
        if self.times is not None and len(self.times) != count:
            template = 'times are {found}, and must be {count}: one a point'
            if self.repeat == 'loop':
                template = (
                    'times are {found}, and must be {count}: one a point, the first one twice'
                )
            raise Malformed(template, field='times', found=len(self.times), count=count)
        # Derived now, so that a path that no step can follow is refused as it is made.
        for value, unit in zip(self.parameters, ('m/s', 'rad/s'), strict=False):
            if value > FASTEST:
                raise BadProperty(
                    'the path goes at {value:g} {unit}; at most {most:g} can be simulated',
                    field='points' if self.times is None else 'times',
                    value=value,
                    unit=unit,
                    most=FASTEST,
                )

    def _stations(self) -> list[Waypoint]:
        """Return its points, of a loop the first one again, turned to where the last one looks."""
        first, last = self.points[0], self.points[-1]
        if self.repeat != 'loop':
            return [*self.points]
        yaw = (math.remainder(first[2] - last[2], math.tau) + last[2],) if len(first) == 3 else ()
        return [*self.points, (*first[:2], *yaw)]

    def _timed(self, speed: float) -> Iterator[tuple[float, Waypoint]]:
        """
        Yield the points of a path at one speed, each at a place of its own, with their times [s].

        :raises BadProperty: the path turns at a place
        """
        first, *others = self._stations()
        yield 0.0, first
        length, before = 0.0, first
        for station in others:
            distance = math.dist(before[:2], station[:2])
            if distance > _SAME_PLACE * max(1.0, length, *map(abs, station[:2])):
                length, before = length + distance, station
                yield length / speed, station
            elif any(abs(a - b) > _SAME_YAW for a, b in zip(before[2:], station[2:], strict=True)):
                raise BadProperty('a path that turns at one place needs times', field='points')

    @property
    def track(self) -> list[tuple[float, float, float, float]]:
        """Return its points: time [s], x, y [m], yaw [rad]."""
        timed: Iterable[tuple[float, Waypoint]]
        if self.speed is not None:
            timed = self._timed(self.speed)
        else:
            timed = zip(self.times or (), self._stations(), strict=True)
        return [(time, x, y, yaw[0] if yaw else 0.0) for time, (x, y, *yaw) in timed]

    @property
    def parameters(self) -> tuple[float, ...]:
        """Return its greatest speed [m/s] and turn rate [rad/s], and 1 where it turns its body."""
        speed, turn = self.speed or 0.0, 0.0
        for (before, *a), (after, *b) in itertools.pairwise(self.track):
            lapse = after - before
            if self.speed is None:
                speed = max(speed, math.dist(a[:2], b[:2]) / lapse)
            turn = max(turn, abs(b[2] - a[2]) / lapse)
        return speed, turn, float(len(self.points[0]) == 3)
