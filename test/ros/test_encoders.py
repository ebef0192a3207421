# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Encoders write the bytes that rclpy writes for the same message built of objects."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from geometry_msgs.msg import (
    Point,
    Pose,
    PoseArray,
    Quaternion,
    Transform,
    Twist,
    Vector3,
    Wrench,
)
from hypothesis import example, given, settings
from hypothesis import strategies as st
import numpy as np
from physsim_ros.model.answer import Answer
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, Triangles
from physsim_ros.model.snapshot import Contacts, Frame, Snapshot
from physsim_ros.model.spelling import canonical
from physsim_ros.ros.encoders.markers import DELETION, MarkersEncoder, MOST_NEW
from physsim_ros.ros.encoders.streams import (
    ClockEncoder,
    ContactsEncoder,
    PosesEncoder,
    StatesEncoder,
)
from physsim_ros.ros.publishers.event_publisher import encode_event
from physsim_ros.ros.requests.conversions import body_request
from physsim_ros.simulation.world import World
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray
import yaml

from ..building import join, PLAIN_BODY, spawn

# Frames a second [Hz].
RATE = 60.0
# Every shape, and the type, scale and points of the marker that spawns it.
CORNERS = ((0.0, 0.0), (2.0, 0.0), (0.5, 0.5), (0.0, 2.0))
SHAPES = (
    (Disc(radius=0.35), Marker.CYLINDER, (0.7, 0.7, 0.02), ()),
    (Box(width=1.5, height=0.25), Marker.CUBE, (1.5, 0.25, 0.02), ()),
    (Polygon(outline=CORNERS), Marker.LINE_STRIP, (0.02, 0, 0), (*CORNERS, CORNERS[0])),
    (Chain(points=CORNERS, thickness=0.1), Marker.LINE_STRIP, (0.1, 0, 0), CORNERS),
    (Triangles(vertices=CORNERS[:3]), Marker.TRIANGLE_LIST, (1, 1, 1), CORNERS[:3]),
    (
        Compound(element=Disc(radius=0.5), centers=CORNERS),
        Marker.SPHERE_LIST,
        (1, 1, 0.02),
        CORNERS,
    ),
    (
        Compound(element=Box(width=0.5, height=0.25), centers=CORNERS[1:2]),
        Marker.CUBE_LIST,
        (0.5, 0.25, 0.02),
        CORNERS[1:2],
    ),
)
PLAIN = replace(
    PLAIN_BODY,
    name='body/0',
    shape=SHAPES[0][0],
    color=(0.3, 0.5, 0.7, 1.0),
    elasticity=0.25,
)
PLAIN_TEXT = '{density: 1.0, friction: 0.5, elasticity: 0.25}'

# Every padding, in bytes too: characters of one to four bytes each.
names = st.text('aß€😀', min_size=1, max_size=40)


def bodies_named(*namespaces):
    return tuple(
        replace(PLAIN, name=f'{namespace}/{row}', shape=SHAPES[row % len(SHAPES)][0])
        for row, namespace in enumerate(namespaces)
    )


def snapshot_of(bodies, seed=0, stamp=12_345_678_901, bounds=None):
    rng = np.random.default_rng(seed)
    scene = Scene(bodies=tuple(bodies), settings=WorldSettings(bounds=bounds))
    return moved(scene, rng, stamp)


def frame_of(snapshot, contacts=None):
    return Frame(snapshot=snapshot, contacts=contacts)


def moved(scene, rng, stamp=12_345_678_901):
    shape = (len(scene.bodies), 3)
    poses, twists = rng.normal(scale=5, size=shape), rng.normal(scale=5, size=shape)
    return Snapshot(step=1, stamp=stamp, scene=scene, poses=poses, twists=twists)


def contacts_of(pairs, seed=0):
    rng = np.random.default_rng(seed)
    shape = (len(pairs), 2)
    angles = rng.uniform(-np.pi, np.pi, len(pairs))
    return Contacts(
        pairs=np.array(pairs, np.int64).reshape(shape),
        points=rng.normal(size=shape),
        normals=np.column_stack((np.cos(angles), np.sin(angles))),
        impulses=rng.normal(size=shape),
    )


def decoded(data, kind):
    return deserialize_message(data, kind)


def check_same(data, expected):
    """Compare with a message built of objects, in bytes that rclpy itself made of it."""
    wanted = serialize_message(expected)
    assert decoded(data, type(expected)) == decoded(wanted, type(expected))
    assert len(data) == len(wanted)


