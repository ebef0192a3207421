# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A message with any content is answered once, and the world goes on with finite numbers."""

from __future__ import annotations

from functools import partial
import math
from typing import Any

from builtin_interfaces.msg import Duration
from geometry_msgs.msg import (
    Point,
    PointStamped,
    Pose,
    Quaternion,
    Transform,
    Twist,
    Vector3,
    Wrench,
)
from hypothesis import given, HealthCheck, settings
from hypothesis import strategies as st
import numpy as np
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import Anchor, Axle, Pin, Release
from physsim_ros.model.settings import WorldSettings
from physsim_ros.ros.encoders.markers import MarkersEncoder
from physsim_ros.ros.encoders.streams import ContactsEncoder, PosesEncoder, StatesEncoder
from physsim_ros.ros.planar import rotation_of
from physsim_ros.ros.publishers.status_publishers import encode_event
from physsim_ros.ros.requests import conversions
from physsim_ros.simulation.entries import Origin
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.testing import box, disc
import pytest
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker

NASTY_FLOATS = [
    0.0, -0.0, 5e-324, 1e-320, 1e-200, 1e-9, 1e-3, 0.002, 0.5, 1.0, -1.0, 1e3, 1e5, 1e7, 1e8, 1e12,
    1e150, 1e300, 1.7e308, -1e300, math.nan, math.inf, -math.inf,
]  # fmt: skip
NASTY_TEXTS = [
    '{', '}', '[', '!!bool x', '!!int ""', '!!python/object/apply:os.system [x]', '&a [*a]', '*a',
    '? [a]', '? {a: 1} : 1', '{mass: !!timestamp x}', '{mass: 2001-01-01}', '{mass: 0x10}', '---',
    '--- {}\n---\n{}', '%TAG', '\0', '\ud800', '{~: 1}', '{1: 1}', '{mass: 1e400}',
    '{mass: -.inf}',
    '{velocity: [[1, 2], 3]}', '{velocity: [.nan, 0]}', '{group: 99999999999999999999}', '"', "'",
    '{friction: 1, friction: 2}', '{anchored: true, kinematic: true}', '{"mass": "1"}', '- 1', '#',
    '{<<: {mass: 1}}', '[' * 2000, '{a: ' * 600, 'x' * 10_001, '\N{SNOWMAN}: 1', '{mass: \x85}',
]  # fmt: skip
KEYS = ['mass', 'density', 'friction', 'elasticity', 'velocity', 'spin', 'anchored', 'kinematic',
        'group', 'sensor', 'forces', 'label', 'color']  # fmt: skip
VALUES = ['0', '1', '-1', '0.5', '1e5', '1e-9', '1e12', '.nan', '.inf', 'true', 'false', '[1, 2]',
          '[-1e5, 0]', '[1]', '[]', '~', 'x', '{}', '12345678901234567890']  # fmt: skip
NAMES = ['a/0', 'a/1', 'b/0', 'body/0']
KINDS = ['pin', 'axle', 'motor', 'spring', 'rod', 'rope', 'slider', 'gear', 'rack']
JOINT_KEYS = ['kind', 'a', 'b', 'lower', 'upper', 'rate', 'max_torque', 'stiffness', 'damping',
              'rest_length', 'length', 'ratio', 'phase', 'carrier', 'over', 'ratchet', 'max_force',
              'break_force', 'collide']  # fmt: skip

numbers = st.one_of(
    st.floats(-3.0, 3.0), st.integers(-3, 3).map(float), st.sampled_from(NASTY_FLOATS), st.floats()
)
singles = st.one_of(st.floats(0.0, 1.0, width=32), st.floats(width=32))
namespaces = st.one_of(st.sampled_from(['a', 'b', '', 'body']), st.text(max_size=6))
frames = st.one_of(st.sampled_from(['', 'world', *NAMES]), st.text(max_size=6))
headers = st.builds(Header, frame_id=frames)
quaternions = st.builds(Quaternion, x=numbers, y=numbers, z=numbers, w=numbers)
vectors = st.builds(Vector3, x=numbers, y=numbers, z=numbers)
places = st.builds(Point, x=numbers, y=numbers, z=numbers)
poses = st.builds(Pose, position=places, orientation=quaternions)
# On a grid, so that outlines close, cross and touch themselves.
spots = st.builds(Point, x=st.integers(-2, 2).map(float), y=st.integers(-2, 2).map(float))
turns = st.floats(-4.0, 4.0).map(rotation_of)


def closed(points: list[Point]) -> list[Point]:
    return [*points, *points[:1]]


