# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Joints that are refused, and change nothing."""

import math
from typing import Any

from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import Unjoin
import pytest

from .jointed import pair
from ..building import BOX, join, spawn

ROPE = [(0.4, 0.0), (0.4, 3.0), (0.6, 0.0)]
REFUSED: dict[str, tuple[dict[str, Any], str, str]] = {
    'itself': ({'a': 'a/0', 'b': 'a/0'}, 'bad_property', 'b'),
    'the background first': ({'a': 'world', 'b': 'a/0'}, 'bad_property', 'a'),
    'a missing a': ({'a': 'x/0'}, 'unknown_body', 'a'),
    'a missing b': ({'a': 'a/0', 'b': 'x/0'}, 'unknown_body', 'b'),
    'two anchored bodies': ({'a': 'fix/0', 'b': 'fix/1'}, 'anchored', 'a'),
    'an anchored body and the background': ({'a': 'fix/0', 'b': 'world'}, 'anchored', 'a'),
    'nothing there': ({'points': [(50.0, 50.0)]}, 'nothing_there', 'points'),
    'an unknown frame': ({'frame': 'x/9'}, 'unknown_frame', 'header.frame_id'),
    'a point that is none': ({'points': [(math.nan, 0.0)]}, 'malformed', 'points'),
    'a point too many': ({'points': [(0.4, 0.0), (0.5, 0.0)]}, 'malformed', 'points'),
    'no point': ({'points': []}, 'malformed', 'points'),
    'no name': ({'name': 'joint'}, 'malformed', 'name'),
    'a rod without a length': (
        {'kind': 'rod', 'points': [(0.4, 0.0), (0.4, 0.0)]},
        'bad_size',
        'points',
    ),
    'a property of another kind': ({'rest_length': 3.0}, 'unknown_property', 'rest_length'),
    'a limit that is no number': ({'lower': math.inf}, 'malformed', 'lower'),
    'limits crossed': ({'lower': 2.0, 'upper': 1.0}, 'bad_property', 'lower'),
    'a ratio of nothing': ({'kind': 'gear', 'ratio': 0.0}, 'bad_property', 'ratio'),
    'a rope over a number': (
        {'kind': 'rope', 'points': ROPE, 'over': [3]},
        'bad_property',
        'over',
    ),
    'a rope over one name': (
        {'kind': 'rope', 'points': ROPE, 'over': 'a/0'},
        'bad_property',
        'over',
    ),
    'a rope over what is not there': (
        {'kind': 'rope', 'points': ROPE, 'over': ('wheel/7',)},
        'unknown_body',
        'over',
    ),
    'a rope over more than its points': (
        {'kind': 'rope', 'points': ROPE, 'over': ('a/0', 'world')},
        'bad_property',
        'over',
    ),
    'a rope over less than its points': (
        {'kind': 'rope', 'points': ROPE, 'over': ()},
        'bad_property',
        'over',
    ),
    'a rope of too many points': (
        {'kind': 'rope', 'points': [(0.1 * number, 9.0) for number in range(65)], 'b': 'world'},
        'bad_property',
        'points',
    ),
    'a rope over a point that is none': (
        {'kind': 'rope', 'points': [ROPE[0], (math.nan, 1.0), ROPE[2]]},
        'malformed',
        'points',
    ),
    'a rod over a wheel': ({'kind': 'rod', 'points': ROPE}, 'malformed', 'points'),
    'a spring over a wheel': (
        {'kind': 'spring', 'points': [ROPE[0], ROPE[2]], 'over': ()},
        'unknown_property',
        'over',
    ),
    'a carrier that is no name': ({'kind': 'gear', 'carrier': 3}, 'bad_property', 'carrier'),
    'a carrier that is not there': (
        {'kind': 'gear', 'carrier': 'arm/7'},
        'unknown_body',
        'carrier',
    ),
    'a wheel as its carrier': ({'kind': 'gear', 'carrier': 'a/0'}, 'bad_property', 'carrier'),
    'a ratchet that goes neither way': ({'ratchet': 0.0}, 'bad_property', 'ratchet'),
    'a ratchet that goes twice': ({'ratchet': 2.0}, 'bad_property', 'ratchet'),
    'a ratchet of a word': ({'ratchet': 'left'}, 'bad_property', 'ratchet'),
    'a carrier of an axle': ({'carrier': 'fix/0'}, 'unknown_property', 'carrier'),
    'a negative stiffness': (
        {'kind': 'spring', 'points': [(0.4, 0.0), (1.0, 0.0)], 'stiffness': -1.0},
        'bad_property',
        'stiffness',
    ),
    'a negative torsion spring': ({'stiffness': -1.0}, 'bad_property', 'stiffness'),
    'a torsion spring with no number': ({'rest_angle': math.nan}, 'malformed', 'rest_angle'),
    'a bearing that drives': ({'friction': -0.1}, 'bad_property', 'friction'),
    'a negative force': ({'break_force': -1.0}, 'bad_property', 'break_force'),
    'a word for a flag': ({'collide': 'yes'}, 'bad_property', 'collide'),
}


def test_a_rope_has_at_most_64_points():
    world = pair()
    points = [(0.4, 0.0), *((0.1 * number, 9.0) for number in range(62)), (0.6, 0.0)]
    join(world, 'rope', points, a='a/0', b='world')
    assert len(world.save().joints[0].guides) == 62


@pytest.mark.parametrize(('said', 'code', 'field'), REFUSED.values(), ids=REFUSED.keys())
def test_what_cannot_be_joined_is_refused_and_changes_nothing(said, code, field):
    world = pair()
    spawn(world, 'fix/0', BOX, (20.0, 0.0, 0.0), anchored=True)
    spawn(world, 'fix/1', BOX, (21.0, 0.0, 0.0), anchored=True)
    before = world.digest()
    values = {'kind': 'axle', 'points': [(0.4, 0.0)]} | said
    with pytest.raises(Refusal) as caught:
        join(world, values.pop('kind'), values.pop('points'), **values)
    assert (caught.value.code, caught.value.field) == (code, field)
    assert world.digest() == before


def test_an_unknown_joint_cannot_be_deleted():
    world = pair()
    before = world.digest()
    with pytest.raises(Refusal) as caught:
        world.apply(Unjoin(name='joint/9'))
    assert caught.value.code == 'unknown_joint'
    assert world.digest() == before
