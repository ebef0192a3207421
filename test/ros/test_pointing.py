# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A point on `~/anchor` or `~/release` means the topmost body under it, at any rotation."""

from __future__ import annotations

import math
from typing import Any

from physsim_ros.testing import box, marker, PhysSim, point, polygon, Refused
import pytest
from visualization_msgs.msg import Marker, MarkerArray

from ..building import ELL
from ..client import Client, Event

# Just inside and just outside of an edge [m].
JUST = 1e-6
# A box of 2 m by 1 m, turned by 0.7 rad, and the middles of its four edges in its own frame [m].
AT = (3.0, -2.0, 0.7)
EDGES = [(1.0, 0.0), (-1.0, 0.0), (0.0, 0.5), (0.0, -0.5)]
CORNERS = [(1.0, 0.5), (-1.0, 0.5), (-1.0, -0.5), (1.0, -0.5)]


def in_world(x: float, y: float) -> tuple[float, float]:
    """Return a point of the body's frame in the world."""
    cos, sin = math.cos(AT[2]), math.sin(AT[2])
    return AT[0] + cos * x - sin * y, AT[1] + sin * x + cos * y


def stretched(place: tuple[float, float], by: float) -> tuple[float, float]:
    length = math.hypot(*place)
    return place[0] * (length + by) / length, place[1] * (length + by) / length


def is_anchored(physsim: PhysSim, name: str) -> bool:
    """Tell whether a body is, by what it does."""
    before = physsim.pose(name)
    physsim.step(2)
    return physsim.pose(name) == before and physsim.twist(name) == (0.0, 0.0, 0.0)


def refused(events: list[Event], name: str) -> None:
    (event,) = events
    assert event == Event(2, name, '', event.message, 'nothing_there', 'point')


@pytest.mark.parametrize('place', EDGES + CORNERS)
def test_a_turned_box_is_hit_just_inside_of_its_edges_and_corners(
    physsim: PhysSim, client: Client, place: tuple[float, float]
) -> None:
    physsim.spawn(box('a/0', size=(2.0, 1.0), at=AT))
    before = physsim.digest()
    outside = point(*in_world(*stretched(place, JUST)))
    refused(client.ask('~/anchor', outside), '~/anchor')
    refused(client.ask('~/release', outside), '~/release')
    assert physsim.digest() == before
    (event,) = client.ask('~/anchor', point(*in_world(*stretched(place, -JUST))))
    assert event == Event(0, '~/anchor', 'a/0', event.message, 'ok', '')
    assert is_anchored(physsim, 'a/0')
    refused(client.ask('~/release', outside), '~/release')
    assert is_anchored(physsim, 'a/0')
    (event,) = client.ask('~/release', point(*in_world(*stretched(place, -JUST))))
    assert event == Event(0, '~/release', 'a/0', event.message, 'ok', '')
    assert not is_anchored(physsim, 'a/0')


@pytest.mark.parametrize('place', EDGES + CORNERS)
def test_a_point_may_be_given_in_the_frame_of_the_body(
    physsim: PhysSim, client: Client, place: tuple[float, float]
) -> None:
    physsim.spawn(box('a/0', size=(2.0, 1.0), at=AT, text='{velocity: [1, 2], spin: 3}'))
    physsim.step(7)
    refused(client.ask('~/anchor', point(*stretched(place, JUST), 'a/0')), '~/anchor')
    inside = point(*stretched(place, -JUST), 'a/0')
    assert physsim.anchor(inside) == 'a/0'
    assert is_anchored(physsim, 'a/0')
    assert physsim.release(inside) == 'a/0'
    assert not is_anchored(physsim, 'a/0')


@pytest.mark.parametrize(
    ('message', 'inside', 'outside'),
    [
        (polygon(outline=ELL.outline, at=AT), [(0.5, 1.5), (1.5, 0.5), (0.9, 0.9)], [(1.1, 1.1)]),
        (
            marker(Marker.LINE_STRIP, points=[(0, 0), (2, 0), (2, 2)], scale=(0.2,), at=AT),
            [(1.0, 0.099), (2.099, 1.0), (-0.099, 0.0)],
            [(1.0, 0.101), (1.0, 1.0), (-0.101, 0.0)],
        ),
        (
            marker(
                Marker.TRIANGLE_LIST,
                points=[(0, 0), (1, 0), (0, 1), (3, 0), (4, 0), (3, 1)],
                at=AT,
            ),
            [(0.49, 0.49), (3.49, 0.49)],
            [(0.51, 0.51), (2.0, 0.1)],
        ),
        (
            marker(Marker.SPHERE_LIST, points=[(0, 0), (2, 0)], at=AT),
            [(0.499, 0.0), (2.0, 0.499)],
            [(1.0, 0.0), (0.501, 0.0)],
        ),
        (
            marker(Marker.CUBE_LIST, points=[(0, 0), (2, 0)], at=AT),
            [(0.499, 0.499), (1.501, -0.499)],
            [(1.0, 0.0), (0.501, 0.0)],
        ),
    ],
    ids=['polygon', 'chain', 'triangles', 'discs', 'boxes'],
)
def test_other_shapes_are_hit_where_they_are_and_not_where_they_are_not(
    physsim: PhysSim, message: Marker, inside: Any, outside: Any
) -> None:
    physsim.spawn(message)
    for place in outside:
        with pytest.raises(Refused, match='nothing_there'):
            physsim.anchor(in_world(*place))
    for place in inside:
        assert physsim.anchor(in_world(*place)) == 'body/0'
        assert physsim.release(in_world(*place)) == 'body/0'


def test_an_anchor_is_drawn_and_its_symbol_goes_with_it(physsim: PhysSim, client: Client) -> None:
    pictures = client.listen(MarkerArray, '~/markers')
    physsim.spawn(box('a/3', at=(1.0, 2.0)))

    def symbols() -> list[int]:
        physsim.step()
        return [each.action for each in pictures[-1].markers if each.ns == 'anchor:a']

    assert symbols() == []
    physsim.anchor((1.0, 2.0))
    assert symbols() == [Marker.ADD]
    physsim.release((1.0, 2.0))
    assert symbols() == [Marker.DELETE]
