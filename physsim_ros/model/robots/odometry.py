# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Odometry of a robot: the pose that it reckons by its wheels and its gyroscope."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from physsim_ros.model.checks import Checked, Checks, pair, Within
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

    :param rate: messages a second [Hz]
    :param slip: standard deviations of the drift: of the way after 1 m [m], and of the heading
        after 1 m, or after a turn of 1 rad [rad]; 0 is exact as long as no wheel slips
    :raises Malformed: a number is not finite
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    CHECKS: ClassVar[Checks] = {'rate': Within(0.01, 1000.0, 'Hz'), 'slip': _slip}

    rate: float = 30.0
    slip: Point = (0.0, 0.0)

    def entry(self) -> dict[str, object]:
        """Return the mapping that it is made from."""
        return {'rate': self.rate, 'slip': list(self.slip)}
