# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A marker on `~/spawn` becomes a body, changes it or deletes it, and is answered once."""

from __future__ import annotations

import math
from typing import Any

from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Triangles
from physsim_ros.testing import box, command, delete, delete_all, disc, marker, PhysSim, polygon
import pytest
from visualization_msgs.msg import Marker, MarkerArray

from ..building import ELL
from ..client import Client, Event, set_parameter

# Depth to which a resting body sinks in [m]: the engine's slop of 5 mm, more while it is pressed.
SINKS = 0.007
CENTERS = ((0.0, 0.0), (1.0, 0.0))
TRIANGLE = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
TERRAIN = ((-1.0, 0.0), (0.0, 0.0), (1.0, 0.5))
FLOOR = box('floor/0', size=(40.0, 1.0), at=(0.0, -0.5), text='{anchored: true, elasticity: 0}')

# kind, scale, points -> shape, height of its origin where it lies on the ground [m]
BODIES: dict[str, tuple[int, tuple[float, ...], Any, Any, float]] = {
    'cube': (Marker.CUBE, (2.0, 1.0), (), Box(width=2.0, height=1.0), 0.5),
    'sphere': (Marker.SPHERE, (0.6, 0.6), (), Disc(radius=0.3), 0.3),
    'cylinder': (Marker.CYLINDER, (0.6, 0.6), (), Disc(radius=0.3), 0.3),
    'closed strip': (Marker.LINE_STRIP, (0.0,), (*ELL.outline, ELL.outline[0]), ELL, 0.0),
    'open strip': (Marker.LINE_STRIP, (0.2,), TERRAIN, Chain(points=TERRAIN, thickness=0.2), 0.1),
    'triangles': (
        Marker.TRIANGLE_LIST,
        (2.0, 1.0),
        TRIANGLE,
        Triangles(vertices=((0.0, 0.0), (2.0, 0.0), (0.0, 1.0))),
        0.0,
    ),
    'cubes': (
        Marker.CUBE_LIST,
        (1.0, 0.5),
        CENTERS,
        Compound(element=Box(width=1.0, height=0.5), centers=CENTERS),
        0.25,
    ),
    'spheres': (
        Marker.SPHERE_LIST,
        (1.0, 1.0),
        CENTERS,
        Compound(element=Disc(radius=0.5), centers=CENTERS),
        0.5,
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
    type_, scale, points, shape, _ = BODIES[kind]
    message = marker(type_, 'a/3', scale=scale, points=points, at=(1.0, 2.0, 0.5))
    accepted(client.ask('~/spawn', message), '~/spawn', 'a/3')
    assert physsim.names == ('a/3',)
    assert physsim.pose('a/3') == pytest.approx((1.0, 2.0, 0.5))
    assert body_of(physsim, 'a/3').shape == shape


@pytest.mark.parametrize('kind', BODIES)
def test_every_kind_of_body_falls_and_comes_to_rest_on_the_ground(
    physsim: PhysSim, kind: str
) -> None:
    type_, scale, points, _, height = BODIES[kind]
    physsim.spawn(FLOOR)
    physsim.spawn(marker(type_, scale=scale, points=points, at=(0.0, height + 0.2)))
    physsim.run(2.0)
    if kind == 'open strip':
        # Its right end is heavier: it tips over its middle until that end touches too.
        assert physsim.pose('body/0').yaw < -0.1
    else:
        assert -SINKS < physsim.pose('body/0').y - height < 0.001
    assert math.hypot(*physsim.twist('body/0')) < 0.05


def test_what_is_drawn_can_be_spawned_again_as_it_is(physsim: PhysSim, client: Client) -> None:
    pictures = client.listen(MarkerArray, '~/markers')
    for number, (type_, scale, points, _, _) in enumerate(BODIES.values()):
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


def test_bodies_are_listed_in_spawn_order_whatever_their_names(physsim: PhysSim) -> None:
    for name in ('b/2', 'a/10', 'a/9', 'c/-1'):
        physsim.spawn(box(name))
    physsim.spawn(box('a/10', at=(3.0, 0.0)))
    assert physsim.names == ('b/2', 'a/10', 'a/9', 'c/-1')
    physsim.spawn(delete('a/10'))
    physsim.spawn(box('a/10'))
    assert physsim.names == ('b/2', 'a/9', 'c/-1', 'a/10')


def test_a_namespace_may_be_left_out(physsim: PhysSim, client: Client) -> None:
    accepted(client.ask('~/spawn', box('/7')), '~/spawn', 'body/7')
    accepted(client.ask('~/spawn', delete('body/7')), '~/spawn', 'body/7')
    assert physsim.names == ()


def test_a_colour_is_chosen_where_none_is_asked_for(physsim: PhysSim) -> None:
    for number in range(3):
        physsim.spawn(box(f'a/{number}', at=(2.0 * number, 0.0)))
    colors = {body_of(physsim, f'a/{number}').color for number in range(3)}
    assert len(colors) == 3
    assert all(color[3] == 1.0 for color in colors)


def test_a_colour_is_taken_as_it_is(physsim: PhysSim) -> None:
    physsim.spawn(box(color=(0.25, 0.5, 0.75, 0.5)))
    assert body_of(physsim, 'body/0').color == (0.25, 0.5, 0.75, 0.5)


# Change in place


def test_a_change_takes_geometry_and_pose_and_keeps_all_else(physsim: PhysSim) -> None:
    text = '{density: 3, friction: 0.1, elasticity: 0.2, group: 4, velocity: [2, 1], spin: 0.5}'
    physsim.spawn(box('a/0', text=text, color=(0.25, 0.5, 0.75, 1.0)))
    before = body_of(physsim, 'a/0')
    physsim.step(5)
    twist = physsim.twist('a/0')
    physsim.spawn(disc('a/0', diameter=3.0, at=(5.0, 6.0, 0.3)))
    after = body_of(physsim, 'a/0')
    assert after.shape == Disc(radius=1.5)
    assert physsim.pose('a/0') == pytest.approx((5.0, 6.0, 0.3))
    # m/s, rad/s: the same but for the rounding of half a step's fall
    assert physsim.twist('a/0') == pytest.approx(twist, abs=1e-12)
    for kept in ('density', 'friction', 'elasticity', 'group', 'color', 'mass', 'anchored'):
        assert getattr(after, kept) == getattr(before, kept), kept


def test_a_change_takes_the_keys_that_it_names_and_no_others(physsim: PhysSim) -> None:
    physsim.spawn(box(text='{density: 3, friction: 0.1, velocity: [2, 1], spin: 0.5}'))
    physsim.spawn(box(text='{friction: 0.7}', color=(1.0, 0.0, 0.0, 1.0)))
    body = body_of(physsim, 'body/0')
    assert (body.density, body.friction, body.color) == (3.0, 0.7, (1.0, 0.0, 0.0, 1.0))
    assert physsim.twist('body/0') == pytest.approx((2.0, 1.0, 0.5))
    physsim.spawn(box(text='{spin: -1}'))
    assert physsim.twist('body/0') == pytest.approx((2.0, 1.0, -1.0))
    physsim.spawn(box(text='{velocity: [0, 0]}'))
    assert physsim.twist('body/0') == pytest.approx((0.0, 0.0, -1.0))
    physsim.spawn(box(text='{mass: 7}'))
    assert body_of(physsim, 'body/0').total_mass == 7.0
    physsim.spawn(box(text='{density: 2}'))
    assert body_of(physsim, 'body/0').total_mass == 2.0


@pytest.mark.parametrize('when', ['at birth', 'later'])
def test_an_anchored_body_is_moved_recoloured_resized_and_released(
    physsim: PhysSim, when: str
) -> None:
    physsim.spawn(box(text='' if when == 'later' else '{anchored: true}'))
    if when == 'later':
        physsim.step(3)
        physsim.anchor((0.0, 0.0))
    physsim.spawn(box(at=(4.0, 3.0, 0.2), size=(2.0, 0.5), color=(1.0, 0.0, 0.0, 1.0)))
    body = body_of(physsim, 'body/0')
    assert body.anchored
    assert (body.shape, body.color) == (Box(width=2.0, height=0.5), (1.0, 0.0, 0.0, 1.0))
    physsim.run(0.5)
    assert physsim.pose('body/0') == pytest.approx((4.0, 3.0, 0.2))
    # It is really there: what falls onto it stays.
    physsim.spawn(box('b/0', at=(4.0, 3.4), size=(0.2, 0.2), text='{elasticity: 0}'))
    physsim.run(0.5)
    assert physsim.pose('b/0').y > 3.0
    physsim.spawn(delete('b/0'))
    physsim.command(command('body/0', poses=[(1.0, 5.0, 0.0)]))
    assert physsim.pose('body/0') == pytest.approx((1.0, 5.0, 0.0))
    physsim.release((1.0, 5.0))
    physsim.run(0.5)
    # m: free fall from rest for half a second
    assert physsim.pose('body/0').y == pytest.approx(5.0 - 9.81 * 0.5**2 / 2, abs=1e-9)


@pytest.mark.parametrize('key', ['anchored', 'kinematic', 'sensor'])
def test_a_role_can_be_given_and_taken_back(physsim: PhysSim, key: str) -> None:
    physsim.spawn(box())
    for value in (True, False):
        physsim.spawn(box(text=f'{{{key}: {str(value).lower()}}}'))
        assert getattr(body_of(physsim, 'body/0'), key) is value
    physsim.run(0.5)
    # m: whatever it was before, it falls now
    assert physsim.pose('body/0').y == pytest.approx(-9.81 * 0.5**2 / 2, abs=1e-9)


# Deletion, lifetime


def test_a_body_is_deleted_by_its_name(physsim: PhysSim, client: Client) -> None:
    physsim.spawn(MarkerArray(markers=[box('a/0'), box('a/1', at=(3.0, 0.0))]))
    accepted(client.ask('~/spawn', delete('a/0')), '~/spawn', 'a/0')
    assert physsim.names == ('a/1',)


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


def test_a_body_lives_as_long_as_it_was_given(physsim: PhysSim, client: Client) -> None:
    pictures = client.listen(MarkerArray, '~/markers')
    physsim.step(3)
    physsim.spawn(box('a/0', lifetime=0.5))
    physsim.spawn(box('a/1', at=(3.0, 0.0)))
    physsim.step(29)
    assert physsim.names == ('a/0', 'a/1')
    physsim.step()
    assert physsim.names == ('a/1',)
    gone = [each for each in pictures[-1].markers if each.action == Marker.DELETE]
    assert [(each.ns, each.id) for each in gone] == [('a', 0)]


def test_a_lifetime_is_renewed_by_one_and_kept_without(physsim: PhysSim) -> None:
    for name in ('a/0', 'a/1'):
        physsim.spawn(box(name, lifetime=0.5, text='{sensor: true}'))
    physsim.step(15)
    physsim.spawn(box('a/0', lifetime=0.5))
    physsim.spawn(box('a/1'))
    physsim.step(15)
    assert physsim.names == ('a/0',)
    physsim.step(14)
    assert physsim.names == ('a/0',)
    physsim.step()
    assert physsim.names == ()


# Frames


def test_a_pose_may_be_relative_to_a_body_as_it_is_then(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', at=(1.0, 2.0, math.pi / 2), text='{velocity: [3, 0]}'))
    physsim.spawn(box('a/1', at=(2.0, 1.0, 0.25), frame='a/0'))
    # m, rad: sines and cosines of a right angle
    expected = (1.0 - 1.0, 2.0 + 2.0, math.pi / 2 + 0.25)
    assert physsim.pose('a/1') == pytest.approx(expected, abs=1e-12)
    physsim.run(1.0)
    there = physsim.pose('a/0')
    physsim.spawn(box('a/2', at=(0.0, -1.0), frame='a/0', text='{anchored: true}'))
    expected = (there.x + math.sin(there.yaw), there.y - math.cos(there.yaw), there.yaw)
    assert physsim.pose('a/2') == pytest.approx(expected, abs=1e-12)


def test_a_body_may_be_moved_relative_to_itself(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', at=(1.0, 2.0, math.pi / 2)))
    physsim.spawn(box('a/0', at=(1.0, 0.0, 0.0), frame='a/0'))
    assert physsim.pose('a/0') == pytest.approx((1.0, 3.0, math.pi / 2), abs=1e-12)


def test_the_frame_of_a_body_is_its_origin_not_its_centre_of_mass(physsim: PhysSim) -> None:
    physsim.spawn(polygon('a/0', outline=ELL.outline, at=(1.0, 2.0), text='{anchored: true}'))
    physsim.spawn(box('a/1', at=(0.25, 0.5), frame='a/0'))
    assert physsim.pose('a/1') == pytest.approx((1.25, 2.5, 0.0), abs=1e-12)


def test_the_world_frame_may_be_named(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', at=(1.0, 2.0), frame='world'))
    assert physsim.pose('a/0') == pytest.approx((1.0, 2.0, 0.0))


# Text


def test_mass_and_density_decide_what_a_force_does(physsim: PhysSim) -> None:
    set_parameter(physsim, 'gravity', [0.0, 0.0])
    physsim.spawn(box('a/0', size=(2.0, 3.0), text='{mass: 4}'))
    physsim.spawn(box('a/1', size=(2.0, 3.0), at=(9.0, 0.0), text='{density: 0.5}'))
    physsim.command(command('a/0', 'a/1', wrenches=[(0.0, 12.0, 0.0)] * 2))
    physsim.run(0.25)
    # m/s: F t / m
    assert physsim.twist('a/0').vy == pytest.approx(12.0 * 0.25 / 4.0)
    assert physsim.twist('a/1').vy == pytest.approx(12.0 * 0.25 / (0.5 * 6.0))


@pytest.mark.parametrize('text', ['{}', '{mass: 0.001}', '{mass: 1000}', '{density: 40}'])
def test_all_bodies_fall_alike(physsim: PhysSim, text: str) -> None:
    physsim.spawn(disc(at=(0.0, 5.0), text=text))
    physsim.run(1.0)
    # m
    assert physsim.pose('body/0').y == pytest.approx(5.0 - 9.81 / 2, abs=1e-9)


@pytest.mark.parametrize('friction', [0.0, 0.25, 1.0])
def test_friction_decides_how_far_a_box_slides(physsim: PhysSim, friction: float) -> None:
    floor = FLOOR.__class__(
        **{name: getattr(FLOOR, name) for name in FLOOR.get_fields_and_field_types()}
    )
    floor.text = '{anchored: true, elasticity: 0, friction: 0.64}'
    physsim.spawn(floor)
    text = f'{{elasticity: 0, friction: {friction}}}'
    physsim.spawn(box(at=(0.0, 0.1), size=(1.0, 0.2), text=text))
    physsim.run(0.2)
    x = physsim.pose('body/0').x
    physsim.command(command('body/0', twists=[(2.0, 0.0, 0.0)]))
    physsim.run(2.0)
    if friction == 0.0:
        assert physsim.twist('body/0').vx == pytest.approx(2.0)
        return
    # m: v²/2µg, with the geometric mean of the two frictions; a step is worth 8 mm
    slid = 2.0**2 / (2 * math.sqrt(friction * 0.64) * 9.81)
    assert physsim.pose('body/0').x - x == pytest.approx(slid, abs=0.01)


@pytest.mark.parametrize('elasticity', [0.0, 0.5, 1.0])
def test_elasticity_decides_how_high_a_ball_bounces(physsim: PhysSim, elasticity: float) -> None:
    text = f'{{elasticity: {elasticity}, friction: 0}}'
    physsim.spawn(box('floor/0', size=(9.0, 1.0), at=(0.0, -0.5), text='{anchored: true}'))
    physsim.spawn(box('floor/0', size=(9.0, 1.0), at=(0.0, -0.5), text=text))
    physsim.spawn(disc(at=(0.0, 2.5), text=text))
    highest = 0.0
    fallen = False
    for _ in range(80):
        physsim.step()
        vy = physsim.twist('body/0').vy
        fallen = fallen or physsim.pose('body/0').y < 0.6
        if fallen:
            highest = max(highest, vy)
    # m/s: e √2gh, h = 2 m; a frame is worth 0.16 m/s
    assert highest == pytest.approx(elasticity * math.sqrt(2 * 9.81 * 2.0), abs=0.17)


def test_velocity_and_spin_are_those_of_the_centre_of_mass(physsim: PhysSim) -> None:
    set_parameter(physsim, 'gravity', [0.0, 0.0])
    text = '{velocity: [3, -1], spin: 2}'
    physsim.spawn(polygon('a/0', outline=ELL.outline, text=text, at=(1.0, 2.0, 0.3)))
    body = physsim.node.simulation.world.snapshot()
    before = body.centers[0]
    physsim.run(1.0)
    after = physsim.node.simulation.world.snapshot().centers[0]
    assert after - before == pytest.approx((3.0, -1.0))
    assert physsim.twist('a/0') == pytest.approx((3.0, -1.0, 2.0))
    assert physsim.pose('a/0').yaw == pytest.approx(0.3 + 2.0)


def test_what_is_anchored_stays_whatever_hits_it(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', text='{anchored: true}', at=(0.0, 0.0, 0.2)))
    physsim.spawn(disc('b/0', at=(-3.0, 0.0), text='{mass: 1000, velocity: [20, 0]}'))
    physsim.run(1.0)
    assert physsim.pose('a/0') == pytest.approx((0.0, 0.0, 0.2))
    assert physsim.twist('a/0') == (0.0, 0.0, 0.0)
    assert physsim.pose('b/0').x < 0.0


def test_what_is_kinematic_moves_whatever_it_touches_and_pushes(physsim: PhysSim) -> None:
    physsim.spawn(FLOOR)
    text = '{kinematic: true, velocity: [1, 0], spin: 0}'
    physsim.spawn(box('a/0', at=(0.0, 0.55), text=text))
    physsim.spawn(box('b/0', at=(2.0, 0.5), text='{density: 1000}'))
    physsim.run(3.0)
    assert physsim.pose('a/0') == pytest.approx((3.0, 0.55, 0.0))
    assert physsim.twist('a/0') == pytest.approx((1.0, 0.0, 0.0))
    # m: it pushes the box before it
    assert physsim.pose('b/0').x == pytest.approx(4.0, abs=0.05)


@pytest.mark.parametrize(
    ('one', 'other', 'what'),
    [
        (0, 0, 'meet'),
        (3, 3, 'pass'),
        (-3, -3, 'pass'),
        (3, 4, 'meet'),
        (3, -3, 'meet'),
        (0, 3, 'meet'),
    ],
)
def test_bodies_of_one_group_pass_through_each_other(
    physsim: PhysSim, one: int, other: int, what: str
) -> None:
    physsim.spawn(box('a/0', text=f'{{anchored: true, group: {one}}}'))
    physsim.spawn(disc('b/0', at=(0.0, 2.0), text=f'{{group: {other}, elasticity: 0}}'))
    physsim.run(2.0)
    assert (physsim.pose('b/0').y < -5.0) is (what == 'pass')


def test_a_sensor_reports_contacts_and_pushes_nothing(physsim: PhysSim) -> None:
    physsim.spawn(box('a/0', text='{anchored: true, sensor: true}'))
    physsim.spawn(disc('b/0', at=(0.0, 2.0)))
    touched = []
    for _ in range(60):
        physsim.step()
        touched += physsim.contacts('a/0')
    assert {(each.a, each.b) for each in touched} == {('a/0', 'b/0')}
    # m: it has fallen through as if there were nothing
    assert physsim.pose('b/0').y == pytest.approx(2.0 - 9.81 / 2, abs=1e-9)


@pytest.mark.parametrize(
    ('parameter', 'value'), [('density', 7.0), ('friction', 0.125), ('elasticity', 0.75)]
)
def test_what_is_not_said_comes_from_the_parameters(
    physsim: PhysSim, parameter: str, value: float
) -> None:
    physsim.spawn(box('a/0'))
    old = getattr(body_of(physsim, 'a/0'), parameter)
    set_parameter(physsim, parameter, value)
    physsim.spawn(box('a/1', at=(3.0, 0.0)))
    physsim.spawn(box('a/2', at=(6.0, 0.0), text=f'{{{parameter}: 0.5}}'))
    physsim.spawn(box('a/0', at=(0.0, 1.0)))
    values = [getattr(body_of(physsim, f'a/{number}'), parameter) for number in range(3)]
    assert values == [old, value, 0.5]


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


def test_an_array_of_thousands_is_answered_one_by_one(physsim: PhysSim, client: Client) -> None:
    markers = [disc(f'a/{number}', at=(2.0 * number, 0.0)) for number in range(3000)]
    events = client.ask('~/spawn_array', MarkerArray(markers=markers))
    assert [event.hardware_id for event in events] == [f'a/{number}' for number in range(3000)]
    assert physsim.names == tuple(f'a/{number}' for number in range(3000))