def header(snapshot, frame_id='world'):
    sec, nanosec = divmod(snapshot.stamp, 1_000_000_000)
    return Header(stamp=Time(sec=sec, nanosec=nanosec), frame_id=frame_id)


def turns_of(snapshot):
    half = snapshot.poses[:, 2] / 2
    pairs = zip(np.sin(half).tolist(), np.cos(half).tolist(), strict=True)
    return [Quaternion(z=z, w=w) for z, w in pairs]


def poses_of(snapshot):
    return [
        Pose(position=Point(x=x, y=y), orientation=turn)
        for (x, y, _), turn in zip(snapshot.poses.tolist(), turns_of(snapshot), strict=True)
    ]


def pose_array(snapshot, frame_id='world'):
    return PoseArray(header=header(snapshot, frame_id), poses=poses_of(snapshot))


def body_states(snapshot, frame_id='world'):
    return MultiDOFJointState(
        header=header(snapshot, frame_id),
        joint_names=list(snapshot.scene.names),
        transforms=[
            Transform(translation=Vector3(x=x, y=y), rotation=turn)
            for (x, y, _), turn in zip(snapshot.poses.tolist(), turns_of(snapshot), strict=True)
        ],
        twist=[
            Twist(linear=Vector3(x=x, y=y), angular=Vector3(z=spin))
            for x, y, spin in snapshot.twists.tolist()
        ],
    )


def contact_states(snapshot, contacts, turns, frame_id='world'):
    bodies = (*snapshot.scene.names, 'world')
    return MultiDOFJointState(
        header=header(snapshot, frame_id),
        joint_names=[f'{bodies[a]}|{bodies[b]}' for a, b in contacts.pairs.tolist()],
        transforms=[
            Transform(translation=Vector3(x=x, y=y), rotation=turn)
            for (x, y), turn in zip(contacts.points.tolist(), turns, strict=True)
        ],
        wrench=[Wrench(force=Vector3(x=x, y=y)) for x, y in contacts.impulses.tolist()],
    )


def check_contacts(data, snapshot, contacts, frame_id='world'):
    turns = [each.rotation for each in decoded(data, MultiDOFJointState).transforms]
    # Half the angle is the square root, where a turn is a complex number; a few roundings off.
    roots = np.sqrt(contacts.normals @ (1, 1j))
    assert np.array([turn.w + 1j * turn.z for turn in turns]) == pytest.approx(roots, abs=1e-15)
    assert all(turn.x == turn.y == 0 for turn in turns)
    check_same(data, contact_states(snapshot, contacts, turns, frame_id))


def marker_array(snapshot, frame_id='world', text=PLAIN_TEXT):
    looks = {shape: look for shape, *look in SHAPES}
    markers = []
    for body, pose in zip(snapshot.scene.bodies, poses_of(snapshot), strict=True):
        namespace, _, number = body.name.rpartition('/')
        kind, scale, points = looks[body.shape]
        markers.append(
            Marker(
                header=header(snapshot, frame_id),
                ns=namespace,
                id=int(number),
                type=kind,
                action=Marker.ADD,
                pose=pose,
                scale=Vector3(**dict(zip('xyz', map(float, scale), strict=True))),
                color=ColorRGBA(**dict(zip('rgba', body.color, strict=True))),
                points=[Point(x=x, y=y) for x, y in points],
                text=text,
            )
        )
    return MarkerArray(markers=markers)


def picture(encoder, snapshot):
    return decoded(encoder.encode(frame_of(snapshot)), MarkerArray).markers


def drawn(markers, action=Marker.ADD):
    return [f'{marker.ns}/{marker.id}' for marker in markers if marker.action == action]


ENCODERS = (
    (PosesEncoder, pose_array),
    (StatesEncoder, body_states),
    (partial(MarkersEncoder, publish_rate=RATE), marker_array),
)


@pytest.mark.parametrize(('encoder', 'expected'), ENCODERS)
def test_any_number_of_bodies_is_encoded_as_rclpy_does_and_stays_as_it_was(encoder, expected):
    for count in (0, 1, 2, 500):
        snapshot, encode = snapshot_of(bodies_named(*['body'] * count)), encoder('world').encode
        later = moved(snapshot.scene, np.random.default_rng(7), stamp=98_000_000_007)
        messages = [encode(frame_of(each)) for each in (snapshot, later)]
        check_same(messages[0], expected(snapshot))
        check_same(messages[1], expected(later))


@pytest.mark.parametrize(('encoder', 'expected'), ENCODERS[:2])
def test_a_changed_scene_is_encoded_anew(encoder, expected):
    few, many = bodies_named('a', 'bb'), bodies_named('ccc', 'a', 'bb', 'dddd')
    encode = encoder('world').encode
    for bodies in (few, many, (), few):
        snapshot = snapshot_of(bodies)
        check_same(encode(frame_of(snapshot)), expected(snapshot))


