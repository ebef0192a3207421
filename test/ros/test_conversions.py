# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages become requests that mean the same, or are refused with the code and field at fault."""

from __future__ import annotations

import math
import tracemalloc
from typing import Any

from geometry_msgs.msg import Point, Quaternion
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import (
    BadOutline,
    BadProperty,
    BadSize,
    Malformed,
    NotPlanar,
    Refusal,
    UnknownShape,
)
from physsim_ros.model.requests import (
    Anchor,
    Axle,
    Command,
    Delete,
    DeleteAll,
    Pin,
    Release,
    Spawn,
)
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, MOST_POINTS, Triangles
from physsim_ros.ros.requests.conversions import (
    body_request,
    command_request,
    memory_of,
    name_of,
    point_request,
)
from physsim_ros.ros.requests.request_topics import RequestTopics
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation import request_queue
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.testing import box, command, delete, delete_all, marker, point
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray, UVCoordinate

from ..building import ELL

NAN, INF = math.nan, math.inf
SQUARE = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))


def spawn_of(message: Marker) -> Spawn:
    request = body_request(message, frame_id='map')
    assert isinstance(request, Spawn)
    return request


def yaw_of(x: float, y: float, z: float, w: float) -> float:
    message = box()
    message.pose.orientation = Quaternion(x=x, y=y, z=z, w=w)
    return spawn_of(message).pose[2]


def command_request_of(message: MultiDOFJointState) -> Command:
    return command_request(message, frame_id='map')


def refusal_of(message: Marker) -> Refusal:
    with pytest.raises(Refusal) as caught:
        body_request(message, frame_id='map')
    return caught.value


# Names, frames, actions


def test_a_marker_without_a_namespace_is_a_body_of_the_default_one() -> None:
    assert name_of(Marker(id=7)) == 'body/7'
    assert name_of(Marker(ns='a/b', id=-7)) == 'a/b/-7'
    assert spawn_of(Marker(type=Marker.CUBE, scale=box().scale)).name == 'body/0'


@pytest.mark.parametrize(('frame', 'meant'), [('', ''), ('map', ''), ('a/0', 'a/0')])
def test_the_world_frame_has_two_spellings(frame: str, meant: str) -> None:
    assert spawn_of(box(frame=frame)).frame == meant
    assert point_request(Anchor, point(1, 2, frame), frame_id='map').frame == meant
    assert point_request(Release, point(1, 2, frame), frame_id='map').frame == meant
    assert command_request_of(command('a/0', frame=frame)).frame == meant


def test_stamps_and_z_are_ignored() -> None:
    plain, odd = box(at=(1, 2, 0.3)), box(at=(1, 2, 0.3))
    odd.header.stamp.sec = 1_700_000_000
    odd.pose.position.z = NAN
    odd.scale.z = -1.0
    assert spawn_of(odd) == spawn_of(plain)


def test_actions_add_delete_and_delete_all() -> None:
    assert body_request(delete('a/3'), frame_id='map') == Delete(name='a/3')
    assert body_request(delete_all(), frame_id='map') == DeleteAll(namespace=None)
    assert body_request(delete_all('a/b'), frame_id='map') == DeleteAll(namespace='a/b')


def test_a_deletion_needs_nothing_but_the_name() -> None:
    message = marker(99, 'a/0', action=Marker.DELETE, scale=(NAN, -1.0), text='{')
    message.pose.orientation = Quaternion(x=1.0)
    assert body_request(message, frame_id='map') == Delete(name='a/0')


@pytest.mark.parametrize('namespace', ['a\nb', 'a\0b', 'x' * 1001, '\ud800'])
def test_a_name_that_no_message_can_carry_is_refused(namespace: str) -> None:
    message = box()
    # rclpy cannot send all of these, but others may.
    message._ns = namespace  # noqa: SLF001
    assert isinstance(refusal_of(message), Malformed)


# Rotations


@pytest.mark.parametrize('yaw', [0.0, 1e-9, 0.7, -0.7, 1.5707963, 3.0, -3.1])
def test_a_yaw_comes_back(yaw: float) -> None:
    # rad; sin, cos and atan2 round once each
    assert yaw_of(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)) == pytest.approx(yaw, abs=1e-15)


def test_a_rotation_of_all_zeros_is_the_identity() -> None:
    assert yaw_of(0.0, 0.0, 0.0, 0.0) == 0.0


