# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A point on `~/anchor` or `~/release` means the topmost body under it, at any rotation."""

from __future__ import annotations

import math
from typing import Any

from physsim_ros.testing import box, command, disc, marker, PhysSim, point, polygon, Refused
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


@pytest.mark.parametrize('angle', [0.0, 0.7, 2.0, 4.0])
def test_a_disc_is_hit_just_inside_of_its_rim(physsim: PhysSim, angle: float) -> None:
    physsim.spawn(disc('a/0', diameter=3.0, at=AT))
    cos, sin = math.cos(angle), math.sin(angle)
    with pytest.raises(Refused, match='nothing_there'):
        physsim.anchor((AT[0] + (1.5 + JUST) * cos, AT[1] + (1.5 + JUST) * sin))
    assert physsim.anchor((AT[0] + (1.5 - JUST) * cos, AT[1] + (1.5 - JUST) * sin)) == 'a/0'


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


def test_what_was_spawned_last_lies_on_top(physsim: PhysSim) -> None:
    markers = [disc(f'a/{number}', diameter=2.0) for number in (5, 3, 4)]
    physsim.spawn(MarkerArray(markers=markers))
    assert physsim.anchor((0.0, 0.0)) == 'a/4'
    # A change in place leaves it where it lies; anchoring does too.
    physsim.spawn(disc('a/3', diameter=3.0))
    assert physsim.release((0.0, 0.0)) == 'a/4'
    assert physsim.anchor((1.2, 0.0)) == 'a/3'


def test_a_sensor_can_be_pointed_at(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', text='{sensor: true}'))
    assert physsim.anchor((0.0, 0.0)) == 'a/0'


def test_asking_twice_does_nothing_twice(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0'))
    physsim.anchor((0.0, 0.0))
    before = physsim.digest()
    assert physsim.anchor((0.0, 0.0)) == 'a/0'
    assert physsim.digest() == before
    physsim.release((0.0, 0.0))
    before = physsim.digest()
    assert physsim.release((0.0, 0.0)) == 'a/0'
    assert physsim.digest() == before


def test_an_anchored_body_stops_at_once_and_a_released_one_falls_from_rest(
    physsim: PhysSim,
) -> None:
    physsim.spawn(box('a/0', text='{velocity: [4, 0], spin: 1}'))
    physsim.step(6)
    held = physsim.pose('a/0')
    assert physsim.anchor((held.x, held.y)) == 'a/0'
    physsim.run(0.5)
    assert physsim.pose('a/0') == pytest.approx(held, abs=1e-12)
    physsim.release((held.x, held.y))
    physsim.run(0.5)
    x, y, yaw = physsim.pose('a/0')
    # m, rad
    assert (x, yaw) == pytest.approx((held.x, held.yaw), abs=1e-12)
    assert y - held.y == pytest.approx(-9.81 * 0.5**2 / 2, abs=1e-9)


def test_a_kinematic_body_can_be_held_and_let_go(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', text='{kinematic: true, velocity: [1, 0]}'))
    physsim.anchor((0.0, 0.0))
    assert is_anchored(physsim, 'a/0')
    physsim.release((0.0, 0.0))
    physsim.run(1.0)
    # It is kinematic still, and falls no more than before.
    assert physsim.pose('a/0') == (0.0, 0.0, 0.0)
    physsim.command(command('a/0', twists=[(2.0, 0.0, 0.0)]))
    physsim.run(1.0)
    assert physsim.pose('a/0') == pytest.approx((2.0, 0.0, 0.0))


def test_an_anchored_body_holds_up_another_and_a_released_one_does_not(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', size=(4.0, 0.2), text='{elasticity: 0}'))
    physsim.anchor((1.5, 0.0))
    physsim.spawn(box('b/0', at=(0.0, 0.6), text='{elasticity: 0}'))
    physsim.run(1.0)
    # m; the engine lets it sink in by 5 mm
    assert physsim.pose('b/0').y == pytest.approx(0.6, abs=0.007)
    physsim.release((1.5, 0.0))
    physsim.run(0.5)
    assert physsim.pose('b/0').y < 0.0


def test_a_point_follows_a_body_that_has_been_moved(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0'))
    physsim.command(command('a/0', poses=[(50.0, 0.0, 0.3)]))
    with pytest.raises(Refused, match='nothing_there'):
        physsim.anchor((0.0, 0.0))
    assert physsim.anchor((50.0, 0.0)) == 'a/0'
    physsim.spawn(box('a/0', at=(-50.0, 0.0)))
    with pytest.raises(Refused, match='nothing_there'):
        physsim.release((50.0, 0.0))
    assert physsim.release((-50.0, 0.0)) == 'a/0'


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