@settings(deadline=None)
@given(namespaces=st.lists(names, max_size=8), frame_id=st.one_of(st.just(''), names))
def test_names_of_any_length_are_encoded_as_rclpy_does(namespaces, frame_id):
    snapshot = snapshot_of(bodies_named(*namespaces))
    count = len(namespaces)
    contacts = contacts_of([(a, b) for a in range(count) for b in range(-1, count) if a != b])
    for encoder, expected in ENCODERS:
        data = encoder(frame_id).encode(frame_of(snapshot))
        check_same(data, expected(snapshot, frame_id))
    check_contacts(
        ContactsEncoder(frame_id).encode(frame_of(snapshot, contacts)),
        snapshot,
        contacts,
        frame_id,
    )


def test_contacts_follow_their_pairs_and_their_scene():
    encoder = ContactsEncoder('world')
    first, second = snapshot_of(bodies_named('a', 'b', 'c')), snapshot_of(bodies_named('d', 'e'))
    steps = [
        (first, contacts_of([])),
        (first, contacts_of([(0, 1), (1, -1)], seed=1)),
        (first, contacts_of([(0, 1), (1, -1)], seed=2)),
        (first, contacts_of([(0, 2), (1, -1)], seed=3)),
        (second, contacts_of([(0, 1), (1, -1)], seed=4)),
        (first, contacts_of([(0, 1), (1, -1)], seed=5)),
        (second, contacts_of([])),
    ]
    for snapshot, contacts in steps:
        check_contacts(encoder.encode(frame_of(snapshot, contacts)), snapshot, contacts)


@pytest.mark.parametrize('shape', [shape for shape, *_ in SHAPES], ids=repr)
def test_a_marker_spawns_the_body_that_it_draws(shape):
    body = replace(PLAIN, name='a/b/-7', shape=shape, color=(0.25, 0.5, 1.0, 0.75))
    snapshot = snapshot_of([body])
    (marker,) = picture(MarkersEncoder('world', RATE), snapshot)
    spawn = body_request(marker, frame_id='world')
    assert (spawn.name, spawn.frame, spawn.lifetime) == ('a/b/-7', '', 0)
    assert (spawn.shape, spawn.color) == (body.shape, body.color)
    x, y, yaw = snapshot.poses[0]
    assert spawn.pose[:2] == (x, y)
    # A whole turn more or less, and some roundings of an angle below 100.
    assert np.exp(1j * spawn.pose[2]) == pytest.approx(np.exp(1j * yaw), abs=1e-13)


def test_the_marker_of_a_chain_whose_ends_meet_is_no_polygon():
    shape = Chain(points=((0.0, 0.0), (2.0, 0.0), (1.0, 1.0), (0.0, 0.0)), thickness=0.1)
    body = replace(PLAIN, name='ring/0', shape=shape)
    (marker,) = picture(MarkersEncoder('world', RATE), snapshot_of([body]))
    again = body_request(marker, frame_id='world').shape
    assert isinstance(again, Chain)
    assert np.array(again.points) == pytest.approx(np.array(shape.points), abs=1e-300)


numbers = st.floats(1e-9, 1e12)
labels = st.text(
    st.characters(exclude_categories=('Cc', 'Cs', 'Cf', 'Zl', 'Zp'))
    | st.sampled_from('\n[{\ufeff'),
    max_size=60,
).map(canonical)


bodies = st.builds(
    replace,
    st.just(PLAIN),
    mass=st.none() | numbers,
    density=numbers,
    friction=st.floats(0, 10),
    elasticity=st.floats(0, 1),
    group=st.integers(-(2**31), 2**31 - 1),
    sensor=st.booleans(),
    label=labels,
)


@settings(deadline=None)
@given(body=bodies, role=st.sampled_from(['', 'anchored', 'kinematic']))
@example(body=replace(PLAIN, label='say "mass": 1, {"a": b'), role='')
def test_the_text_of_a_marker_gives_back_the_properties_of_its_body(body, role):
    expected = {'friction': body.friction, 'elasticity': body.elasticity}
    expected |= {'density': body.density} if body.mass is None else {'mass': body.mass}
    expected |= {'group': body.group} if body.group else {}
    expected |= {'sensor': True} if body.sensor else {}
    expected |= {'label': body.label} if body.label else {}
    if role:
        body = replace(body, **{role: True})
        expected[role] = True
    marker, *_ = picture(MarkersEncoder('world', RATE), snapshot_of([body]))
    assert body_request(marker, frame_id='world').properties.explicit() == expected
    # PyYAML by itself reads YAML 1.1, in which 1e-09 is a string.
    assert yaml.safe_load(marker.text) == expected


