# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Sensors of distances: at equal angles, the nearest one in a cone, or of landmarks.

Their messages are `sensor_msgs/LaserScan`, `sensor_msgs/Range` and `geometry_msgs/PoseArray`.
"""

from dataclasses import dataclass
import math
from typing import Annotated, ClassVar

from physsim_ros.model.checks import ListOf, Numbers, OneOf, text, Whole, Within
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.robots.sensors.sensor import (
    angles,
    DISTANCE,
    distances,
    LEAST_INCREMENT,
    Sensor,
)
from physsim_ros.model.texts import Words
from physsim_ros.model.transform import Point

# Greatest number of beams: ten times as many as real scanners have; some 3 ms a scan.
MOST_BEAMS = 10_000
# Greatest number of blind sectors of a laser, and of bodies that are landmarks.
_MOST_SECTORS, _MOST_LANDMARKS = 64, 1000
# Spans that differ from a full turn by less are one [rad]: 6.2832, but not the 6.28 of 360 beams
# with a gap.
_FULL = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Laser(Sensor):
    """
    A laser scanner: distances along beams at equal angles.

    :raises BadProperty: beams are closer than LEAST_INCREMENT
    """

    KIND: ClassVar = 'laser'
    KIND_WORDS: ClassVar = Words('lidar', 'scan', 'scanner', 'laser_scan')

    name: str = 'scan'
    beams: Annotated[int, Whole(1, MOST_BEAMS), 'number of beams'] = 360
    angle: Annotated[
        Point,
        angles,
        'angles of the first and the last beam, counter-clockwise, at most a full turn apart '
        '[rad]; in a full turn, the last beam is an increment before the first',
    ] = (0.0, math.tau)
    range: Annotated[  # noqa: A003 - a word of the interface
        Point, distances, 'least and greatest distance: nearer is -inf, further +inf (REP 117) [m]'
    ] = (0.1, 10.0)
    noise: Annotated[float, DISTANCE, 'standard deviation of a distance'] = 0.0
    blind: Annotated[
        tuple[Point, ...],
        ListOf(angles, 'pairs of angles', _MOST_SECTORS),
        'sectors hidden by a mast or a cover, a list of `[first, last]` angles [rad]; their beams '
        'are NaN (REP 117)',
    ] = ()

    def __post_init__(self) -> None:
        # `super()` without arguments has no class there: a dataclass with slots is made anew.
        Sensor.__post_init__(self)
        if self.beams > 1 and self.increment < LEAST_INCREMENT:
            raise BadProperty(
                '{beams} beams in {angle:g} rad are too close',
                field='angle',
                beams=self.beams,
                angle=self.angle[1] - self.angle[0],
            )

    @property
    def increment(self) -> float:
        """Return the angle from a beam to the next [rad]; 0 for a single one."""
        first, last = self.angle
        if self.beams == 1:
            return 0.0
        if abs(last - first - math.tau) < _FULL:
            return math.tau / self.beams
        return (last - first) / (self.beams - 1)


# Greatest opening of a cone [rad]: half a turn.
_WIDEST = 3.1416
# Greatest number of rays in a cone.
_MOST_RAYS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class RangeFinder(Sensor):
    """
    A range finder, infrared or ultrasonic: the nearest distance in a cone.

    :raises BadProperty: rays are closer than LEAST_INCREMENT
    """

    KIND: ClassVar = 'range'
    KIND_WORDS: ClassVar = Words(
        'sonar', 'ultrasonic', 'ultrasound', 'infrared', 'distance', 'proximity'
    )

    name: str = 'range'
    radiation: Annotated[str, OneOf(('infrared', 'sonar')), 'kind of waves that it emits'] = (
        'infrared'
    )
    cone: Annotated[
        float, Within(0.0, _WIDEST, 'rad'), 'opening of the cone; 0 is a single ray'
    ] = 0.2
    rays: Annotated[
        int,
        Whole(1, _MOST_RAYS),
        'number of rays at equal angles in the cone, of which the nearest counts',
    ] = 15
    range: Annotated[  # noqa: A003 - a word of the interface
        Point, distances, 'least and greatest distance, as for a laser [m]'
    ] = (0.02, 1.0)
    noise: Annotated[float, DISTANCE, 'standard deviation of a distance'] = 0.0

    def __post_init__(self) -> None:
        # `super()` without arguments has no class there: a dataclass with slots is made anew.
        Sensor.__post_init__(self)
        if 0.0 < self.cone < LEAST_INCREMENT * (self.rays - 1):
            template = '{rays} rays in a cone of {cone:g} rad are too close'
            raise BadProperty(template, field='cone', rays=self.rays, cone=self.cone)


@dataclass(frozen=True, slots=True, kw_only=True)
class Landmarks(Sensor):
    """
    A finder of landmarks: range and bearing of bodies that it knows by their names.

    It sees a body whose origin is in its field of view, where nothing hides all of that body on
    the line of sight.
    """

    KIND: ClassVar = 'landmarks'
    KIND_WORDS: ClassVar = Words('beacons', 'fiducials', 'markers', 'apriltag', 'aruco')

    name: str = 'landmarks'
    bodies: Annotated[
        tuple[str, ...],
        ListOf(text, 'names', _MOST_LANDMARKS),
        'names of the bodies that are landmarks, in the order of the message',
    ] = ()
    angle: Annotated[Point, angles, 'its field of view, as of a laser [rad]'] = (
        -math.pi,
        math.pi,
    )
    range: Annotated[  # noqa: A003 - a word of the interface
        Point, distances, 'least and greatest distance that it measures [m]'
    ] = (0.0, 10.0)
    noise: Annotated[
        Point,
        Numbers((DISTANCE, Within(0.0, math.pi, 'rad'))),
        'standard deviations of range [m] and bearing [rad]',
    ] = (0.0, 0.0)
