# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Each kind of joint has its points and properties, and the tables of all kinds agree."""

import math

import numpy as np
from physsim_ros.model.errors import BadProperty, Malformed, UnknownProperty
from physsim_ros.model.joints import DEFAULTS, JOINT_KEYS, JointKind, JointProperties, kind_from
from physsim_ros.model.motor_command import points_from
from physsim_ros.model.names import WORLD
from physsim_ros.model.scene import Joint, Seat
from physsim_ros.model.transform import ORIGIN
import pytest

from ..building import refusal

COMMON = ('max_force', 'break_force', 'collide')


@pytest.mark.parametrize('kind', JointKind)
def test_a_kind_has_one_or_two_points_and_the_properties_of_all_kinds(kind):
    assert kind.points in (1, 2)
    assert kind.phrase == ('an axle' if kind is JointKind.AXLE else f'a {kind}')
    assert kind.schema.properties == (*kind.schema.own, *COMMON)
    assert {*kind.schema.properties} <= {*JointProperties.FIELDS}


def test_every_property_belongs_to_a_kind_and_is_a_key():
    owned = {name for kind in JointKind for name in kind.schema.properties}

    assert owned == {*JointProperties.FIELDS}
    assert ['kind', 'a', 'b', *JointProperties.FIELDS] == [*JOINT_KEYS]


@pytest.mark.parametrize('name', DEFAULTS)
def test_a_default_passes_its_own_check(name):
    properties = JointProperties(**{name: DEFAULTS[name]})

    assert [*properties.explicit()] == [name]
    assert JointProperties(**properties.explicit()) == properties


@pytest.mark.parametrize('kind', JointKind)
def test_a_property_of_another_kind_is_unknown(kind):
    for name in {*JointProperties.FIELDS} - {*kind.schema.properties}:
        value = {'over': ('wheel/0',), 'carrier': 'arm/0'}.get(name, 1.0)
        properties = JointProperties(**{name: value})
        with pytest.raises(UnknownProperty, match=f'{kind.phrase} has no {name}'):
            properties.check_kind(kind)


@pytest.mark.parametrize('word', ['weld', 'PIN', '', None, 1, ['pin']])
def test_a_word_that_is_no_kind_is_bad(word):
    assert refusal(kind_from, word) == (BadProperty, 'kind')


@pytest.mark.parametrize('kind', [kind for kind in JointKind if kind.schema.along_line])
def test_a_force_along_a_line_needs_two_points_and_no_axis(kind):
    assert kind.points == 2
    assert not kind.schema.has_axis


def joint(kind, b, **properties):
    seat = Seat(0.1, 0.2, 1.0, 2.0, 0.6, 0.8, 0.3, 1.5)
    said = JointProperties(**properties)
    return Joint(name='joint/0', kind=kind, a='a/0', b=b, seat=seat, properties=said)


@pytest.mark.parametrize('kind', JointKind)
def test_a_body_at_the_origin_is_as_good_an_end_as_the_world(kind):
    to_body, to_world = joint(kind, 'b/0'), joint(kind, WORLD)
    poses = {'a/0': (3.0, 4.0, 0.5), 'b/0': ORIGIN}

    assert to_world.position(poses) == to_body.position(poses) != 0.0
    assert to_world.drawn_points(poses) == to_body.drawn_points(poses)


@pytest.mark.parametrize('kind', JointKind)
@pytest.mark.parametrize('rate', [None, 2.0])
def test_a_greatest_force_holds_every_joint_but_a_slider_that_a_rate_drives(kind, rate):
    drives = kind is JointKind.SLIDER and rate is not None

    assert joint(kind, WORLD, rate=rate, max_force=3.0).holding_force == (None if drives else 3.0)


@pytest.mark.parametrize(
    ('point', 'error'),
    [([0, 1, 10**400], Malformed), ([0, 1, math.inf], Malformed), ([0, 1, 1e13], BadProperty),
     ([0, 1, 2, 3], Malformed), ([0], Malformed), (None, Malformed)],
)  # fmt: skip
def test_a_point_of_a_trajectory_that_is_none_is_refused(point, error):
    assert refusal(points_from, [point], 'points') == (error, 'points')


def test_a_rate_of_a_trajectory_may_be_absent_or_any_number():
    for rate in ([], [None], [math.nan]):
        assert math.isnan(points_from([[0, 1, *rate]], 'points')[0].rate)
    assert points_from([[0, 1, np.float32(0.5)]], 'points')[0].rate == 0.5
