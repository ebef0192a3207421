# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Satellite navigation: places of the plane on the ellipsoid of WGS 84."""

import math

import numpy as np
from physsim_ros.model.robots.sensors import Gps
from physsim_ros.sensing.gps import fix_of, read_gps
import pytest

from .worlds import add_robot, plane, seen

DATUM = (48.1375, 11.5755)
AXIS, FLATTENING = 6378137.0, 1.0 / 298.257223563


def _on_plane(fix, datum):
    """Return x east, y north and height [m] over the plane at a datum, geocentrically."""

    def geocentric(latitude, longitude, altitude):
        sine, cosine = math.sin(math.radians(latitude)), math.cos(math.radians(latitude))
        square = FLATTENING * (2.0 - FLATTENING)
        radius = AXIS / math.sqrt(1.0 - square * sine**2)
        across = (radius + altitude) * cosine
        angle = math.radians(longitude)
        z = (radius * (1.0 - square) + altitude) * sine
        return np.array([across * math.cos(angle), across * math.sin(angle), z])

    away = geocentric(*fix) - geocentric(*datum, 0.0)
    latitude, longitude = map(math.radians, datum)
    east = np.array([-math.sin(longitude), math.cos(longitude), 0.0])
    up = np.array(
        [
            math.cos(latitude) * math.cos(longitude),
            math.cos(latitude) * math.sin(longitude),
            math.sin(latitude),
        ]
    )
    return [float(away @ axis) for axis in (east, np.cross(up, east), up)]


@pytest.mark.parametrize(
    'datum', [DATUM, (0.0, 0.0), (-33.9, 179.9999), (89.9, -20.0), (90.0, 0.0)]
)
@pytest.mark.parametrize('point', [(0.0, 0.0), (12.5, -7.0), (-900.0, 400.0), (5e3, 2e4)])
def test_a_fix_is_the_place_on_the_plane(datum, point):
    fix = fix_of(point, datum)
    # Geocentric coordinates are rounded to 1e-9 m.
    assert _on_plane(fix, datum) == pytest.approx((*point, 0.0), abs=1e-7)
    assert -180.0 <= fix.longitude <= 180.0


def test_a_degree_of_latitude_at_the_equator_is_as_long_as_tables_say():
    # 110.574 km a degree of latitude, 111.320 km of longitude (Wikipedia: Geographic coordinates).
    assert fix_of((0.0, 110.574), (0.0, 0.0)).latitude == pytest.approx(1e-3, rel=1e-5)
    assert fix_of((111.320, 0.0), (0.0, 0.0)).longitude == pytest.approx(1e-3, rel=1e-5)


def test_a_receiver_reads_where_it_is_mounted_and_without_a_datum_nothing():
    gps = Gps(at=(1.0, 0.5))
    world = plane(datum=DATUM)
    row = add_robot(world, pose=(10.0, 20.0, math.pi / 2))
    assert read_gps(world.snapshot(), row, gps) == fix_of((9.5, 21.0), DATUM)
    world = plane()
    assert read_gps(world.snapshot(), add_robot(world), gps) is None


def test_a_receiver_without_a_fix_reads_nothing():
    world = plane(datum=DATUM)
    row = add_robot(world)
    assert read_gps(world.snapshot(), row, Gps(status='none')) is None
    assert read_gps(world.snapshot(), row, Gps(status='gbas')) == fix_of((0.0, 0.0), DATUM)


def test_noise_is_as_large_as_told_and_repeats():
    world, gps = plane(datum=DATUM), Gps(noise=2.0)
    row = add_robot(world)
    away = []
    for _ in range(400):
        world.step(1)
        snapshot = seen(world, 5)
        fix = read_gps(snapshot, row, gps)
        assert fix == read_gps(snapshot, row, gps)
        away.append(_on_plane(fix, DATUM)[:2])
    # Four standard errors of a standard deviation of 400 numbers.
    assert np.std(away, axis=0) == pytest.approx((2.0, 2.0), rel=4.0 / math.sqrt(800))
