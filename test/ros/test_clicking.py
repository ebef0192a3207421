# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Clicks on `clicked_point` make and change bodies; `test/drawing` has them at all times."""

from __future__ import annotations

import math
from typing import Any

from geometry_msgs.msg import PointStamped
from physsim_ros.testing import box, disc, PhysSim, point
import pytest
from rclpy.parameter import Parameter
from visualization_msgs.msg import Marker, MarkerArray

from ..client import Client, Event, KEPT


class Hand:
    """Somebody who clicks, and lets the world go on by frames after each click."""

    def __init__(self, client: Client, frames: int) -> None:
        self.client = client
        self.physsim = client.physsim
        self._frames = frames

    def take(self, tool: str, **values: object) -> None:
        parameters = [Parameter(name, value=value) for name, value in values.items()]
        results = self.physsim.node.set_parameters([Parameter('tool', value=tool), *parameters])
        assert all(result.successful for result in results), results

    def click(self, x: float, y: float, frame: str = '') -> Event:
        """Click, and return the one answer."""
        (event,) = self.client.ask('/clicked_point', point(x, y, frame))
        self.physsim.step(self._frames)
        return event

    def draw(self, tool: str, *points: tuple[float, float], **values: object) -> Event:
        """Click the points of a whole gesture with a tool, and return the last answer."""
        self.take(tool, **values)
        *earlier, last = points
        for each in earlier:
            event = self.click(*each)
            assert (event.level, event.code) == (0, 'ok'), event
            assert 'next: ' in event.message
        return self.click(*last)


@pytest.fixture
def hand(client: Client) -> Hand:
    """Give a hand that clicks once a frame in a world without gravity."""
    (result,) = client.physsim.node.set_parameters([Parameter('gravity', value=[0.0, 0.0])])
    assert result.successful
    return Hand(client, 1)


def accepted(event: Event, name: str) -> None:
    assert event == Event(0, 'clicked_point', name, event.message, 'ok', '')


def refused(event: Event, code: str) -> None:
    assert (event.level, event.code) == (2, code), event
    assert event.message


def markers_of(physsim: PhysSim, client: Client) -> dict[str, Marker]:
    """Return the markers of the bodies now, by name."""
    pictures = client.listen(MarkerArray, '~/markers', KEPT)
    client.spin_until(lambda: pictures)
    return {f'{marker.ns}/{marker.id}': marker for marker in pictures[-1].markers}


# Each tool


def test_a_body_is_drawn(hand: Hand) -> None:
    accepted(hand.draw('rectangle', (0, 0), (0, 2), (-1, 9)), 'drawn/0')
    accepted(hand.draw('polygon', (0, 0), (3, 0), (0, 3), (0.1, 0)), 'drawn/1')
    assert hand.physsim.pose('drawn/0') == pytest.approx((-0.5, 1.0, math.pi / 2), abs=1e-12)
    markers = markers_of(hand.physsim, hand.client)
    assert markers['drawn/0'].type == Marker.CUBE
    assert (markers['drawn/0'].scale.x, markers['drawn/0'].scale.y) == pytest.approx((2.0, 1.0))
    assert markers['drawn/1'].type == Marker.LINE_STRIP


def test_bodies_are_anchored_released_and_deleted_by_a_click(hand: Hand) -> None:
    hand.physsim.spawn(disc('a/0', text='{velocity: [0.1, 0]}'))
    accepted(hand.draw('anchor', (0, 0)), 'a/0')
    hand.physsim.step()
    assert hand.physsim.twist('a/0') == (0.0, 0.0, 0.0)
    accepted(hand.draw('release', (0, 0)), 'a/0')
    accepted(hand.draw('delete', (0, 0)), 'a/0')
    assert hand.physsim.names == ()
    for tool in ('anchor', 'release', 'delete'):
        refused(hand.draw(tool, (0, 0)), 'nothing_there')


def test_gravity_is_turned_by_an_arrow_and_the_parameter_tells(hand: Hand) -> None:
    node = hand.physsim.node
    node.set_parameters([Parameter('gravity', value=[0.0, -2.0])])
    accepted(hand.draw('gravity', (0, 0), (3, 0)), '')
    assert list(node.get_parameter('gravity').value) == pytest.approx([2.0, 0.0])
    assert hand.physsim.node.simulation.world.settings.gravity == pytest.approx((2.0, 0.0))


def test_what_is_drawn_is_as_the_parameters_say(hand: Hand) -> None:
    made = {'density': 3.0, 'friction': 0.25, 'elasticity': 0.75}
    event = hand.draw(
        'circle', (0, 0), (1, 0), draw_velocity=[2.0, 1.0], draw_color='#ff8000', **made
    )
    accepted(event, 'drawn/0')
    assert hand.physsim.twist('drawn/0') == pytest.approx((2.0, 1.0, 0.0), abs=1e-12)
    marker = markers_of(hand.physsim, hand.client)['drawn/0']
    assert marker.text == '{density: 3.0, friction: 0.25, elasticity: 0.75}'
    assert marker.color.g == pytest.approx(128 / 255)


# Refusals