ROBOT = {'drive': {'kind': 'omni'}, 'sensors': [{'kind': 'laser', 'noise': 1e-9}, {'kind': 'imu'}]}
ACTOR = {'kind': 'path', 'points': [[0, 0], [1, 2]], 'speed': 1e5, 'start': {'gate': 'a [{b/0'}}


@pytest.mark.parametrize(
    'said',
    [{'surface_velocity': (1e-9, 1.0), 'sensor': True}, {'robot': ROBOT}, {'actor': ACTOR}],
)
def test_a_body_in_a_role_is_made_again_by_its_marker(said):
    properties = Properties(**said)
    body = replace(PLAIN, **properties.explicit())
    marker, *_ = picture(MarkersEncoder('world', RATE), snapshot_of([body]))
    again = body_request(marker, frame_id='world').properties
    assert again == replace(
        properties, density=PLAIN.density, friction=PLAIN.friction, elasticity=PLAIN.elasticity
    )


@pytest.mark.parametrize(
    ('shape', 'size'),
    [
        (Box(width=0.02, height=0.02), 0.06),
        (Box(width=10, height=0.5), 0.5 / 3),
        (Disc(radius=0.3), 0.2),
        (Disc(radius=30), 0.3),
        (SHAPES[2][0], None),
    ],
    ids=repr,
)
@pytest.mark.parametrize('color', [(0.0, 0.0, 0.1, 1.0), (1.0, 1.0, 0.8, 1.0)])
def test_an_anchored_body_carries_a_cross_at_its_centre_of_mass(shape, size, color):
    body = replace(PLAIN, name='walls/7', shape=shape, color=color, anchored=True)
    snapshot = snapshot_of([PLAIN, body])
    _, marker, symbol = picture(MarkersEncoder('world', RATE), snapshot)
    assert marker.text == '{density: 1.0, friction: 0.5, elasticity: 0.25, anchored: true}'
    assert (symbol.ns, symbol.id, symbol.type) == ('anchor:walls', 7, Marker.LINE_LIST)
    assert (symbol.pose, symbol.header) == (poses_of(snapshot)[1], header(snapshot))
    points = np.array([(point.x, point.y) for point in symbol.points])
    assert points.mean(axis=0) == pytest.approx(body.shape.form.centroid, abs=1e-12)
    # Two strokes of one length that cross at right angles, above the body; about a third of its
    # smaller side.
    first, second = points[1] - points[0], points[3] - points[2]
    assert np.linalg.norm(first) == pytest.approx(np.linalg.norm(second))
    assert first @ second == pytest.approx(0)
    assert size is None or np.ptp(points[:, 0]) == pytest.approx(size, rel=0.25)
    assert all(point.z > 0.01 for point in symbol.points)
    assert abs(symbol.color.g - marker.color.g) > 0.7


def test_the_walls_are_drawn_where_the_bounds_are():
    encoder = MarkersEncoder('world', RATE)
    _, walls = picture(encoder, snapshot_of([PLAIN], bounds=(-1, 0, 4, 3)))
    assert (walls.ns, walls.id, walls.type) == ('physsim:bounds', 0, Marker.LINE_STRIP)
    assert walls.pose == Pose()
    corners = [(-1, 0), (4, 0), (4, 3), (-1, 3), (-1, 0)]
    assert [(point.x, point.y) for point in walls.points] == corners
    assert drawn(picture(encoder, snapshot_of([PLAIN])), Marker.DELETE) == ['physsim:bounds/0']


def test_of_a_scene_of_thousands_some_are_serialised_for_each_frame():
    count = 2 * MOST_NEW
    bodies = [replace(PLAIN, name=f'body/{number}') for number in range(count)]
    encoder = MarkersEncoder('world', RATE)
    assert encoder.encode(frame_of(snapshot_of(bodies))) is None
    # Those of the scene before hold in another one.
    assert len(picture(encoder, snapshot_of(bodies))) == count
    color = (0.0, 0.0, 0.0, 1.0)
    changed = snapshot_of(
        [
            replace(each, color=color) if number <= MOST_NEW else each
            for number, each in enumerate(bodies)
        ]
    )
    assert encoder.encode(frame_of(changed)) is None
    dark = [each for each in picture(encoder, changed) if each.color.b == 0.0]
    assert len(dark) == MOST_NEW + 1


