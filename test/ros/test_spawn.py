# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A marker on `~/spawn`, and each marker of an array, is answered once."""

from __future__ import annotations

from physsim_ros.testing import box, delete, delete_all, marker, PhysSim
from visualization_msgs.msg import Marker, MarkerArray

from ..client import Client, Event


def test_a_marker_is_answered_once(physsim: PhysSim, client: Client) -> None:
    for message, subject, names in (
        (box('/7'), 'body/7', ('body/7',)),
        (box('a/0', at=(3.0, 0.0)), 'a/0', ('body/7', 'a/0')),
        (delete('body/7'), 'body/7', ('a/0',)),
        (delete_all('nobody'), '', ('a/0',)),
        (delete_all('a'), '', ()),
        (delete_all(), '', ()),
    ):
        (event,) = client.ask('~/spawn', message)
        assert event == Event(0, '~/spawn', subject, event.message, 'ok', '')
        assert event.message
        assert physsim.names == names


def test_markers_of_an_array_are_accepted_or_refused_each_by_itself(
    physsim: PhysSim, client: Client
) -> None:
    markers = [
        box('a/0'),
        delete('a/7'),
        box('a/1', size=(0.0, 1.0)),
        box('a/2', at=(3.0, 0.0), frame='a/0'),
        delete('a/0'),
        box('a/3', frame='a/0'),
        marker(Marker.ARROW, 'a/4'),
        box('a/5', at=(9.0, 0.0)),
    ]
    events = client.ask('~/spawn_array', MarkerArray(markers=markers))
    assert physsim.names == ('a/2', 'a/5')
    assert {event.name for event in events} == {'~/spawn_array'}
    answers = [(event.hardware_id, event.code) for event in events]
    assert answers == [
        ('a/0', 'ok'),
        ('a/7', 'unknown_body'),
        ('a/1', 'bad_size'),
        ('a/2', 'ok'),
        ('a/0', 'ok'),
        ('a/3', 'unknown_frame'),
        ('a/4', 'unknown_shape'),
        ('a/5', 'ok'),
    ]
    assert [event.level for event in events] == [0, 2, 2, 0, 0, 2, 2, 0]


def test_an_empty_array_changes_nothing(physsim: PhysSim, client: Client) -> None:
    (event,) = client.ask('~/spawn_array', MarkerArray())
    assert (event.level, event.message) == (0, 'the array is empty')
    assert physsim.names == ()
    assert physsim.spawn(MarkerArray()) == ''
