# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Clicks on `clicked_point` make and change bodies; `test/drawing` has them at all times."""

from __future__ import annotations

import math

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


def markers_of(physsim: PhysSim, client: Client) -> dict[str, Marker]:
    """Return the markers of the bodies now, by name."""
    pictures = client.listen(MarkerArray, '~/markers', KEPT)
    client.spin_until(lambda: pictures)
    return {f'{marker.ns}/{marker.id}': marker for marker in pictures[-1].markers}


def test_a_body_is_drawn(hand: Hand) -> None:
    accepted(hand.draw('rectangle', (0, 0), (0, 2), (-1, 9)), 'drawn/0')
    accepted(hand.draw('polygon', (0, 0), (3, 0), (0, 3), (0.1, 0)), 'drawn/1')
    assert hand.physsim.pose('drawn/0') == pytest.approx((-0.5, 1.0, math.pi / 2), abs=1e-12)
    markers = markers_of(hand.physsim, hand.client)
    assert markers['drawn/0'].type == Marker.CUBE
    assert (markers['drawn/0'].scale.x, markers['drawn/0'].scale.y) == pytest.approx((2.0, 1.0))
    assert markers['drawn/1'].type == Marker.LINE_STRIP


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


def test_the_knife_cuts_and_one_undo_makes_whole(client: Client) -> None:
    hand, physsim = Hand(client, 0), client.physsim
    text = '{velocity: [1, 0], spin: 3, forces: [{force: [0, 2], at: [0.9, 0]}]}'
    physsim.spawn(box('a/0', at=(0, 0), size=(2, 1), text=text))
    hand.take('knife')
    hand.click(0.5, -2)

    event = hand.click(0.5, 2)

    accepted(event, 'a/0')
    assert event.message == 'cut into 2 pieces'
    assert physsim.names == ('a/0', 'drawn/0')
    assert physsim.twist('drawn/0') == pytest.approx((1.0, 3 * 0.75, 3.0))
    assert client.call('~/undo').success
    assert physsim.names == ('a/0',)


def test_an_unknown_frame_is_refused_and_the_gesture_goes_on(hand: Hand) -> None:
    hand.take('circle')
    hand.click(0, 0)
    event = hand.click(1, 0, 'nobody/0')
    assert (event.code, event.field) == ('unknown_frame', 'header.frame_id')
    accepted(hand.click(1, 0, 'world'), 'drawn/0')
    event = hand.draw('polygon', (5, 5), (7, 7), (7, 5), (5, 7), (5, 5))
    assert (event.level, event.code) == (2, 'bad_outline')


def test_a_click_sees_what_was_asked_just_before(client: Client) -> None:
    hand = Hand(client, 0)
    hand.take('delete')
    client.publish('~/spawn', disc('a/0'))
    events = client.ask('/clicked_point', point(0.0, 0.0))
    assert [(event.name, event.hardware_id, event.code) for event in events] == [
        ('~/spawn', 'a/0', 'ok'),
        ('clicked_point', 'a/0', 'ok'),
    ]


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
    # A decimetre above the bodies.
    assert [(each.x, each.y, each.z) for each in line.points] == [(0.0, 0.0, 0.1), (1.0, 0.0, 0.1)]
    assert line.header.frame_id == 'world'
    late = hand.client.listen(MarkerArray, '~/preview', KEPT)
    hand.client.spin_until(lambda: late)
    assert shown(late) == shown(pictures)
    hand.click(1, 1)
    assert shown(pictures) == []
    hand.click(0, 0)
    hand.click(0, 0)
    assert shown(pictures) == []
    hand.click(0, 0)
    hand.take('circle')
    hand.client.physsim.node.loop.apply_requests()
    hand.client.spin_until(lambda: shown(pictures) == [])
