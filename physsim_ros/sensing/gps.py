# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The reading of a receiver of satellite navigation, on the ellipsoid of WGS 84.

The plane of the world touches the ellipsoid at the datum, where its origin is; x is east, y is
north (REP 103). A point d away is about d² / 12,742 km above the ellipsoid.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from physsim_ros.model.robots.sensors import Gps
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Point
from physsim_ros.sensing.mounting import placed
from physsim_ros.sensing.sampling import noise_of

# Of WGS 84 (NIMA TR 8350.2): semi-major axis [m], flattening, and the squares of its first and
# second eccentricity.
_AXIS = 6378137.0
_FLATTENING = 1.0 / 298.257223563
_FIRST = _FLATTENING * (2.0 - _FLATTENING)
_SECOND = _FIRST / (1.0 - _FIRST)


class Fix(NamedTuple):
    """
    A place on the earth.

    :ivar latitude: to the north [deg]
    :ivar longitude: to the east [deg], -180 .. 180
    :ivar altitude: above the ellipsoid [m]
    """

    latitude: float
    longitude: float
    altitude: float


def read_gps(snapshot: Snapshot, row: int, gps: Gps) -> Fix | None:
    """
    Return where a receiver is; None in a world without a datum, or without a fix.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    :param gps: on it
    """
    datum = snapshot.scene.settings.datum
    if datum is None or gps.status == 'none':
        return None
    east, north, _ = placed(snapshot, row, gps)
    if gps.noise:
        noise = noise_of(snapshot, row, gps, 2).tolist()
        east, north = east + gps.noise * noise[0], north + gps.noise * noise[1]
    return fix_of((east, north), datum)


def fix_of(point: Point, datum: Point) -> Fix:
    """
    Return the place on the earth of a point of the plane.

    B. R. Bowring, "Transformation from spatial to geographical coordinates", Survey Review 23,
    1976: one iteration from the parametric latitude, exact to 1e-9 m within a thousand kilometres.

    :param point: to the east and to the north of the datum [m]
    :param datum: latitude and longitude [deg]
    """
    latitude, longitude = map(math.radians, datum)
    sine, cosine = math.sin(latitude), math.cos(latitude)
    radius = _AXIS / math.sqrt(1.0 - _FIRST * sine * sine)
    east, north = point
    # From the centre of the earth: across the meridian of the datum, along it, to the pole.
    along = radius * cosine - north * sine
    up = radius * (1.0 - _FIRST) * sine + north * cosine
    flat = math.hypot(along, east)
    parametric = math.atan2(up, (1.0 - _FLATTENING) * flat)
    polar = _AXIS * (1.0 - _FLATTENING)
    found = math.atan2(
        up + _SECOND * polar * math.sin(parametric) ** 3,
        flat - _FIRST * _AXIS * math.cos(parametric) ** 3,
    )
    sine, cosine = math.sin(found), math.cos(found)
    # Valid at the poles, too.
    altitude = flat * cosine + up * sine - _AXIS * math.sqrt(1.0 - _FIRST * sine * sine)
    turned = math.remainder(longitude + math.atan2(east, along), math.tau)
    return Fix(math.degrees(found), math.degrees(turned), altitude)
