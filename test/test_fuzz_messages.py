# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Whatever a message holds, it is answered once, and the world goes on with finite numbers."""

from __future__ import annotations

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
from physsim_ros import cdr, conversions
from physsim_ros.core.errors import Refusal
from physsim_ros.core.settings import WorldSettings
from physsim_ros.core.simulation import Simulation
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker

from test.messages import box, disc

NASTY_FLOATS = [
    0.0, -0.0, 5e-324, 1e-320, 1e-200, 1e-9, 1e-3, 0.002, 0.5, 1.0, -1.0, 1e3, 1e5, 1e7, 1e8, 1e12,
    1e150, 1e300, 1.7e308, -1e300, math.nan, math.inf, -math.inf,
]  # fmt: skip
NASTY_TEXTS = [
    '{', '}', '[', '!!bool x', '!!int ""', '!!python/object/apply:os.system [x]', '&a [*a]', '*a',
    '? [a]', '? {a: 1} : 1', '{mass: !!timestamp x}', '{mass: 2001-01-01}', '{mass: 0x10}', '---',
    '--- {}\n---\n{}', '%TAG', '\0', '\ud800', '{~: 1}', '{1: 1}', '{mass: 1e400}', '{mass: -.inf}',
    '{velocity: [[1, 2], 3]}', '{velocity: [.nan, 0]}', '{group: 99999999999999999999}', '"', "'",
    '{friction: 1, friction: 2}', '{anchored: true, kinematic: true}', '{"mass": "1"}', '- 1', '#',
    '{<<: {mass: 1}}', '[' * 2000, '{a: ' * 600, 'x' * 10_001, '\N{SNOWMAN}: 1', '{mass: \x85}',
]  # fmt: skip
KEYS = ['mass', 'density', 'friction', 'elasticity', 'velocity', 'spin', 'anchored', 'kinematic',
        'group', 'sensor', 'color']  # fmt: skip
VALUES = ['0', '1', '-1', '0.5', '1e5', '1e-9', '1e12', '.nan', '.inf', 'true', 'false', '[1, 2]',
          '[-1e5, 0]', '[1]', '[]', '~', 'x', '{}', '12345678901234567890']  # fmt: skip
NAMES = ['a/0', 'a/1', 'b/0', 'body/0']

numbers = st.one_of(
    st.floats(-3.0, 3.0),
    st.integers(-3, 3).map(float),
    st.sampled_from(NASTY_FLOATS),
    st.floats(),
)
singles = st.one_of(st.floats(0.0, 1.0, width=32), st.floats(width=32))
# Most are good, so that what follows is looked at too.
lengths = st.one_of(st.floats(0.1, 2.0), st.floats(0.1, 2.0), numbers)
sane = st.one_of(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), numbers)
namespaces = st.one_of(st.sampled_from(['a', 'b', '', 'body']), st.text(max_size=6))
frames = st.one_of(st.sampled_from(['', '', 'world', *NAMES]), st.text(max_size=6))
headers = st.builds(Header, frame_id=frames)
quaternions = st.one_of(
    st.floats(-4.0, 4.0).map(lambda yaw: Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))),
    st.builds(Quaternion, x=numbers, y=numbers, z=numbers, w=numbers),
)
vectors = st.builds(Vector3, x=sane, y=sane, z=numbers)
places = st.builds(Point, x=sane, y=sane, z=numbers)
# On a grid, so that outlines close, cross and touch themselves.
spots = st.builds(
    Point, x=st.integers(-2, 2).map(float), y=st.integers(-2, 2).map(float), z=numbers
)


def closed(points: list[Point]) -> list[Point]:
    return [*points, points[0]]


outlines = st.one_of(
    st.lists(spots, max_size=8),
    st.lists(spots, min_size=3, max_size=8).map(closed),
    st.lists(places, max_size=8),
    st.lists(places, min_size=1, max_size=8).map(closed),
)
texts = st.one_of(
    st.just(''),
    st.dictionaries(st.sampled_from(KEYS), st.sampled_from(VALUES), max_size=3).map(
        lambda said: '{' + ', '.join(f'{key}: {value}' for key, value in said.items()) + '}'
    ),
    st.sampled_from(NASTY_TEXTS),
    st.text(max_size=20),
)


@st.composite
def scales(draw: Any) -> Vector3:
    x = draw(lengths)
    y = draw(st.one_of(st.just(x), lengths))
    return Vector3(x=x, y=y, z=draw(numbers))


