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

"""
A pytest plugin: a world in the process of a test, which advances its time.

pytest loads it wherever the package is installed (entry point `pytest11`), in other projects too;
from a source tree alone, `pytest -p physsim_ros.testing` does. The fixture is `physsim`, a
`PhysSim`; names and types are for `from physsim_ros.testing import PhysSim, Refused`.

Laws: ROS is not imported before a test requests the fixture `physsim`; simulation time does not
depend on the wall clock, which only bounds the wait for an answer; messages that other nodes send
in reaction to a frame have arrived before the next frame, so that every run gives the same bits;
no node of another process hears the world or is heard by it.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
import itertools
import math
import os
from pathlib import Path
import time
from typing import Any, NamedTuple, Self, TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from diagnostic_msgs.msg import DiagnosticStatus
    from geometry_msgs.msg import PointStamped
    from physsim_ros.model.snapshot import Snapshot
    from rclpy.context import Context
    from rclpy.node import Node
    from sensor_msgs.msg import MultiDOFJointState
    from visualization_msgs.msg import Marker, MarkerArray

# Domains whose ports lie below the ephemeral range of Linux:
# https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Domain-ID.html
_DOMAINS = range(1, 102)
# Each process begins at another domain: every participant takes ports of its domain, of which
# discovery on one machine tries the first 32 only.
_BEGINNINGS = itertools.count(os.getpid())
# Environment variables that name peers in spite of the discovery range.
_PEERS = ('ROS_DISCOVERY_SERVER', 'ROS_STATIC_PEERS')
# Timeout for events that take milliseconds in this process, in wall time [s].
_TIMEOUT = 10.0
# Additional timeout for each marker of an array, which takes half a millisecond [s].
_TIMEOUT_EACH = 0.01
# Bodies that a failure describes [1]: what a screen shows at a time.
_MOST_DESCRIBED = 30
# The greatest number of rounds of messages in reaction to messages: two nodes that answer each
# other never end.
_MOST_ROUNDS = 100


class Pose(NamedTuple):
    """
    Pose of a body in the world.

    :ivar x: of the origin of its shape [m]
    :ivar y: of the same [m]
    :ivar yaw: counter-clockwise from the x axis [rad]
    """

    x: float
    y: float
    yaw: float


class Twist(NamedTuple):
    """
    Twist of a body, in axes of the world.

    :ivar vx: velocity of its centre of mass along x [m/s]
    :ivar vy: the same along y [m/s]
    :ivar spin: angular velocity, counter-clockwise [rad/s]
    """

    vx: float
    vy: float
    spin: float


class Contact(NamedTuple):
    """
    Two bodies that touched during the last frame.

    :ivar a: name of the body that was spawned first
    :ivar b: name of the other one, or 'world' for the walls of `bounds`
    :ivar impulse: x, y of the impulse of a on b over the frame [N s]
    :ivar point: x, y of the mean contact point [m]
    :ivar normal: x, y of the unit vector from a to b
    """

    a: str
    b: str
    impulse: tuple[float, float]
    point: tuple[float, float]
    normal: tuple[float, float]


class Refused(Exception):
    """
    A request was refused.

    :ivar code: the stable code of the refusal
    :ivar field: the offending field, or ''
    """

    def __init__(self, code: str, message: str, field: str) -> None:
        super().__init__(f'{code}: {message}')
        self.code = code
        self.field = field


class UnknownName(KeyError):
    """No body or joint has that name; the message tells the nearest one."""

    def __str__(self) -> str:
        """Return the message as it is, which a KeyError quotes."""
        return str(self.args[0])


@contextmanager
def _refusing() -> Iterator[None]:
    """Raise `Refused` instead of a refusal of the world."""
    from physsim_ros.model.errors import Refusal

    try:
        yield
    except Refusal as refusal:
        raise Refused(refusal.code, str(refusal), refusal.field) from refusal


class PhysSim:
    """
    A world whose time a test advances, and a client that publishes requests to it.

    :param context: of ROS
    :param directory: in which `load` looks for files first, as that of the test
    :param parameters: of the node, as name -> value

    :ivar recording: the file that frames are recorded in; None if they are not
    """

    def __init__(
        self, context: Context, *, directory: Path | None = None, **parameters: Any
    ) -> None:
        from physsim_ros.ros.node import PhysSimNode
        from rclpy.experimental import EventsExecutor
        from rclpy.parameter import Parameter

        values = {'viewer': 'none', 'publish_rate': 60.0} | parameters
        overrides = [Parameter(name, value=value) for name, value in values.items()]
        self.context = context
        self._directories = [*filter(None, [directory]), Path()]
        self.recording: Path | None = None
        self.node = PhysSimNode(context=context, parameter_overrides=overrides)
        self._client = _Client(context)
        self._executor = EventsExecutor(context=context)
        self._executor.add_node(self.node)
        self._executor.add_node(self._client.node)
        self._added: list[Node] = []
        self._spin_until(lambda: self._client.matched, 'the world did not appear')

    # Time

    def load(self, world: str | Path) -> None:
        """
        Replace the world by that of a file.

        :param world: a path, relative to the test's own file or to the working directory, where
            `.yaml` may be left out; or the name of a shipped world
        :raises Refused: there is no such file, or it is not a world
        """
        from rclpy.parameter import Parameter

        given = Path(world) if Path(world).suffix else Path(f'{world}.yaml')
        paths = [directory.absolute() / given for directory in self._directories]
        path = next((path for path in paths if path.is_file()), None)
        self.node.set_parameters([Parameter('world_file', value=str(path or world))])
        try:
            with _refusing():
                self.node.world_files.load(confined=False)
        except Refused as refused:
            if path is None:
                looked = ' and '.join(str(each) for each in paths)
                refused.add_note(f'There is neither {looked}, nor a shipped world of that name.')
            raise
        self.node.apply_requests()
        self.settle()

    def add(self, node: Node) -> None:
        """Spin a node together with the world, on simulation time."""
        from rclpy.parameter import Parameter

        node.set_parameters([Parameter('use_sim_time', value=True)])
        self._added.append(node)
        self._executor.add_node(node)
        self.settle()

    def step(self, frames: int = 1) -> None:
        """
        Advance by frames of one publish period each.

        :raises ValueError: the count is below 0
        """
        if frames < 0:
            raise ValueError(f'time goes on by 0 frames or more, not by {frames}; seek goes back')
        # Messages of the test's own publishers come first.
        self.settle()
        for _ in range(frames):
            self.node.advance_frame()
            self.settle()

    def run(self, seconds: float) -> None:
        """
        Advance by simulated seconds, to the nearest frame.

        :raises ValueError: they are below 0, not finite, or less than half a frame
        """
        frames = self._frames(seconds)
        if seconds and not frames:
            period = self.node.frame_period
            raise ValueError(f'{seconds:g} s are not half a frame, which lasts {period:g} s')
        self.step(frames)

    def until(self, predicate: Callable[[], object], *, timeout: float = 10.0) -> None:
        """
        Advance by single frames until a predicate is true.

        :param timeout: simulation time after which it must be true [s]
        :raises TimeoutError: it is not
        :raises ValueError: the timeout is below 0, or not finite
        """
        for _ in range(self._frames(timeout)):
            if predicate():
                return
            self.step()
        if not predicate():
            raise TimeoutError(
                f'not so within {timeout:g} simulated seconds\n{self.describe_state()}'
            )

    def _frames(self, seconds: float) -> int:
        frames = seconds / self.node.frame_period
        if not 0.0 <= frames < math.inf:
            raise ValueError(f'time goes on by 0 s or more, not for ever; so not by {seconds:g} s')
        return round(frames)

    def seek(self, seconds: float) -> None:
        """
        Go to an earlier simulation time [s]; advancing from there repeats the same bits.

        :raises Refused: the time is no longer in the history, or in the future
        """
        self.settle()
        with _refusing():
            self.node.simulation.seek(round(seconds * 1e9))
        self.node.apply_requests()
        self.settle()

    def settle(self) -> None:
        """Spin until all messages have arrived, those in reaction to them too."""
        for _ in range(_MOST_ROUNDS):
            if self._spin_to_barrier() <= 1:
                return
        raise TimeoutError('nodes answer each other without end while time stands still')

    # Requests

    def spawn(self, marker: Marker | MarkerArray) -> str:
        """
        Publish a marker, or an array of them, and return the name of the (last) body.

        :raises Refused: with the code; of an array, the first refusal
        """
        if hasattr(marker, 'markers'):
            # An empty array has an answer, too.
            return self._request('spawn_array', marker, max(1, len(marker.markers)))
        return self._request('spawn', marker)

    def anchor(self, point: PointStamped | tuple[float, float]) -> str:
        """
        Anchor the topmost body under a point [m], and return its name.

        :raises Refused: with the code
        """
        return self._request('anchor', _stamped(point))

    def release(self, point: PointStamped | tuple[float, float]) -> str:
        """
        Release the topmost body under a point [m], and return its name.

        :raises Refused: with the code
        """
        return self._request('release', _stamped(point))

    def join(self, marker: Marker) -> str:
        """
        Join two bodies by a marker, and return the joint's name.

        :raises Refused: with the code
        """
        return self._request('join', marker)

    def pin(self, point: PointStamped | tuple[float, float]) -> str:
        """
        Weld the bodies under a point [m] together, and return the joint's name.

        :raises Refused: with the code
        """
        return self._request('pin', _stamped(point))

    def axle(self, point: PointStamped | tuple[float, float]) -> str:
        """
        Join the bodies under a point [m] by an axle, and return the joint's name.

        :raises Refused: with the code
        """
        return self._request('axle', _stamped(point))

    def command(self, command: MultiDOFJointState) -> str:
        """
        Set poses, twists or wrenches, and return the name of the body where it is only one.

        :raises Refused: with the code
        """
        return self._request('command', command)

    def _request(self, topic: str, message: Any, answers: int = 1) -> str:
        """Publish a request, apply it without advancing time, and return the answer's subject."""
        # Answers to earlier requests of other nodes come first, and are skipped.
        self.settle()
        earlier = sum(answer.topic == f'~/{topic}' for answer in self.node.apply_requests())
        received = self._client.listen(topic)
        self._client.publish(topic, message)

        def answered() -> bool:
            self.node.apply_requests()
            return len(received) >= earlier + answers

        timeout = _TIMEOUT + _TIMEOUT_EACH * (earlier + answers)
        self._spin_until(answered, f'no answer to {topic}', timeout)
        self.settle()
        last = earlier + answers
        received = received[earlier:last]
        for status in received:
            if status.level != b'\x00':
                values = {pair.key: pair.value for pair in status.values}
                raise Refused(values['code'], status.message, values.get('field', ''))
        return received[-1].hardware_id if received else ''

    # State

    @property
    def time(self) -> float:
        """Return the simulation time [s]."""
        return self._snapshot.stamp * 1e-9

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all bodies, in spawn order."""
        return self._snapshot.scene.names

    def pose(self, name: str) -> Pose:
        """
        Return the pose of a body.

        :raises UnknownName: there is no such body
        """
        return Pose(*self._snapshot.poses[self._row(name)].tolist())

    def twist(self, name: str) -> Twist:
        """
        Return the twist of a body.

        :raises UnknownName: there is no such body
        """
        return Twist(*self._snapshot.twists[self._row(name)].tolist())

    def contacts(self, name: str | None = None) -> list[Contact]:
        """
        Return the contacts of the last frame.

        :param name: of a body, whose contacts are returned; 'world' is the walls of `bounds`
        :raises UnknownName: there is no such body, nor was there in that frame
        """
        frame = self.node.frame
        names = [*(() if frame is None else frame.snapshot.scene.names), 'world']
        if name is not None and name not in names:
            self._row(name)
        if frame is None or frame.contacts is None:
            return []
        found = frame.contacts
        vectors = (found.impulses, found.points, found.normals)
        contacts = [
            Contact(names[a], names[b], *map(tuple, each))
            for (a, b), *each in zip(
                found.pairs.tolist(), *(each.tolist() for each in vectors), strict=True
            )
        ]
        return [each for each in contacts if name is None or name in (each.a, each.b)]

    def energy(self) -> float:
        """Return kinetic, potential (0 at y = 0) and elastic energy of the world [J]."""
        snapshot = self._snapshot
        return snapshot.kinetic_energy + snapshot.potential_energy + snapshot.elastic_energy

    def force(self, joint: str) -> float:
        """
        Return the force of a joint in the last step [N].

        :raises UnknownName: there is no such joint
        """
        return float(self._snapshot.forces[_index(joint, self.joints, 'joint')])

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of all joints, in the order of their creation."""
        return tuple(joint.name for joint in self._snapshot.scene.joints)

    def digest(self) -> str:
        """
        Return a hash of time, poses, velocities, wrenches and the descriptions of all objects.

        The impulse cache of the engine is not included: two worlds of one digest may differ after
        the next step, where bodies touch.
        """
        return self.node.simulation.world.digest()

    @property
    def _snapshot(self) -> Snapshot:
        return self.node.simulation.world.snapshot()

    def _row(self, name: str) -> int:
        return _index(name, self.names, 'body')

    def describe_state(self) -> str:
        """Return the time, and pose and velocity of the first bodies, a line each."""
        names = self.names
        lines = [f'at {self.time:g} s, bodies: {len(names)}; x, y [m], yaw [rad]:']
        for name in names[:_MOST_DESCRIBED]:
            pose, twist = self.pose(name), self.twist(name)
            speed = math.hypot(twist.vx, twist.vy)
            lines.append(
                f'  {name:20}  {pose.x:8.3f} {pose.y:8.3f} {pose.yaw:8.3f}, '
                f'with {speed:.3f} m/s and {twist.spin:.3f} rad/s'
            )
        if len(names) > _MOST_DESCRIBED:
            lines.append(f'  and {len(names) - _MOST_DESCRIBED} more')
        return '\n'.join(lines)

    # Recording

    def record(self, path: str | Path) -> None:
        """Record all frames from now on in a `.rrd` file, which is complete after the test."""
        self.recording = Path(path)
        self.node.record(self.recording)

    def record_past(self, path: Path) -> None:
        """
        Record all frames of the history in a `.rrd` file; nothing but this can be done after it.

        Other nodes hear nothing of it: the past is repeated from the log of requests.
        """
        simulation = self.node.simulation
        status = simulation.status
        simulation.seek(round(status.oldest * 1e9))
        self.node.apply_requests()
        self.record(path)
        for _ in range(self._frames(status.newest - status.oldest)):
            self.node.advance_frame()

    # Spinning

    def _spin_to_barrier(self) -> int:
        """Spin until all events queued now are handled, and return the number of spins."""
        reached: list[bool] = []
        self._executor.create_task(lambda: reached.append(True))
        spins = 0
        while not reached:
            self._executor.spin_once(timeout_sec=0)
            spins += 1
        return spins

    def _spin_until(
        self, predicate: Callable[[], object], otherwise: str, timeout: float = _TIMEOUT
    ) -> None:
        deadline = time.monotonic() + timeout
        while not predicate():
            if time.monotonic() > deadline:
                raise TimeoutError(otherwise)
            self._executor.spin_once(timeout_sec=0.01)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for node in (*self._added, self._client.node, self.node):
            self._executor.remove_node(node)
        # Before its nodes, whose waitables it holds.
        self._executor.shutdown()
        self._client.node.destroy_node()
        self.node.destroy_node()


