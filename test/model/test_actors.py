# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Actors as values: their mappings are read and written, and wrong ones refused."""

import itertools
import math

from physsim_ros.model.actors import actor_from
from physsim_ros.model.errors import Refusal
import pytest

SQUARE = [[0, 0], [2, 0], [2, 1], [0, 1]]
PATH = {'kind': 'path', 'points': SQUARE, 'speed': 0.5}
ORCA = {'kind': 'orca', 'points': SQUARE}


@pytest.mark.parametrize(
    'entry',
    [
        PATH,
        {**PATH, 'repeat': 'loop', 'start': {'gate': 'door', 'by': 'tb3/0', 'time': 1}},
        {'kind': 'path', 'points': [[0, 0, 0], [1, 0, 1.5]], 'times': [0, 2.5]},
        {'kind': 'social_force', 'points': [[1, 1]], 'speed': 1.0, 'sight': 1.0},
        {**ORCA, 'horizon': 3, 'start': {'near': 'tb3/0', 'distance': 2}},
    ],
)
def test_an_actor_is_what_its_entry_says(entry):
    actor = actor_from(entry, 'actor')
    assert actor_from(actor.entry(), 'actor') == actor
    assert actor.entry()['kind'] == entry['kind']


def test_a_loop_at_one_speed_comes_back_to_its_first_point():
    loop = actor_from({**PATH, 'repeat': 'loop'}, 'actor')
    assert loop.track == [
        (0.0, 0.0, 0.0, 0.0),
        (4.0, 2.0, 0.0, 0.0),
        (6.0, 2.0, 1.0, 0.0),
        (10.0, 0.0, 1.0, 0.0),
        (12.0, 0.0, 0.0, 0.0),
    ]


@pytest.mark.parametrize(
    ('points', 'times'),
    [
        ([[0, 0], [1, 0], [1, 1e-17], [2, 0]], [0, 1, 2]),
        ([[0, 0], [0, 0], [1, 0], [1, 0]], [0, 1]),
        ([[0, 0], [0, 0]], [0]),
        # A way that is lost in the sum of those before it.
        ([[0, 0], [1e7, 0], [0, 0], [1e-9, 0]], [0, 1e7, 2e7]),
        ([[0, 0, 1], [1, 0, 1], [1, 0, 1]], [0, 1]),
    ],
)
def test_points_of_a_path_at_one_place_are_one_point(points, times):
    path = actor_from({'kind': 'path', 'points': points, 'speed': 1}, 'actor')
    assert [time for time, *_ in path.track] == times
    assert path.entry()['points'] == points


@pytest.mark.parametrize('yaw', [False, True])
@pytest.mark.parametrize('speed', [1e-3, 0.5, 1e5])
def test_a_circle_that_closes_is_a_path(speed, yaw):
    for corners, radius in itertools.product(range(3, 174), (1e-3, 1.0, 1e4)):
        angles = [2 * math.pi * k / corners for k in range(corners + 1)]
        points = [[radius * math.cos(t), radius * math.sin(t), t][: 2 + yaw] for t in angles]
        if yaw and speed / radius > 1e4:
            continue
        entry = {'kind': 'path', 'points': points, 'speed': speed, 'repeat': 'loop'}
        path = actor_from(entry, 'actor')
        assert len(path.track) == corners + 1


def test_a_loop_turns_back_the_shorter_way():
    points = [[0, 0, 0], [1, 0, 3], [1, 1, 6]]
    loop = actor_from({'kind': 'path', 'points': points, 'speed': 1, 'repeat': 'loop'}, 'actor')
    assert loop.track[-1][3] == pytest.approx(6.283185307179586)


@pytest.mark.parametrize(
    ('wrong', 'code', 'field'),
    [
        ('path', 'bad_property', 'actor'),
        ({'points': SQUARE}, 'bad_property', 'kind'),
        ({'kind': 'pth', 'points': SQUARE}, 'bad_property', 'kind'),
        ({'kind': 'path'}, 'bad_property', 'points'),
        ({'kind': 'orca', 'points': [[0, 0]], 'max_speed': 1.0}, 'bad_property', 'max_speed'),
        ({'kind': 'path', 'points': []}, 'bad_property', 'points'),
        ({'kind': 'path', 'points': SQUARE}, 'bad_property', 'times'),
        ({**PATH, 'points': 3}, 'bad_property', 'points'),
        ({**PATH, 'points': [[0, 0], [1]]}, 'malformed', 'points'),
        ({**PATH, 'points': [[0, 0], [1, 2, 3]]}, 'malformed', 'points'),
        ({**PATH, 'points': [[0, 0], [float('nan'), 2]]}, 'malformed', 'points'),
        ({**PATH, 'points': [[0, 0], [1e9, 2]]}, 'bad_property', 'points'),
        ({**PATH, 'points': [[0, 0, 0], [0, 0, 1]]}, 'bad_property', 'points'),
        ({**PATH, 'points': [[0, 0, 0], [1e-11, 0, 1]]}, 'bad_property', 'points'),
        (
            {'kind': 'path', 'points': [[0, 0], [9, 0]], 'times': [0, 1e-5]},
            'bad_property',
            'times',
        ),
        (
            {'kind': 'path', 'points': [[0, 0], [1, 0]], 'times': [0, 5e-324]},
            'bad_property',
            'times',
        ),
        (
            {
                'kind': 'path',
                'points': [[0, 0, 0], [0, 0, 3]],
                'times': [9, math.nextafter(9, 10)],
            },
            'bad_property',
            'times',
        ),
        ({**PATH, 'points': [[0, 0]] * 1001}, 'bad_property', 'points'),
        ({**PATH, 'times': [0, 1, 2, 3]}, 'bad_property', 'times'),
        ({'kind': 'path', 'points': SQUARE, 'times': [0, 1, 2]}, 'malformed', 'times'),
        ({'kind': 'path', 'points': SQUARE, 'times': [0, 1, 1, 2]}, 'bad_property', 'times'),
        ({'kind': 'path', 'points': SQUARE, 'times': [-1, 1, 2, 3]}, 'bad_property', 'times'),
        ({**PATH, 'repeat': 'twice'}, 'bad_property', 'repeat'),
        ({**PATH, 'start': 3}, 'bad_property', 'start'),
        ({**PATH, 'start': {'gate': ''}}, 'bad_property', 'gate'),
        ({**PATH, 'start': {'by': 'a'}}, 'bad_property', 'by'),
        ({**PATH, 'start': {'near': 'a'}}, 'bad_property', 'distance'),
        ({**PATH, 'start': {'distance': 1}}, 'bad_property', 'near'),
        ({**PATH, 'start': {'gate': 'a', 'near': 'a', 'distance': 1}}, 'bad_property', 'gate'),
        ({**PATH, 'start': {'gat': 'a'}}, 'unknown_property', 'gat'),
        ({**ORCA, 'points': [[0, 0, 0]]}, 'malformed', 'points'),
        ({**ORCA, 'sight': 1}, 'unknown_property', 'sight'),
    ],
)
def test_an_actor_that_cannot_be_is_refused(wrong, code, field):
    with pytest.raises(Refusal) as caught:
        actor_from(wrong, 'actor')
    assert (caught.value.code, caught.value.field) == (code, field)


def test_an_actor_waits_for_a_body_by_any_spelling_of_its_name():
    composed, decomposed = 'caf\u00e9/0', 'cafe\u0301/0'
    actor = actor_from({**PATH, 'start': {'gate': decomposed, 'by': decomposed}}, 'actor')

    assert actor.start.bodies == {'gate': composed, 'by': composed}
