# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Strokes on `~/stroke` are answered, whatever comes in them, and quickly."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
import math

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
from physsim_ros.testing import disc, PhysSim
import pytest
from rclpy.parameter import Parameter
from visualization_msgs.msg import Marker, MarkerArray

from ..client import Client, KEPT

Points = Sequence[tuple[float, float]]


def stroke(points: Points, frame: str = '') -> Path:
    message = Path()
    message.header.frame_id = frame
    for x, y in points:
        sample = PoseStamped()
        sample.pose.position.x, sample.pose.position.y = float(x), float(y)
        message.poses.append(sample)
    return message


def circle(x: float, y: float, radius: float, count: int = 60) -> Points:
    angles = [math.tau * number / count for number in range(count + 1)]
    return [(x + radius * math.cos(angle), y + radius * math.sin(angle)) for angle in angles]


def line(start: tuple[float, float], end: tuple[float, float], count: int = 60) -> Points:
    shares = [number / count for number in range(count + 1)]
    return [
        (start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]))
        for share in shares
    ]


def test_a_stroke_becomes_a_body_and_is_told_with_its_confidence(
    client: Client,
) -> None:
    told, spawned = client.ask('~/stroke', stroke(circle(3.0, 2.0, 1.5)))

    assert (told.level, told.name, told.code) == (0, '~/stroke', 'ok')
    assert told.hardware_id == 'drawn/0'
    assert told.values['reading'] == 'disc'
    assert 0.6 <= float(told.values['confidence']) <= 1.0
    assert told.values['requests'] == '1'
    assert (spawned.name, spawned.hardware_id, spawned.code) == ('~/stroke', 'drawn/0', 'ok')
    # m
    assert client.physsim.pose('drawn/0')[:2] == pytest.approx((3.0, 2.0), abs=0.01)


def test_a_reading_is_shown_until_the_next_or_until_a_tool_is_taken(client: Client) -> None:
    pictures = client.listen(MarkerArray, '~/preview', KEPT)
    client.ask('~/stroke', stroke(circle(3.0, 2.0, 1.5)))
    clearing, outline, label = pictures[-1].markers
    assert clearing.action == Marker.DELETEALL
    assert outline.type == Marker.LINE_STRIP
    assert max(point.x for point in outline.points) == pytest.approx(4.5, abs=0.01)
    assert label.text.startswith('disc ')
    client.physsim.node.set_parameters([Parameter('tool', value='wall')])
    client.spin_until(lambda: len(pictures[-1].markers) == 1)


def test_a_stroke_may_be_drawn_in_the_frame_of_a_body(client: Client) -> None:
    client.physsim.spawn(disc('a/0', at=(10.0, 5.0, math.pi / 2)))
    events = client.ask('~/stroke', stroke(circle(3.0, 0.0, 1.0), 'a/0'))
    assert [event.code for event in events] == ['ok', 'ok']
    assert client.physsim.pose('drawn/0')[:2] == pytest.approx((10.0, 8.0), abs=0.01)


def test_a_stroke_sees_what_was_asked_just_before(client: Client) -> None:
    client.publish('~/spawn', disc('a/0', diameter=4.0))
    client.publish('~/stroke', stroke(line((-1.0, 6.0), (1.0, 6.0))))
    events = client.ask('~/stroke', stroke(circle(0.0, 0.0, 1.0)))
    assert events[0].name == '~/spawn'


@pytest.mark.parametrize(
    ('points', 'code', 'field'),
    [
        ([(0, 0)], '', ''),
        ([(0, 0), (math.nan, 1), (2, 2)], 'malformed', ''),
        ([(0.001 * number, 0.0) for number in range(11_000)], 'malformed', 'poses'),
    ],
    ids=['one point', 'nan', 'too long'],
)
def test_what_is_no_stroke_is_refused_with_a_code_and_changes_nothing(
    client: Client, points: Points, code: str, field: str
) -> None:
    client.physsim.spawn(disc('a/0'))
    before = client.physsim.digest()

    (event,) = client.ask('~/stroke', stroke(points))

    assert (event.level, event.name) == (2, '~/stroke')
    assert event.code in ([code] if code else ['bad_size', 'not_recognised', 'bad_property'])
    assert event.message
    assert not field or event.field == field
    assert client.physsim.digest() == before


def test_an_unknown_frame_is_refused(client: Client) -> None:
    (event,) = client.ask('~/stroke', stroke(circle(0, 0, 1), 'nobody/0'))
    assert (event.code, event.field) == ('unknown_frame', 'header.frame_id')


def test_below_the_confidence_that_is_asked_for_nothing_is_built(
    client: Client, physsim: PhysSim
) -> None:
    pictures = client.listen(MarkerArray, '~/preview', KEPT)
    physsim.node.set_parameters([Parameter('sketch_confidence', value=1.0)])
    before = physsim.digest()
    (event,) = client.ask('~/stroke', stroke(circle(0, 0, 1)))
    assert event.code == 'not_recognised'
    assert 'disc' in event.message
    assert event.values['reading'] == 'disc'
    assert 0.5 < float(event.values['confidence']) < 1.0
    assert physsim.digest() == before
    assert pictures[-1].markers[-1].text == 'not recognised'


def test_what_a_stroke_does_to_several_bodies_is_undone_at_once(
    client: Client, physsim: PhysSim
) -> None:
    for number in range(3):
        physsim.spawn(disc(f'a/{number}', at=(number, 0.0), text='{anchored: true}'))
    there = physsim.names
    swings = [(x / 4 - 0.7, (-1) ** x * 0.7) for x in range(17)]
    scribble = [each for pair in pairwise(swings) for each in line(*pair, 12)]
    told, *deleted = client.ask('~/stroke', stroke(scribble))
    assert told.values['reading'] == 'deletion'
    assert told.values['requests'] == str(len(deleted)) == '3'
    assert physsim.names == ()

    physsim.node.simulation.undo()

    assert physsim.names == there