class _Client:
    """A node that publishes requests and receives the answers."""

    def __init__(self, context: Context) -> None:
        from diagnostic_msgs.msg import DiagnosticStatus
        from geometry_msgs.msg import PointStamped
        from physsim_ros.ros.qos_safe_node import LOSSLESS, NodeWithoutQosEvents
        from sensor_msgs.msg import MultiDOFJointState
        from visualization_msgs.msg import Marker, MarkerArray

        self.node = NodeWithoutQosEvents('physsim_test', context=context)
        kinds = {
            'spawn': Marker,
            'spawn_array': MarkerArray,
            'join': Marker,
            'pin': PointStamped,
            'axle': PointStamped,
            'anchor': PointStamped,
            'release': PointStamped,
            'command': MultiDOFJointState,
        }
        self._publishers = {
            topic: self.node.create_publisher(kind, f'/physsim/{topic}', 10)
            for topic, kind in kinds.items()
        }
        self._events = self.node.create_subscription(
            DiagnosticStatus, '/physsim/events', self._receive, LOSSLESS
        )
        # Contacts are recorded only while there is a subscriber.
        self._contacts = self.node.create_subscription(
            MultiDOFJointState, '/physsim/contacts', lambda _: None, 5, raw=True
        )
        self._topic = ''
        self._received: list[DiagnosticStatus] = []

    @property
    def matched(self) -> bool:
        """Whether publishers and subscriptions are matched with those of the world."""
        outward = all(each.get_subscription_count() for each in self._publishers.values())
        return outward and self.node.count_publishers('/physsim/events') > 0

    def listen(self, topic: str) -> list[DiagnosticStatus]:
        """Return a list to which the answers to requests on a topic will be appended."""
        self._topic, self._received = f'~/{topic}', []
        return self._received

    def publish(self, topic: str, message: Any) -> None:
        """Publish a request."""
        self._publishers[topic].publish(message)

    def _receive(self, status: DiagnosticStatus) -> None:
        if status.name == self._topic:
            self._received.append(status)


