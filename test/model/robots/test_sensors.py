# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sensors by their mappings: what is kept, and what is refused by field."""

import math

import numpy as np
from physsim_ros.model.errors import BadProperty, Malformed, UnknownProperty
from physsim_ros.model.robots.sensors import Laser, sensor_from, SENSORS
import pytest

from ...building import refusal

NAN = math.nan


@pytest.mark.parametrize('kind', SENSORS)
def test_a_kind_alone_is_a_sensor_and_is_written_as_it_is_read(kind):
    sensor = sensor_from({'kind': kind}, 'sensors')

    assert type(sensor) is SENSORS[kind]
    assert sensor_from(sensor.entry(), 'sensors') == sensor


def test_every_property_of_a_laser_is_written_as_it_is_read():
    entry = {
        'kind': 'laser',
        'name': 'front/scan',
        'at': [-0.03, 0.5, 3.0],
        'rate': 5.0,
        'link': 'base',
        'latency': [0.01, 0.03],
        'beams': 720,
        'angle': [-2.0, 2.0],
        'range': [0.12, 3.5],
        'noise': 0.01,
    }

    assert sensor_from(entry, 'sensors').entry() == entry


def test_the_last_beam_of_a_full_turn_is_not_the_first():
    whole = sensor_from({'kind': 'laser', 'beams': 360, 'angle': [0, 6.2832]}, 'sensors')
    front = sensor_from({'kind': 'laser', 'beams': 181, 'angle': [-1.0, 1.0]}, 'sensors')
    one = sensor_from({'kind': 'laser', 'beams': 1, 'angle': [0.5, 0.5]}, 'sensors')

    assert whole.increment == math.tau / 360
    assert np.isclose(front.angle[0] + 180 * front.increment, 1.0, rtol=0, atol=1e-12)
    assert one.increment == 0.0


@pytest.mark.parametrize(
    ('entry', 'error', 'field'),
    [
        (None, BadProperty, 'sensors'),
        (['laser'], BadProperty, 'sensors'),
        ({}, BadProperty, 'kind'),
        ({'kind': None}, BadProperty, 'kind'),
        ({'kind': ['laser']}, BadProperty, 'kind'),
        ({'kind': 'lasr'}, BadProperty, 'kind'),
        ({'kind': 'laser', 'bems': 3}, UnknownProperty, 'bems'),
        ({'kind': 'laser', 3: 3}, UnknownProperty, '3'),
        ({'kind': 'laser', 'beams': None}, BadProperty, 'beams'),
        ({'kind': 'laser', 'range': [3.5, 0.12]}, BadProperty, 'range'),
        ({'kind': 'laser', 'range': [1, 1]}, BadProperty, 'range'),
        ({'kind': 'laser', 'range': [-1, 1]}, BadProperty, 'range'),
        ({'kind': 'laser', 'range': [0, math.inf]}, Malformed, 'range'),
        ({'kind': 'laser', 'range': [0, NAN]}, Malformed, 'range'),
        ({'kind': 'laser', 'range': [0, 1, 2]}, Malformed, 'range'),
        ({'kind': 'laser', 'range': 3.5}, BadProperty, 'range'),
        ({'kind': 'laser', 'angle': [0, 7]}, BadProperty, 'angle'),
        ({'kind': 'laser', 'angle': [1, 1]}, BadProperty, 'angle'),
        ({'kind': 'laser', 'angle': [0, 1e-12]}, BadProperty, 'angle'),
        ({'kind': 'laser', 'angle': [2, 1]}, BadProperty, 'angle'),
        ({'kind': 'laser', 'angle': [0, 'all']}, BadProperty, 'angle'),
        ({'kind': 'laser', 'blind': [0, 1]}, BadProperty, 'blind'),
        ({'kind': 'laser', 'blind': [[1, 0]]}, BadProperty, 'blind'),
        ({'kind': 'laser', 'blind': [[0, 7]]}, BadProperty, 'blind'),
        ({'kind': 'laser', 'blind': [[0, 1]] * 65}, BadProperty, 'blind'),
        ({'kind': 'landmarks', 'bodies': 'post/0'}, BadProperty, 'bodies'),
        ({'kind': 'landmarks', 'bodies': [7]}, Malformed, 'bodies'),
        ({'kind': 'landmarks', 'noise': 0.1}, BadProperty, 'noise'),
        ({'kind': 'landmarks', 'noise': [0.1, 4]}, BadProperty, 'noise'),
        ({'kind': 'gps', 'status': 'rtk'}, BadProperty, 'status'),
        ({'kind': 'laser', 'at': [1]}, Malformed, 'at'),
        ({'kind': 'laser', 'at': [1, NAN, 0]}, Malformed, 'at'),
        ({'kind': 'laser', 'at': 'front'}, BadProperty, 'at'),
        ({'kind': 'laser', 'at': [1e9, 0]}, BadProperty, 'at'),
        ({'kind': 'laser', 'name': ''}, BadProperty, 'name'),
        ({'kind': 'laser', 'name': '9lives'}, BadProperty, 'name'),
        ({'kind': 'laser', 'name': '/scan'}, BadProperty, 'name'),
        ({'kind': 'laser', 'name': 'scan\n'}, BadProperty, 'name'),
        ({'kind': 'laser', 'name': 'a' * 300}, BadProperty, 'name'),
        ({'kind': 'laser', 'name': 7}, BadProperty, 'name'),
        ({'kind': 'range', 'radiation': 'radar'}, BadProperty, 'radiation'),
        ({'kind': 'range', 'radiation': ['sonar']}, BadProperty, 'radiation'),
        ({'kind': 'imu', 'noise': 0.1}, BadProperty, 'noise'),
        ({'kind': 'imu', 'noise': [0.1, -1]}, BadProperty, 'noise'),
        ({'kind': 'joint_states', 'noise': 2}, UnknownProperty, 'noise'),
    ],
)
def test_bad_sensors_are_refused_by_field(entry, error, field):
    assert refusal(sensor_from, entry, 'sensors') == (error, field)


def test_a_misspelt_word_is_answered_with_the_nearest():
    with pytest.raises(BadProperty, match="nearest is 'laser'"):
        sensor_from({'kind': 'lasr'}, 'sensors')
    with pytest.raises(UnknownProperty, match="nearest is 'beams'"):
        sensor_from({'kind': 'laser', 'bems': 3}, 'sensors')


def test_a_sensor_that_is_made_is_taken_as_it_is():
    laser = Laser(beams=3)

    assert sensor_from(laser, 'sensors') is laser
