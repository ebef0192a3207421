# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Odometry of a robot: the pose that it reckons by its wheels and its gyroscope."""

from dataclasses import dataclass
from typing import Annotated

from physsim_ros.model.checks import pair, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.transform import Point

_SLIP = Within(0.0, 1.0)


def _slip(value: object, name: str) -> Point:
    way, heading = pair(value, name)
    return _SLIP(way, name), _SLIP(heading, name)


@dataclass(frozen=True, slots=True, kw_only=True)
class Odometry(Checked):
    """
    Odometry, and its drift.

    Errors are random walks: their variance grows with the way.

    :raises Malformed: a number is not finite
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    rate: Annotated[float, Within(0.01, 1000.0, 'Hz'), 'messages a second'] = 30.0
    slip: Annotated[
        Point,
        _slip,
        'standard deviations of its drift, 0 .. 1: of the way after 1 m [m], of the heading after '
        '1 m or 1 rad [rad]; 0 is exact as long as no wheel slips',
    ] = (0.0, 0.0)

    def entry(self) -> dict[str, object]:
        """Return the mapping that it is made from."""
        return {'rate': self.rate, 'slip': list(self.slip)}