@pytest.mark.parametrize('scale', [1e-320, 1e-200, 1e-3, 2.0, 1e200, 1e308])
def test_a_rotation_of_any_length_is_normalised(scale: float) -> None:
    z, w = math.sin(0.35) * scale, math.cos(0.35) * scale
    # rad; the smallest numbers of all, 1e-320, have but three digits
    assert yaw_of(0.0, 0.0, z, w) == pytest.approx(0.7, abs=1e-3 if scale < 1e-300 else 1e-15)


@pytest.mark.parametrize('axis', ['x', 'y'])
@pytest.mark.parametrize('yaw', [0.0, 2.5])
def test_a_tilt_of_less_than_a_milliradian_counts_as_none(axis: str, yaw: float) -> None:
    # Tilted first, then turned: roll and pitch are those of the fixed order x, y, z.
    def tilted(tilt: float) -> float:
        half, turn = tilt / 2, yaw / 2
        tip, w = math.sin(half), math.cos(half)
        z, c = math.sin(turn), math.cos(turn)
        if axis == 'x':
            return yaw_of(c * tip, z * tip, z * w, c * w)
        return yaw_of(-z * tip, c * tip, z * w, c * w)

    # rad; the tilt itself moves the yaw by at most its square
    assert tilted(0.9e-3) == pytest.approx(yaw, abs=1e-6)
    assert tilted(-0.9e-3) == pytest.approx(yaw, abs=1e-6)
    for tilt in (1.1e-3, -1.1e-3, 0.5, math.pi):
        with pytest.raises(NotPlanar) as caught:
            tilted(tilt)
        assert caught.value.field == 'pose.orientation'


# Colour, lifetime


def test_a_colour_of_alpha_0_asks_for_one() -> None:
    assert spawn_of(box(color=(1.0, 0.5, 0.25, 0.0))).color is None
    assert spawn_of(box(color=(1.0, 0.5, 0.25, 1.0))).color == (1.0, 0.5, 0.25, 1.0)
    assert spawn_of(box(color=(0.0, 0.0, 0.0, 0.5))).color == (0.0, 0.0, 0.0, 0.5)


def test_a_lifetime_is_in_seconds() -> None:
    assert spawn_of(box(lifetime=2.25)).lifetime == 2.25
    assert spawn_of(box()).lifetime == 0.0


# Shapes


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


@pytest.mark.parametrize('kind', BODIES)
def test_every_kind_of_marker_is_a_shape_of_its_own(kind: str) -> None:
    type_, scale, points, shape = BODIES[kind]
    spawn = spawn_of(marker(type_, 'a/3', scale=scale, points=points, at=(1.0, 2.0, 0.5)))
    assert (spawn.name, spawn.shape) == ('a/3', shape)
    assert spawn.pose == pytest.approx((1.0, 2.0, 0.5))


def test_a_text_is_a_note_whose_box_has_room_for_it() -> None:
    kind, size = Marker.TEXT_VIEW_FACING, (0.0, 0.0, 0.3)
    note = spawn_of(marker(kind, 'note/0', text='{mass: 1}\nm', at=(1, 2), scale=size))
    again = spawn_of(marker(kind, 'note/0', text='{mass: 1}\nm', scale=(0.0, 0.0, 0.6)))

    assert note.properties == Properties(anchored=True, sensor=True, label='{mass: 1}\nm')
    assert note.pose == (1.0, 2.0, 0.0)
    assert isinstance(note.shape, Box)
    assert isinstance(again.shape, Box)
    # Nine characters and two lines of letters 0.3 m high.
    assert 9 * 0.15 < note.shape.width < 9 * 0.45
    assert 0.6 < note.shape.height < 1.8
    assert again.shape.width == pytest.approx(2 * note.shape.width)


@pytest.mark.parametrize(
    'kind', [Marker.LINE_STRIP, Marker.TRIANGLE_LIST, Marker.CUBE_LIST, Marker.SPHERE_LIST]
)
def test_more_points_than_may_be_are_refused_at_once(kind: int) -> None:
    many = [(float(number), float(number % 7)) for number in range(100_000)]
    # Not looked at: what is too much is refused before it is read.
    many[-1] = (math.nan, 0.0)
    refusal = refusal_of(marker(kind, points=many))
    assert (type(refusal), refusal.field) == (BadOutline, 'points')
    assert str(MOST_POINTS) in str(refusal)


