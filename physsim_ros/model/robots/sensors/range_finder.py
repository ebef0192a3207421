# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A range finder: the least distance within a cone (`sensor_msgs/Range`)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import ClassVar

from physsim_ros.model.checks import Checks, shown, Whole, Within
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.robots.sensors.sensor import distances, LEAST_INCREMENT, LENGTH, Sensor
from physsim_ros.model.transform import Point

# Greatest opening of a cone [rad]: half a turn.
_WIDEST = 3.1416
# Greatest number of rays in a cone.
_MOST_RAYS = 1000


class Radiation(StrEnum):
    """What a range finder measures with."""

    INFRARED = 'infrared'
    SONAR = 'sonar'


def _radiation(value: object, name: str) -> Radiation:
    if not isinstance(value, str) or value not in list(Radiation):
        raise BadProperty(f'{name} is {" or ".join(Radiation)}, not {shown(value)}', field=name)
    return Radiation(value)


@dataclass(frozen=True, slots=True, kw_only=True)
class RangeFinder(Sensor):
    """
    An infrared or ultrasonic range finder.

    :param radiation: infrared or sonar
    :param cone: opening of the cone about its axis [rad]; 0 is a single ray
    :param rays: number of rays at equal angles in the cone, of which the nearest one counts
    :param range: least and greatest distance that it measures [m]
    :param noise: standard deviation of a distance [m]
    :raises BadProperty: rays are closer than LEAST_INCREMENT
    """

    KIND: ClassVar = 'range'
    CHECKS: ClassVar[Checks] = {
        **Sensor.CHECKS,
        'radiation': _radiation,
        'cone': Within(0.0, _WIDEST, 'rad'),
        'rays': Whole(1, _MOST_RAYS),
        'range': distances,
        'noise': LENGTH,
    }

    name: str = 'range'
    radiation: Radiation = Radiation.INFRARED
    cone: float = 0.2
    rays: int = 15
    range: Point = (0.02, 1.0)  # noqa: A003 - a word of the interface
    noise: float = 0.0

    def __post_init__(self) -> None:
        # `super()` without arguments has no class there: a dataclass with slots is made anew.
        Sensor.__post_init__(self)
        if 0.0 < self.cone < LEAST_INCREMENT * (self.rays - 1):
            raise BadProperty(
                f'{self.rays} rays in a cone of {self.cone:g} rad are too close', field='cone'
            )
