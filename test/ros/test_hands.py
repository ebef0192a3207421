# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Hands on `~/drag/feedback` grab, drag, throw and place bodies."""

from __future__ import annotations

from geometry_msgs.msg import Point, Pose
from physsim_ros.testing import disc, PhysSim
import pytest
from visualization_msgs.msg import InteractiveMarkerFeedback, Marker, MarkerArray

from .messages import DOWN, feedback, MOVE, UP
from ..client import Client, Event, KEPT

TOPIC = '~/drag/feedback'


def test_two_hands_drag_two_bodies_and_throw_them(physsim: PhysSim, client: Client) -> None:
    physsim.spawn(disc('a/0', at=(0.0, 5.0)))
    physsim.spawn(disc('a/1', at=(10.0, 5.0)))
    events = []
    for hand, x in (('anna', 0.0), ('bert', 10.0)):
        events += client.ask(TOPIC, feedback(DOWN, x, 5.0, hand=hand))
    for number in range(60):
        for hand, x in (('anna', 0.0), ('bert', 10.0)):
            client.publish(TOPIC, feedback(MOVE, x, 5.0 + number / 20, hand=hand))
        physsim.step()
    # m/s: the hands go up by 1 / 20 m at once in each frame.
    for name in ('a/0', 'a/1'):
        assert physsim.twist(name) == pytest.approx((0.0, 3.0, 0.0), abs=0.2)
    events += client.ask(TOPIC, feedback(UP, hand='anna'))
    height, speed = physsim.pose('a/0')[1], physsim.twist('a/0')[1]
    physsim.run(0.5)

    assert physsim.pose('a/0')[1] == pytest.approx(height + speed / 2 - 9.81 / 8, abs=1e-9)
    assert physsim.twist('a/1')[1] == pytest.approx(0.0, abs=0.05)
    assert events == [
        Event(0, TOPIC, 'a/0', 'grabbed a/0', 'ok', ''),
        Event(0, TOPIC, 'a/1', 'grabbed a/1', 'ok', ''),
        Event(0, TOPIC, 'a/0', 'let go of a/0', 'ok', ''),
    ]
    client.call('~/undo')
    physsim.settle()
    assert physsim.pose('a/0')[1] == pytest.approx(5.0)


def test_a_hand_without_a_valid_mouse_point_is_at_its_pose(
    physsim: PhysSim, client: Client
) -> None:
    physsim.spawn(disc('a/0', at=(3.0, 5.0)))
    message = InteractiveMarkerFeedback(
        event_type=DOWN, pose=Pose(position=Point(x=3.0, y=5.0)), mouse_point=Point(x=9.0)
    )

    (event,) = client.ask(TOPIC, message)

    assert (event.hardware_id, event.code) == ('a/0', 'ok')


def test_a_line_is_drawn_from_the_body_to_its_hand(physsim: PhysSim, client: Client) -> None:
    pictures = client.listen(MarkerArray, '~/markers', KEPT)
    physsim.spawn(disc('a/0'))
    client.ask(TOPIC, feedback(DOWN, 0.125, 0.25))
    client.ask(TOPIC, feedback(MOVE, 3.0, 4.0))
    (line,) = [marker for marker in pictures[-1].markers if marker.ns == 'physsim:hands']
    assert line.type == Marker.LINE_LIST
    assert [(each.x, each.y) for each in line.points] == [(0.125, 0.25), (3.0, 4.0)]

    client.ask(TOPIC, feedback(UP))
    (line,) = [marker for marker in pictures[-1].markers if marker.ns == 'physsim:hands']
    assert line.action == Marker.DELETE