# Commands


def test_a_command_takes_what_lies_in_the_plane() -> None:
    message = command('a/0', 'a/1', twists=[(1, 2, 3), (4, 5, 6)], wrenches=[(7, 8, 9), (0, 0, 0)])
    message.twist[0].linear.z = message.twist[0].angular.x = NAN
    message.wrench[0].force.z = message.wrench[0].torque.y = NAN
    request = command_request_of(message)
    assert request.names == ('a/0', 'a/1')
    assert request.poses.tolist() == []
    assert request.twists.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert request.wrenches.tolist() == [[7, 8, 9], [0, 0, 0]]


def test_a_commanded_pose_is_read_as_a_markers_pose_is() -> None:
    message = command('a/0', poses=[(1, 2, 0.7)])
    (pose,) = command_request_of(message).poses.tolist()
    assert tuple(pose) == spawn_of(box(at=(1, 2, 0.7))).pose
    message.transforms[0].rotation = Quaternion(x=0.0, y=0.0, z=0.0, w=0.0)
    assert command_request_of(message).poses.tolist() == [[1.0, 2.0, 0.0]]
    message.transforms[0].rotation = Quaternion(x=1.0)
    with pytest.raises(NotPlanar) as caught:
        command_request_of(message)
    assert caught.value.field == 'transforms'


@pytest.mark.parametrize(
    ('message', 'field'),
    [
        (command(), 'joint_names'),
        (command('a/0', 'a/0'), 'joint_names'),
        (command('a/0', poses=[(0, 0, 0)] * 2), 'transforms'),
        (command('a/0', 'a/1', twists=[(0, 0, 0)]), 'twist'),
        (command('a/0', 'a/1', wrenches=[(0, 0, 0)] * 3), 'wrench'),
        (command(poses=[(0, 0, 0)]), 'joint_names'),
        (command('a/0', poses=[(NAN, 0, 0)]), 'transforms'),
        (command('a/0', twists=[(0, INF, 0)]), 'twist'),
        (command('a/0', twists=[(0, 0, NAN)]), 'twist'),
        (command('a/0', wrenches=[(-INF, 0, 0)]), 'wrench'),
        (command('a/0', wrenches=[(0, 0, NAN)]), 'wrench'),
    ],
)
def test_a_command_that_does_not_fit_is_malformed(message: Any, field: str) -> None:
    with pytest.raises(Malformed) as caught:
        command_request_of(message)
    assert caught.value.field == field


# Refusals


LINE, CORNERS, CUBES = Marker.LINE_STRIP, Marker.TRIANGLE_LIST, Marker.CUBE_LIST


def marker_of(
    kind: int, *points: tuple[float, float], scale: tuple[float, ...] = (1, 1)
) -> Marker:
    return marker(kind, scale=scale, points=points or [(0, 0), (1, 0), (0, 1)])