@pytest.fixture
def physsim(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[PhysSim]:
    """
    Give a world with its own context and domain, whose time the test advances.

    Where the test fails, a recording of it is kept in its `tmp_path`.
    """
    directory = request.path.parent
    with (
        own_context(monkeypatch) as context,
        PhysSim(context, directory=directory, world_dir=str(tmp_path)) as world,
    ):
        yield world
        path = request.node.stash.get(_RECORDING, None)
        if path is not None:
            world.record_past(path)


# The file that keeps what a failed test has done.
_RECORDING = pytest.StashKey[Path]()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Tell in the report of a failed test where bodies are, and where its recording is."""
    report = yield
    arguments = getattr(item, 'funcargs', {})
    world = arguments.get('physsim')
    if call.when == 'call' and report.failed and isinstance(world, PhysSim):
        path = world.recording
        if path is None:
            path = item.stash[_RECORDING] = arguments['tmp_path'] / 'failed.rrd'
        words = f'{world.describe_state()}\nrecording: {path}'
        report.sections.append(('physsim', words))
    return report


@contextmanager
def own_context(monkeypatch: pytest.MonkeyPatch) -> Iterator[Context]:
    """Give a context whose nodes find each other and no others, whatever their domain is."""
    import rclpy

    # Endpoints of one participant are matched without discovery.
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'OFF')
    for name in _PEERS:
        monkeypatch.delenv(name, raising=False)
    # Shared memory remains after a killed process, with the locks that it owned.
    monkeypatch.setenv('FASTDDS_BUILTIN_TRANSPORTS', 'UDPv4')
    context = rclpy.Context()
    domain = _DOMAINS[next(_BEGINNINGS) % len(_DOMAINS)]
    rclpy.init(context=context, domain_id=domain, args=[])
    try:
        yield context
    finally:
        context.try_shutdown()


def _index(name: str, names: Sequence[str], kind: str) -> int:
    """
    Return the index of a name.

    :param kind: of what is named, for the message
    :raises UnknownName: it is not there
    """
    from physsim_ros.model.texts import nearest_name

    if name in names:
        return names.index(name)
    there = '' if names else '; there are none'
    raise UnknownName(f'there is no {kind} {name!r}{nearest_name(name, names)}{there}')


def _stamped(point: PointStamped | tuple[float, float]) -> PointStamped:
    from geometry_msgs.msg import PointStamped

    if not isinstance(point, tuple):
        return point
    message = PointStamped()
    message.point.x, message.point.y = map(float, point)
    return message