outlines = st.one_of(
    st.lists(spots, max_size=8),
    st.lists(spots, max_size=8).map(closed),
    st.lists(places, max_size=8),
    st.lists(places, max_size=8).map(closed),
)
said = st.dictionaries(st.sampled_from(KEYS), st.sampled_from(VALUES), max_size=3).map(
    lambda said: '{' + ', '.join(f'{key}: {value}' for key, value in said.items()) + '}'
)
texts = st.one_of(said, st.sampled_from(NASTY_TEXTS), st.text(max_size=20))
# Odd values of a marker, field by field.
ODD: dict[str, st.SearchStrategy[Any]] = {
    'header': headers,
    'ns': namespaces,
    'id': st.integers(-(2**31), 2**31 - 1),
    'type': st.integers(-1, 13),
    'action': st.integers(-1, 4),
    'pose': poses,
    'scale': vectors,
    'color': st.builds(ColorRGBA, r=singles, g=singles, b=singles, a=singles),
    'lifetime': st.builds(
        Duration, sec=st.integers(-(2**31), 2**31 - 1), nanosec=st.integers(0, 2**32 - 1)
    ),
    'points': outlines,
    'text': texts,
}


@st.composite
def markers(draw: Any) -> Marker:
    """Return a marker that means a body, but for a few of its fields."""
    kind = draw(st.sampled_from([1, 2, 3, 4, 6, 7, 11]))
    size = draw(st.floats(0.2, 1.5))
    message = Marker(
        ns=draw(st.sampled_from(['a', 'b'])),
        id=draw(st.integers(0, 2)),
        type=kind,
        scale=Vector3(x=size, y=size if kind != Marker.CUBE else draw(st.floats(0.2, 1.5))),
        points=closed([Point(), Point(x=1.0), Point(y=size)])[: 4 if kind == 4 else 3],
        text=draw(st.sampled_from(['', '', '{anchored: true}', '{velocity: [9, -9], spin: 5}'])),
    )
    message.pose.position = Point(x=draw(st.floats(-5.0, 5.0)), y=draw(st.floats(-5.0, 5.0)))
    message.pose.orientation = draw(turns)
    for field in draw(st.lists(st.sampled_from(sorted(ODD)), max_size=2)):
        setattr(message, field, draw(ODD[field]))
    return message


# Odd values of the marker of a joint.
ODD_JOINT = {key: ODD[key] for key in ('header', 'ns', 'id', 'action')} | {
    'points': st.lists(st.one_of(spots, places), max_size=4),
    'text': st.one_of(st.sampled_from(NASTY_TEXTS), st.text(max_size=20)),
}


@st.composite
def joints(draw: Any) -> Marker:
    """Return a marker that means a joint, but for a few of its fields and properties."""
    said = {'kind': draw(st.sampled_from(KINDS))}
    if draw(st.booleans()):
        said |= {'a': 'a/0', 'b': draw(st.sampled_from(['b/0', 'a/1', 'a/0', 'world']))}
    said |= draw(st.dictionaries(st.sampled_from(JOINT_KEYS), st.sampled_from(VALUES), max_size=2))
    near = st.builds(Point, x=st.floats(-0.5, 0.5), y=st.floats(-0.5, 2.5))
    count = 1 if said['kind'] in ('pin', 'axle', 'motor', 'gear') else 2
    message = Marker(
        ns=draw(st.sampled_from(['', 'a', 'joint:a'])),
        id=draw(st.integers(0, 2)),
        points=draw(st.lists(near, min_size=count, max_size=count)),
        text='{' + ', '.join(f'{key}: {value}' for key, value in said.items()) + '}',
    )
    for field in draw(st.lists(st.sampled_from(sorted(ODD_JOINT)), max_size=2)):
        setattr(message, field, draw(ODD_JOINT[field]))
    return message


@st.composite
def commands(draw: Any) -> MultiDOFJointState:
    """Return a command whose numbers, and sometimes names and lengths, are odd."""
    names = draw(st.lists(st.sampled_from(NAMES), min_size=1, max_size=2, unique=True))
    fits = st.lists if draw(st.booleans()) else None

    def some(strategy: st.SearchStrategy[Any]) -> list[Any]:
        if fits is None:
            return draw(st.lists(strategy, max_size=3))
        return draw(
            st.sampled_from([0, len(names)]).flatmap(
                lambda count: st.lists(strategy, min_size=count, max_size=count)
            )
        )

    if fits is None:
        names = draw(st.lists(st.one_of(st.sampled_from(NAMES), st.text(max_size=4)), max_size=3))
    odd = draw(st.booleans())
    number = numbers if odd else st.floats(-5.0, 5.0)
    vector = st.builds(Vector3, x=number, y=number, z=number)
    turn = quaternions if odd else turns
    return MultiDOFJointState(
        header=draw(headers) if odd else Header(),
        joint_names=names,
        transforms=some(st.builds(Transform, translation=vector, rotation=turn)),
        twist=some(st.builds(Twist, linear=vector, angular=vector)),
        wrench=some(st.builds(Wrench, force=vector, torque=vector)),
    )


