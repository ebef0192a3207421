# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A marker on `~/spawn` becomes a body, changes it or deletes it, and is answered once."""

from __future__ import annotations

from typing import Any

from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Triangles
from physsim_ros.testing import box, delete, delete_all, disc, marker, PhysSim
import pytest
from visualization_msgs.msg import Marker, MarkerArray

from ..building import ELL
from ..client import Client, Event, set_parameter

CENTERS = ((0.0, 0.0), (1.0, 0.0))
TRIANGLE = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
TERRAIN = ((-1.0, 0.0), (0.0, 0.0), (1.0, 0.5))

# kind, scale, points -> shape
BODIES: dict[str, tuple[int, tuple[float, ...], Any, Any]] = {
    'cube': (Marker.CUBE, (2.0, 1.0), (), Box(width=2.0, height=1.0)),
    'sphere': (Marker.SPHERE, (0.6, 0.6), (), Disc(radius=0.3)),
    'cylinder': (Marker.CYLINDER, (0.6, 0.6), (), Disc(radius=0.3)),
    'closed strip': (Marker.LINE_STRIP, (0.0,), (*ELL.outline, ELL.outline[0]), ELL),
    'open strip': (Marker.LINE_STRIP, (0.2,), TERRAIN, Chain(points=TERRAIN, thickness=0.2)),
    'triangles': (
        Marker.TRIANGLE_LIST,
        (2.0, 1.0),
        TRIANGLE,
        Triangles(vertices=((0.0, 0.0), (2.0, 0.0), (0.0, 1.0))),
    ),
    'triangles without a scale': (
        Marker.TRIANGLE_LIST,
        (0.0, 0.0),
        TRIANGLE,
        Triangles(vertices=TRIANGLE),
    ),
    'cubes': (
        Marker.CUBE_LIST,
        (1.0, 0.5),
        CENTERS,
        Compound(element=Box(width=1.0, height=0.5), centers=CENTERS),
    ),
    'spheres': (
        Marker.SPHERE_LIST,
        (1.0, 1.0),
        CENTERS,
        Compound(element=Disc(radius=0.5), centers=CENTERS),
    ),
}


def body_of(physsim: PhysSim, name: str) -> Any:
    """Return the description of a body."""
    scene = physsim.node.simulation.world.snapshot().scene
    return scene.bodies[scene.names.index(name)]


def accepted(events: list[Event], name: str, subject: str) -> None:
    """Check that a request was answered once, and how."""
    (event,) = events
    assert event.message
    assert event == Event(0, name, subject, event.message, 'ok', '')


# Shapes


@pytest.mark.parametrize('kind', BODIES)
def test_every_kind_of_marker_becomes_a_body(physsim: PhysSim, client: Client, kind: str) -> None:
    type_, scale, points, shape = BODIES[kind]
    message = marker(type_, 'a/3', scale=scale, points=points, at=(1.0, 2.0, 0.5))
    accepted(client.ask('~/spawn', message), '~/spawn', 'a/3')
    assert physsim.names == ('a/3',)
    assert physsim.pose('a/3') == pytest.approx((1.0, 2.0, 0.5))
    assert body_of(physsim, 'a/3').shape == shape


def test_what_is_drawn_can_be_spawned_again_as_it_is(physsim: PhysSim, client: Client) -> None:
    pictures = client.listen(MarkerArray, '~/markers')
    for number, (type_, scale, points, _) in enumerate(BODIES.values()):
        text = f'{{density: 2.5, group: {number}, sensor: true, anchored: {number % 2 > 0}}}'
        physsim.spawn(
            marker(
                type_,
                f'a/{number}',
                scale=scale,
                points=points,
                at=(number * 5.0, 1.0, 0.4),
                text=text.lower(),
                color=(0.25, 0.5, 0.75, 1.0),
            )
        )
    physsim.step()
    picture = [each for each in pictures[-1].markers if not each.ns.startswith('anchor:')]
    before = physsim.node.simulation.world.snapshot()
    physsim.spawn(delete_all())
    physsim.spawn(MarkerArray(markers=picture))
    after = physsim.node.simulation.world.snapshot()
    assert after.scene.bodies == before.scene.bodies
    # m and rad: a yaw goes through a quaternion and back
    assert after.poses == pytest.approx(before.poses, abs=1e-12)


def test_a_namespace_may_be_left_out(physsim: PhysSim, client: Client) -> None:
    accepted(client.ask('~/spawn', box('/7')), '~/spawn', 'body/7')
    accepted(client.ask('~/spawn', delete('body/7')), '~/spawn', 'body/7')
    assert physsim.names == ()


def test_a_colour_is_taken_as_it_is(physsim: PhysSim) -> None:
    physsim.spawn(box(color=(0.25, 0.5, 0.75, 0.5)))
    assert body_of(physsim, 'body/0').color == (0.25, 0.5, 0.75, 0.5)


# Deletion, lifetime


def test_all_bodies_are_deleted_or_all_of_a_namespace(physsim: PhysSim, client: Client) -> None:
    names = ['a/0', 'b/0', 'a/b/0', 'ab/0', 'b/1', 'body/0']
    markers = [box(name, at=(2.0 * number, 0.0)) for number, name in enumerate(names)]
    physsim.spawn(MarkerArray(markers=markers))
    accepted(client.ask('~/spawn', delete_all('b')), '~/spawn', '')
    assert physsim.names == ('a/0', 'a/b/0', 'ab/0', 'body/0')
    accepted(client.ask('~/spawn', delete_all('nobody')), '~/spawn', '')
    assert len(physsim.names) == 4
    accepted(client.ask('~/spawn', delete_all()), '~/spawn', '')
    assert physsim.names == ()
    accepted(client.ask('~/spawn', delete_all()), '~/spawn', '')


# Text


def test_what_is_not_said_comes_from_the_parameters(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0'))
    set_parameter(physsim, 'density', 7.0)
    physsim.spawn(box('a/1', at=(3.0, 0.0)))
    physsim.spawn(box('a/2', at=(6.0, 0.0), text='{density: 0.5}'))
    physsim.spawn(box('a/0', at=(0.0, 1.0)))
    densities = [body_of(physsim, f'a/{number}').density for number in range(3)]
    assert densities == [1.0, 7.0, 0.5]


# Arrays


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


def test_an_array_of_thousands_is_answered_one_by_one(physsim: PhysSim, client: Client) -> None:
    markers = [disc(f'a/{number}', at=(2.0 * number, 0.0)) for number in range(1500)]
    events = client.ask('~/spawn_array', MarkerArray(markers=markers))
    assert [event.hardware_id for event in events] == [f'a/{number}' for number in range(1500)]
    assert physsim.names == tuple(f'a/{number}' for number in range(1500))