def test_the_knife_cuts_and_one_undo_makes_whole(client: Client) -> None:
    hand, physsim = Hand(client, 0), client.physsim
    text = '{velocity: [1, 0], spin: 3, forces: [{force: [0, 2], at: [0.9, 0]}]}'
    physsim.spawn(box('a/0', at=(0, 0), size=(2, 1), text=text))
    hand.take('knife')
    hand.click(0.5, -2)

    answers = client.ask('/clicked_point', point(0.5, 2))

    assert [(event.hardware_id, event.code) for event in answers] == [
        ('', 'ok'), ('a/0', 'ok'), ('drawn/0', 'ok')]  # fmt: skip
    assert answers[0].message == 'cut into 2 pieces'
    assert physsim.names == ('a/0', 'drawn/0')
    assert physsim.twist('drawn/0') == pytest.approx((1.0, 3 * 0.75, 3.0))
    assert client.call('~/undo').success
    assert physsim.names == ('a/0',)


@pytest.mark.parametrize(
    ('tool', 'points', 'code'),
    [
        ('rectangle', [(5, 5), (6, 5), (9, 5)], 'bad_size'),
        ('polygon', [(5, 5), (7, 7), (7, 5), (5, 7), (5, 5)], 'bad_outline'),
        ('rope', [(3, 0), (9, 9)], 'anchored'),
        ('circle', [(math.nan, 0)], 'malformed'),
    ],
)
def test_what_cannot_be_drawn_is_refused_with_a_code_and_changes_nothing(
    client: Client, tool: str, points: Any, code: str
) -> None:
    client.physsim.spawn(box('a/1', at=(3, 0), text='{anchored: true}'))
    before = client.physsim.digest()
    refused(Hand(client, 0).draw(tool, *points), code)
    assert client.physsim.digest() == before


def test_an_unknown_frame_is_refused_and_the_gesture_goes_on(hand: Hand) -> None:
    hand.take('circle')
    hand.click(0, 0)
    event = hand.click(1, 0, 'nobody/0')
    assert (event.code, event.field) == ('unknown_frame', 'header.frame_id')
    accepted(hand.click(1, 0, 'world'), 'drawn/0')


@pytest.mark.parametrize(
    ('name', 'value'),
    [
        ('tool', 'crayon'),
        ('draw_color', 'red'),
        ('draw_velocity', [math.nan, 0.0]),
    ],
)
def test_a_parameter_of_drawing_that_is_wrong_is_refused_and_the_gesture_goes_on(
    client: Client, name: str, value: object
) -> None:
    hand = Hand(client, 0)
    hand.take('circle')
    hand.click(0, 0)
    (result,) = client.physsim.node.set_parameters([Parameter(name, value=value)])
    assert not result.successful
    assert result.reason
    accepted(hand.click(1, 0), 'drawn/0')


# Frames and order


def test_a_click_sees_what_was_asked_just_before(client: Client) -> None:
    hand = Hand(client, 0)
    hand.take('delete')
    client.publish('~/spawn', disc('a/0'))
    events = client.ask('/clicked_point', point(0.0, 0.0))
    assert [(event.name, event.hardware_id, event.code) for event in events] == [
        ('~/spawn', 'a/0', 'ok'),
        ('clicked_point', 'a/0', 'ok'),
    ]


def test_many_clicks_at_once_are_all_answered_in_order(client: Client) -> None:
    hand = Hand(client, 0)
    hand.take('circle')
    publisher = client.node.create_publisher(PointStamped, '/clicked_point', client.qos)
    client.spin_until(publisher.get_subscription_count)
    for number in range(100):
        publisher.publish(point(3.0 * number, 0.0))
        publisher.publish(point(3.0 * number + 1.0, 0.0))
    client.physsim.settle()
    client.physsim.node.apply_requests()
    client.physsim.settle()
    done = [event.hardware_id for event in client.events if event.hardware_id]
    assert done == [f'drawn/{number}' for number in range(100)]
    assert len(client.events) == 200


# Preview


def shown(pictures: list[MarkerArray]) -> list[int]:
    """Return the types of what is shown, in the last message, which begins by clearing all."""
    clearing, *markers = pictures[-1].markers
    assert clearing.action == Marker.DELETEALL
    assert len({(marker.ns, marker.id) for marker in markers}) == len(markers)
    return [marker.type for marker in markers]


def test_a_half_drawn_shape_is_shown_until_it_is_done_or_dropped(hand: Hand) -> None:
    hand.take('rectangle')
    pictures = hand.client.listen(MarkerArray, '~/preview', KEPT)
    hand.click(0, 0)
    assert shown(pictures) == [Marker.SPHERE_LIST, Marker.TEXT_VIEW_FACING]
    assert pictures[-1].markers[-1].text == 'rectangle'
    hand.click(1, 0)
    assert shown(pictures) == [Marker.LINE_STRIP, Marker.SPHERE_LIST, Marker.TEXT_VIEW_FACING]
    line = pictures[-1].markers[1]
    assert [(each.x, each.y) for each in line.points] == [(0.0, 0.0), (1.0, 0.0)]
    assert line.header.frame_id == 'world'
    hand.click(1, 1)
    assert shown(pictures) == []
    hand.click(0, 0)
    hand.click(0, 0)
    assert shown(pictures) == []
    hand.click(0, 0)
    hand.take('circle')
    hand.client.spin_until(lambda: shown(pictures) == [])


def test_who_comes_late_sees_what_is_half_drawn(client: Client) -> None:
    hand = Hand(client, 0)
    hand.take('polygon')
    for x, y in ((0, 0), (1, 0), (1, 1)):
        hand.click(x, y)
    pictures = client.listen(MarkerArray, '~/preview', KEPT)
    client.spin_until(lambda: pictures)
    lines = [marker for marker in pictures[-1].markers if marker.type == Marker.LINE_STRIP]
    assert len(lines[0].points) == 3
    # The ring about the first corner.
    assert len(lines[1].points) > 8