points = st.one_of(
    st.builds(PointStamped, header=headers, point=places),
    st.builds(
        PointStamped, point=st.builds(Point, x=st.floats(-1.0, 1.0), y=st.floats(-1.0, 3.0))
    ),
)
requests = st.one_of(
    st.tuples(st.just('~/spawn'), markers()),
    st.tuples(st.just('~/spawn'), markers()),
    st.tuples(st.just('~/command'), commands()),
    st.tuples(st.just('~/join'), joints()),
    st.tuples(st.sampled_from(['~/anchor', '~/release', '~/pin', '~/axle']), points),
)
CONVERT = {
    '~/spawn': conversions.body_request,
    '~/join': conversions.joint_request,
    '~/command': conversions.command_request,
    '~/pin': partial(conversions.point_request, Pin),
    '~/axle': partial(conversions.point_request, Axle),
    '~/anchor': partial(conversions.point_request, Anchor),
    '~/release': partial(conversions.point_request, Release),
}


class Fuzzed:
    """A world and everything that looks at it, as in the node."""

    def __init__(self) -> None:
        bounds = WorldSettings(bounds=(-20.0, -20.0, 20.0, 20.0))
        self.simulation = Simulation(settings=bounds)
        self.simulation.reports_contacts = True
        self._encoders = [
            PosesEncoder('world'),
            StatesEncoder('world'),
            MarkersEncoder('world', 60.0),
        ]
        self._contacts = ContactsEncoder('world')
        for message in (box('a/0'), disc('b/0', at=(0.0, 2.0))):
            assert self.ask('~/spawn', message) == 'ok'

    def ask(self, topic: str, message: Any) -> str:
        """Ask as the node does, check that there is one answer, and return its code."""
        before = self.simulation.world.digest()
        try:
            request = CONVERT[topic](message, frame_id='world')
        except Refusal as refusal:
            subject = conversions.subject_of(message, joint=topic == '~/join')
            self.simulation.requests.refuse(refusal, Origin(topic), subject=subject)
        else:
            self.simulation.requests.submit(request, topic=topic)
        frame = self.simulation.apply_requests()
        assert frame is not None
        (answer,) = frame.answers
        assert answer.topic == topic
        assert answer.message
        encode_event(answer)
        if answer.code:
            assert self.simulation.world.digest() == before
        self.look(frame)
        return answer.code or 'ok'

    def go(self) -> None:
        frame = self.simulation.advance_frame()
        assert {answer.topic for answer in frame.answers} <= {'body_lost', 'joint_broken'}
        self.look(frame)

    def look(self, frame: Any) -> None:
        """Check that all that is told is finite, and can be told."""
        snapshot = frame.snapshot
        assert np.isfinite(snapshot.poses).all()
        assert np.isfinite(snapshot.twists).all()
        assert np.isfinite(snapshot.forces).all()
        assert len(snapshot.forces) == len(snapshot.scene.joints)
        assert len(set(snapshot.scene.names)) == len(snapshot.poses) == len(snapshot.twists)
        for encoder in self._encoders:
            encoder.encode(frame)
        assert frame.contacts is not None
        assert np.isfinite(frame.contacts.impulses).all()
        assert np.isfinite(frame.contacts.points).all()
        self._contacts.encode(frame)


@pytest.mark.slow
def test_thousands_of_arbitrary_messages_leave_a_world_that_goes_on() -> None:
    codes: dict[str, int] = {}
    done: set[str] = set()

    @given(st.lists(requests, min_size=7, max_size=12))
    @settings(
        max_examples=330,
        derandomize=True,
        deadline=None,
        database=None,
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
    )
    def fuzz(asked: list[tuple[str, Any]]) -> None:
        fuzzed = Fuzzed()
        for topic, message in asked:
            code = fuzzed.ask(topic, message)
            codes[code] = codes.get(code, 0) + 1
            if code == 'ok':
                done.add(topic)
            fuzzed.go()
        for _ in range(3):
            fuzzed.go()

    fuzz()
    print(codes)  # noqa: T201 - for who reads the log
    assert sum(codes.values()) >= 2000
    # Not all are refused at the door, and none of the reasons is unknown.
    assert codes['ok'] >= 500
    assert done == set(CONVERT)
    assert set(codes) <= {
        'ok',
        'malformed',
        'unknown_shape',
        'bad_size',
        'bad_outline',
        'not_planar',
        'unknown_frame',
        'unknown_property',
        'bad_property',
        'unknown_body',
        'unknown_joint',
        'anchored',
        'nothing_there',
    }
