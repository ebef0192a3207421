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
    'a property of another kind': ({'stiffness': 3.0}, 'unknown_property', 'stiffness'),
    'a limit that is no number': ({'lower': math.inf}, 'malformed', 'lower'),
    'limits crossed': ({'lower': 2.0, 'upper': 1.0}, 'bad_property', 'lower'),
    'a ratio of nothing': ({'kind': 'gear', 'ratio': 0.0}, 'bad_property', 'ratio'),
    'a negative stiffness': (
        {'kind': 'spring', 'points': [(0.4, 0.0), (1.0, 0.0)], 'stiffness': -1.0},
        'bad_property',
        'stiffness',
    ),
    'a negative force': ({'break_force': -1.0}, 'bad_property', 'break_force'),
    'a word for a flag': ({'collide': 'yes'}, 'bad_property', 'collide'),
}


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