markers = st.builds(
    Marker,
    header=headers,
    ns=namespaces,
    id=st.one_of(st.integers(0, 2), st.integers(-(2**31), 2**31 - 1)),
    type=st.one_of(st.sampled_from([1, 2, 3, 4, 6, 7, 11]), st.integers(-1, 13)),
    action=st.one_of(st.just(0), st.just(0), st.just(0), st.integers(-1, 4)),
    pose=st.builds(Pose, position=places, orientation=quaternions),
    scale=scales(),
    color=st.builds(ColorRGBA, r=singles, g=singles, b=singles, a=singles),
    lifetime=st.builds(
        Duration,
        sec=st.one_of(st.just(0), st.integers(-(2**31), 2**31 - 1)),
        nanosec=st.one_of(st.just(0), st.integers(0, 2**32 - 1)),
    ),
    points=outlines,
    text=texts,
)
commands = st.builds(
    MultiDOFJointState,
    header=headers,
    joint_names=st.lists(st.one_of(st.sampled_from(NAMES), st.text(max_size=4)), max_size=3),
    transforms=st.lists(
        st.builds(Transform, translation=vectors, rotation=quaternions), max_size=3
    ),
    twist=st.lists(st.builds(Twist, linear=vectors, angular=vectors), max_size=3),
    wrench=st.lists(st.builds(Wrench, force=vectors, torque=vectors), max_size=3),
)
# A command that fits what is there, but for its numbers.
fitting = st.builds(
    lambda name, way, twist, push: MultiDOFJointState(
        joint_names=[name], transforms=way, twist=twist, wrench=push
    ),
    st.sampled_from(NAMES),
    st.lists(st.builds(Transform, translation=vectors, rotation=quaternions), max_size=1),
    st.lists(st.builds(Twist, linear=vectors, angular=vectors), max_size=1),
    st.lists(st.builds(Wrench, force=vectors, torque=vectors), max_size=1),
)
points = st.builds(PointStamped, header=headers, point=places)
requests = st.one_of(
    st.tuples(st.just('~/spawn'), markers),
    st.tuples(st.just('~/spawn'), markers),
    st.tuples(st.just('~/command'), commands),
    st.tuples(st.just('~/command'), fitting),
    st.tuples(st.sampled_from(['~/anchor', '~/release']), points),
)
CONVERT = {
    '~/spawn': conversions.body_request,
    '~/command': conversions.command_request,
    '~/anchor': conversions.anchor_request,
    '~/release': conversions.release_request,
}


class Fuzzed:
    """A world and everything that looks at it, as in the node."""

    def __init__(self) -> None:
        bounds = WorldSettings(bounds=(-20.0, -20.0, 20.0, 20.0))
        self.simulation = Simulation(settings=bounds)
        self.simulation.watch_contacts(True)  # noqa: FBT003 - a state, not a mode
        self._encoders = [
            cdr.PosesEncoder('world'),
            cdr.StatesEncoder('world'),
            cdr.MarkersEncoder('world'),
        ]
        self._contacts = cdr.ContactsEncoder('world')
        for message in (box('a/0'), disc('b/0', at=(0.0, 2.0))):
            assert self.ask('~/spawn', message) == 'ok'

    def ask(self, topic: str, message: Any) -> str:
        """Ask as the node does, check that there is one answer, and return its code."""
        before = self.simulation.world.digest()
        try:
            request = CONVERT[topic](message, frame_id='world')
        except Refusal as refusal:
            subject = conversions.subject_of(message)
            self.simulation.refuse(refusal, topic=topic, subject=subject)
        else:
            self.simulation.submit(request, topic=topic)
        frame = self.simulation.settle()
        assert frame is not None
        (answer,) = frame.answers
        assert answer.topic == topic
        assert answer.message
        cdr.encode_event(answer)
        if answer.code:
            assert self.simulation.world.digest() == before
        self.look(frame)
        return answer.code or 'ok'

    def go(self) -> None:
        frame = self.simulation.advance_frame()
        assert {answer.topic for answer in frame.answers} <= {'divergence'}
        self.look(frame)

    def look(self, frame: Any) -> None:
        """Check that all that is told is finite, and can be told."""
        snapshot = frame.snapshot
        assert np.isfinite(snapshot.poses).all()
        assert np.isfinite(snapshot.twists).all()
        assert len(set(snapshot.scene.names)) == len(snapshot.poses) == len(snapshot.twists)
        for encoder in self._encoders:
            encoder.encode(snapshot)
        assert frame.contacts is not None
        assert np.isfinite(frame.contacts.impulses).all()
        assert np.isfinite(frame.contacts.points).all()
        self._contacts.encode(snapshot, frame.contacts)


def test_thousands_of_arbitrary_messages_leave_a_world_that_goes_on() -> None:
    codes: dict[str, int] = {}

    @given(st.lists(requests, min_size=1, max_size=8))
    @settings(
        max_examples=700,
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
            fuzzed.go()
        for _ in range(3):
            fuzzed.go()

    fuzz()
    print(codes)  # noqa: T201 - for who reads the log
    assert sum(codes.values()) >= 2000
    # Not all are refused at the door, and none of the reasons is unknown.
    assert codes['ok'] >= 500
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
        'anchored',
        'nothing_there',
    }