@pytest.mark.parametrize(
    ('message', 'error', 'field'),
    [
        (Marker(type=Marker.CUBE), BadSize, 'scale.x'),
        *((marker(Marker.CUBE, action=each), BadProperty, 'action') for each in (1, 4, -1)),
        *((marker_of(kind), UnknownShape, 'type') for kind in (0, 5, 8, 10, 12, -1, 99)),
        *((box(at=at), Malformed, 'pose') for at in ((NAN, 0.0), (0.0, -INF))),
        (box(color=(1.5, 0.0, 0.0, 1.0)), BadProperty, 'color'),
        (box(color=(0.0, 0.0, 0.0, -1.0)), BadProperty, 'color'),
        (box(color=(0.0, 0.0, INF, 1.0)), Malformed, 'color'),
        (box(lifetime=-1.5), BadProperty, 'lifetime'),
        (marker_of(Marker.CUBE, scale=(1.0, -1.0)), BadSize, 'scale.y'),
        (marker_of(Marker.CUBE, scale=(1e6, 1.0)), BadSize, 'scale.x'),
        (marker_of(Marker.CUBE, scale=(1.0, INF)), Malformed, 'scale.y'),
        (marker_of(Marker.CYLINDER, scale=(0.0, 0.0)), BadSize, 'scale.x'),
        (marker_of(Marker.CYLINDER, scale=(1.0, 1.0000001)), BadSize, 'scale.y'),
        (marker_of(Marker.SPHERE, scale=(1.0, NAN)), Malformed, 'scale.y'),
        (marker_of(Marker.SPHERE_LIST, scale=(1.0, 1.1)), BadSize, 'scale.y'),
        (marker_of(LINE, scale=(0.0, 0.0)), BadSize, 'scale.x'),
        (marker_of(CUBES, scale=(1.0, 0.0)), BadSize, 'scale.y'),
        (marker_of(CORNERS, scale=(-1.0, 1.0)), BadSize, 'scale'),
        (marker_of(CORNERS, scale=(1.0, INF)), Malformed, 'scale'),
        (marker_of(LINE, (0, 0), (0, 0)), BadOutline, 'points'),
        (marker_of(LINE, (0, 0), (1, 0), (0, 0)), BadOutline, 'points'),
        (marker_of(LINE, (0, 0), (1, 1), (1, 0), (0, 1), (0, 0)), BadOutline, 'points'),
        (marker_of(LINE, (0, 0), (NAN, 0), (1, 1)), Malformed, 'points'),
        (marker_of(CORNERS, (0, 0), (1, 0)), BadOutline, 'points'),
        (marker_of(CORNERS, (0, 0), (1, 0), (2, 0)), BadOutline, 'points'),
        (marker(CUBES, scale=(1.0, 1.0)), BadOutline, 'points'),
        (marker_of(CUBES, (1e6, 0)), BadSize, 'points'),
        (marker_of(Marker.SPHERE_LIST, (NAN, 0)), Malformed, 'points'),
    ],
)
def test_a_marker_that_is_no_body_is_refused_by_its_field(
    message: Marker, error: type[Refusal], field: str
) -> None:
    refusal = refusal_of(message)
    assert (type(refusal), refusal.field) == (error, field)


@pytest.mark.parametrize('number', [NAN, INF, -INF])
def test_a_rotation_or_point_that_is_not_finite_is_refused(number: float) -> None:
    for field in 'xyzw':
        message = box()
        setattr(message.pose.orientation, field, number)
        refusal = refusal_of(message)
        assert (type(refusal), refusal.field) == (Malformed, 'pose.orientation')
    for kind in (Anchor, Release, Pin, Axle):
        for at in ((number, 0.0), (0.0, number)):
            with pytest.raises(Malformed):
                point_request(kind, point(*at), frame_id='map')


POINTS = [Point(x=float(number)) for number in range(1000)]


@pytest.mark.parametrize(
    'fields',
    [
        {},
        {'points': POINTS},
        {'colors': [ColorRGBA(g=number / 1e3) for number in range(1000)]},
        {'uv_coordinates': [UVCoordinate(u=number / 1e3) for number in range(1000)]},
        *({each: 'x' * 100_000} for each in ('ns', 'text', 'mesh_resource', 'texture_resource')),
    ],
)
def test_the_memory_of_a_marker_is_known_to_a_factor_of_two(fields: dict[str, Any]) -> None:
    array = MarkerArray(markers=[Marker(id=number, **fields) for number in range(10)])
    data = serialize_message(array)
    tracemalloc.start()
    try:
        array = deserialize_message(data, MarkerArray)
        memory, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert memory / 2 < sum(map(memory_of, array.markers)) < 2 * memory


class Topics:
    """The topics of a node, to which a test sends bytes."""

    def __init__(self) -> None:
        self.receive: dict[str, Any] = {}

    def create_subscription(self, _: type, topic: str, receive: Any, *__: Any, raw: bool) -> None:
        """Subscribe, as a node does."""
        assert raw
        self.receive[topic] = receive


def test_markers_of_an_array_wait_within_the_memory_that_they_have(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    topics, simulation = Topics(), Simulation(speed=0.0)
    RequestTopics(topics, simulation.requests, ErrorBoundary(), 'map')
    markers = [box(f'a/{number}', at=(2.0 * number, 0.0)) for number in range(5)]
    for each in markers:
        each.points = POINTS
    array = MarkerArray(markers=markers)
    monkeypatch.setattr(request_queue, 'MOST_BYTES', 3 * memory_of(markers[0]))
    topics.receive['~/spawn_array'](serialize_message(array))
    frame = simulation.apply_requests()
    assert frame is not None
    assert [each.code for each in frame.answers] == [''] * 3 + ['busy'] * 2