def test_of_thousands_that_are_gone_some_are_serialised_for_each_frame():
    bodies = [replace(PLAIN, name=f'body/{number}') for number in range(2 * MOST_NEW)]
    encoder = MarkersEncoder('world', RATE)
    assert encoder.encode(frame_of(snapshot_of(bodies))) is None
    picture(encoder, snapshot_of(bodies))
    assert encoder.encode(frame_of(snapshot_of([]))) is None
    gone = picture(encoder, snapshot_of([]))
    assert drawn(gone, Marker.DELETE) == [each.name for each in bodies]


def test_scenes_that_change_in_each_frame_are_drawn_as_each_was_begun():
    encoder = MarkersEncoder('world', RATE)
    scenes = [
        snapshot_of(
            [replace(PLAIN, name=f'turn{turn}/{number}') for number in range(MOST_NEW + 1)]
        )
        for turn in range(4)
    ]
    for begun, ready in (scenes[:2], scenes[2:]):
        assert encoder.encode(frame_of(begun)) is None
        while (message := encoder.encode(frame_of(ready))) is None:
            pass
        told = decoded(message, MarkerArray).markers
        markers = [each for each in told if each.action == Marker.ADD]
        assert drawn(markers) == drawn(marker_array(begun).markers)


def test_a_joint_that_is_changed_is_drawn_as_if_it_were_new():
    world, encoder = World(), MarkersEncoder('world', RATE)
    spawn(world, 'a/0', Disc(radius=0.35))
    for kind in ('rod', 'spring'):
        join(world, kind, [(0.0, 0.0), (3.0, 0.0)], a='a/0', b='world')
        markers = picture(encoder, world.snapshot())
    assert markers == picture(MarkersEncoder('world', RATE), world.snapshot())


@pytest.mark.parametrize('rate', [60.0, 10.0])
def test_what_has_gone_is_deleted_for_a_second_unless_it_comes_back(rate):
    encoder, bodies = MarkersEncoder('world', rate), bodies_named('a', 'b', 'c')
    repeats = round(DELETION * rate)
    encoder.encode(frame_of(snapshot_of([replace(PLAIN, anchored=True), *bodies])))
    # A released body loses its cross alone.
    markers = picture(encoder, snapshot_of([PLAIN, *bodies]))
    assert drawn(markers) == ['body/0', 'a/0', 'b/1', 'c/2']
    assert drawn(markers, Marker.DELETE) == ['anchor:body/0']
    picture(encoder, snapshot_of(bodies[1:]))
    last = snapshot_of(bodies[2:])
    gone = [drawn(picture(encoder, last), Marker.DELETE) for _ in range(repeats + 1)]
    assert all({'body/0', 'a/0', 'b/1'} <= {*each} for each in gone[: repeats - 1])
    assert gone[-2:] == [['b/1'], []]
    check_same(encoder.encode(frame_of(last)), marker_array(last))
    picture(encoder, snapshot_of(bodies[:2]))
    again = snapshot_of(bodies)
    check_same(encoder.encode(frame_of(again)), marker_array(again))


@pytest.mark.parametrize('stamp', [1, 999_999_999, 1_000_000_000, 86_400_000_000_001])
def test_the_clock_has_the_stamp_of_the_frame(stamp):
    sec, nanosec = divmod(stamp, 1_000_000_000)
    frame = frame_of(replace(snapshot_of([PLAIN]), stamp=stamp))
    message = Clock(clock=Time(sec=sec, nanosec=nanosec))
    assert ClockEncoder().encode(frame) == serialize_message(message)


@settings(deadline=None)
@given(
    answer=st.builds(
        Answer,
        topic=names,
        subject=names,
        message=names,
        code=st.just('') | names,
        field=st.just('') | names,
    )
)
def test_an_event_is_encoded_as_rclpy_does(answer):
    values = [KeyValue(key='code', value=answer.code or 'ok')]
    values += [KeyValue(key='field', value=answer.field)] if answer.field else []
    expected = DiagnosticStatus(
        level=DiagnosticStatus.ERROR if answer.code else DiagnosticStatus.OK,
        name=answer.topic,
        hardware_id=answer.subject,
        message=answer.message,
        values=values,
    )
    check_same(encode_event(answer), expected)


def test_an_event_can_tell_of_a_file_name_that_is_no_text():
    answer = Answer(topic='~/load_world', message='no file \udcff.yaml', code='bad_world_file')
    event = decoded(encode_event(answer), DiagnosticStatus)
    assert event.message == 'no file ?.yaml'
