# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world that a test changes by requests, and whose time it advances."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, ExitStack, suppress
from itertools import count
import math
from pathlib import Path
from typing import Any, Self, Unpack

from geometry_msgs.msg import PointStamped
from physsim_ros.model.errors import Refusal
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.node_without_qos_events import NodeWithoutQosEvents
from physsim_ros.ros.robots.commands import MATCH_PERIOD
from physsim_ros.runtime.slices import finish
from physsim_ros.testing.client import RequestClient, SettlingExecutor
from physsim_ros.testing.context import own_context
from physsim_ros.testing.observed_world import index_of, ObservedWorld
from physsim_ros.testing.parameters import Parameters
from physsim_ros.testing.robot import Robot, robot_marker
from physsim_ros.testing.values import refusals_as_refused, Refused
import pytest
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import Marker, MarkerArray


class PhysSim(ObservedWorld):
    """
    A world whose time a test advances, and which it changes by requests.

    Each request waits for its answer.

    :param context: of ROS
    :param directory: in which `load` looks for files first, as that of the test
    :param parameters: of the node; its viewer is 'none' by default
    :raises PhysSimError: a parameter is unknown, or its value is refused

    :ivar recording: the file that frames are recorded in; None if they are not
    """

    def __init__(
        self, context: Context, *, directory: Path | None = None, **parameters: Unpack[Parameters]
    ) -> None:
        values: dict[str, Any] = {'viewer': 'none', **parameters}
        overrides = [Parameter(name, value=value) for name, value in values.items()]
        with ExitStack() as closing:
            self._executor = SettlingExecutor(context)
            closing.callback(self._executor.shutdown)
            node = PhysSimNode(context=context, parameter_overrides=overrides)
            self._executor.add_node(node)
            # `contacts` reads them from the frame, where no message is needed.
            node.outputs.records_contacts = True
            node.boundary.on_error = self._executor.errors.append
            own = NodeWithoutQosEvents('physsim_test', context=context)
            super().__init__(node)
            self._client = RequestClient(own, node, self._executor)
            self._closing = closing.pop_all()
        self.context = context
        self.recording: Path | None = None
        self._directories = [*filter(None, [directory]), Path()]
        # Frames until the next match of all publishers of commands.
        self._frames_to_match = 0

    # Requests

    def spawn(self, marker: Marker | MarkerArray) -> str:
        """
        Publish a marker, or an array of markers, and return the name of the (last) body.

        Many bodies are faster in one array: each request makes a frame of all bodies, which takes
        7 µs a body.

        :raises Refused: with the code; of an array, the first refusal
        """
        if isinstance(marker, MarkerArray):
            # An empty array has an answer, too.
            return self._client.request('spawn_array', marker, max(1, len(marker.markers)))
        return self._client.request('spawn', marker)

    def robot(
        self,
        robot: str | Mapping[str, Any],
        *,
        at: Sequence[float] = (0.0, 0.0),
        name: str = '',
        namespace: str | None = None,
    ) -> Robot:
        """
        Spawn a robot, and return it.

        A world that is loaded replaces it, so load first.

        :param robot: name of a shipped one, or a mapping with that as `from` and what is different
        :param at: x, y [m] and, where there are three, yaw [rad]
        :param name: of its body; '' is robot/0, robot/1 and so on
        :param namespace: of its topics; None is its name with _ for /
        :raises Refused: with the code
        :raises ValueError: the name has no number after a slash
        """
        names = self.names
        name = name or next(f'robot/{n}' for n in count() if f'robot/{n}' not in names)
        with refusals_as_refused():
            message = robot_marker(robot, name, at, namespace)
        return Robot(self.node, self._client.request('spawn', message))

    def find_robot(self, name: str) -> Robot:
        """
        Return a robot that is in the world, as one of a world file.

        :param name: of its body
        :raises UnknownName: there is no such robot
        """
        index_of(name, (*self.node.fleet.scene_robots.topics,), 'robot')
        return Robot(self.node, name)

    def anchor(self, point: PointStamped | tuple[float, float]) -> str:
        """
        Anchor the topmost body under a point [m], and return its name.

        :raises Refused: with the code
        """
        return self._client.request('anchor', _stamped(point))

    def release(self, point: PointStamped | tuple[float, float]) -> str:
        """
        Release the topmost body under a point [m], and return its name.

        :raises Refused: with the code
        """
        return self._client.request('release', _stamped(point))

    def join(self, marker: Marker) -> str:
        """
        Join two bodies by a marker, and return the joint's name.

        :raises Refused: with the code
        """
        return self._client.request('join', marker)

    def pin(self, point: PointStamped | tuple[float, float]) -> str:
        """
        Weld the bodies under a point [m] together, and return the joint's name.

        :raises Refused: with the code
        """
        return self._client.request('pin', _stamped(point))

    def axle(self, point: PointStamped | tuple[float, float]) -> str:
        """
        Join the bodies under a point [m] by an axle, and return the joint's name.

        :raises Refused: with the code
        """
        return self._client.request('axle', _stamped(point))

    def command(self, command: MultiDOFJointState) -> str:
        """
        Set poses, twists or wrenches, and return the name of the body where it is only one.

        :raises Refused: with the code
        """
        return self._client.request('command', command)

    # Time

    def load(self, world: str | Path) -> None:
        """
        Replace the world by that of a file.

        :param world: a path, relative to the test's own file or to the working directory, where
            `.yaml` may be left out; or the name of a shipped world
        :raises Refused: there is no such file, or it is not a world
        """
        given = Path(world) if Path(world).suffix else Path(f'{world}.yaml')
        paths = [directory.absolute() / given for directory in self._directories]
        path = next((path for path in paths if path.is_file()), None)
        self.node.set_parameters([Parameter('world_file', value=str(path or world))])
        try:
            with refusals_as_refused():
                finish(self.node.world_files.load(str(path or world), confined=False))
        except Refused as refused:
            if path is None:
                looked = ', '.join(dict.fromkeys(map(str, paths)))
                refused.add_note(f'A test also looks for {looked}.')
            raise
        self.node.loop.apply_requests()
        self.settle()

    def add(self, node: Node) -> None:
        """Spin a node together with the world, on simulation time."""
        node.set_parameters([Parameter('use_sim_time', value=True)])
        self._executor.add_node(node)
        self._match_publishers()
        self.settle()

    def step(self, frames: int = 1) -> None:
        """
        Advance by frames of one publish period each.

        :raises ValueError: the count is below 0
        """
        if frames < 0:
            raise ValueError(f'frames must be >= 0; got {frames}; seek goes back')
        # Messages of the test's own publishers come first.
        self.settle()
        while frames > 0:
            if self._frames_to_match > 0:
                self._match_new_publishers()
            else:
                self._match_publishers()
            self.node.loop.handle_messages()
            # The test itself reads the last frame.
            made = self.node.loop.pass_frames(min(frames - 1, self._frames_to_match))
            if not made:
                self.node.loop.advance_frame()
                made = 1
            frames -= made
            self._frames_to_match -= made
            self.settle()
            if self.node.fleet.lockstep.waits():
                self._executor.spin_until(
                    lambda: not self.node.fleet.lockstep.waits(), 'no answer to a scan', math.inf
                )

    def run(
        self,
        seconds: float | None = None,
        *,
        until: Callable[[], object] | None = None,
        timeout: float = 10.0,
    ) -> bool:
        """
        Advance by simulated seconds, to the nearest frame, or until a predicate is true.

        :param seconds: None is as long as `timeout`, which only goes with `until`
        :param until: looked at before each frame; None is never true
        :return: whether the predicate is true
        :raises ValueError: they are below 0, not finite, or less than half a frame
        """
        # The traceback of a failed test ends at its own line.
        __tracebackhide__ = True
        if seconds is None and until is None:
            raise ValueError('run for how long? Pass seconds, or a predicate as until')
        seconds = timeout if seconds is None else seconds
        frames = self._frames(seconds)
        if seconds and not frames:
            period = self.node.frame_period
            raise ValueError(f'{seconds:g} s are less than half a frame of {period:g} s')
        self._match_publishers()
        if until is None:
            self.step(frames)
            return False
        for _ in range(frames):
            if until():
                return True
            self.step()
        return bool(until())

    def until(self, predicate: Callable[[], object], *, timeout: float = 10.0) -> None:
        """
        Advance frame by frame until a predicate is true.

        :param timeout: simulation time [s]
        :raises TimeoutError: it is not true after that time
        :raises ValueError: the timeout is below 0, not finite, or less than half a frame
        """
        __tracebackhide__ = True
        if not self.run(until=predicate, timeout=timeout):
            raise TimeoutError(
                f'not true within {timeout:g} simulated seconds\n{self.describe_state()}'
            )

    def wait_until(self, predicate: Callable[[], object], *, timeout: float = 10.0) -> None:
        """
        Spin until a predicate is true, with time paused: for nodes of other processes.

        Requests that arrive meanwhile are applied, as in any paused world.

        :param timeout: wall time [s]
        :raises TimeoutError: it is not true after that time
        """
        __tracebackhide__ = True

        def is_true() -> object:
            self.node.fleet.scene_robots.match_publishers()
            self.node.loop.apply_requests()
            return predicate()

        try:
            self._executor.spin_until(is_true, f'not true within {timeout:g} s', timeout)
        except TimeoutError as error:
            raise TimeoutError(f'{error} by the wall\n{self.describe_state()}') from None
        self.settle()

    def _frames(self, seconds: float) -> int:
        frames = seconds / self.node.frame_period
        if not 0.0 <= frames < math.inf:
            raise ValueError(f'seconds must be finite and >= 0; got {seconds:g} s')
        return round(frames)

    def seek(self, seconds: float) -> None:
        """
        Go to an earlier simulation time [s]; advancing from there repeats the same bits.

        :raises Refused: the time is no longer in the history, or in the future
        """
        self.settle()
        with refusals_as_refused():
            self.node.simulation.seek(round(seconds * 1e9))
        self.node.loop.apply_requests()
        self.settle()

    def rewind(self, seconds: float) -> None:
        """
        Go back by simulated seconds; robots that the test drives are let go.

        :raises Refused: that time is no longer in the history
        """
        self.seek(self.time - seconds)

    def settle(self) -> None:
        """
        Spin until all messages have arrived, those in reaction to them too.

        Any unexpected error of the node, which would only be logged outside of a test, is raised.
        """
        self._executor.settle()

    def _match_publishers(self) -> None:
        """Connect robots with the publishers of their commands, as the node does by the clock."""
        self._frames_to_match = self._frames(MATCH_PERIOD)
        if self.node.fleet.scene_robots.match_publishers():
            self.settle()

    def _match_new_publishers(self) -> None:
        """Connect robots whose number of publishers has changed, which costs little."""
        if self.node.fleet.scene_robots.match_new_publishers():
            self.settle()

    # Recording

    def record(self, path: str | Path) -> None:
        """
        Record all frames from now on in a `.rrd` file, which is complete after the test.

        :raises Refused: the file cannot be written, as in a folder that does not exist
        """
        viewer = self.node.outputs.viewer
        viewer.record(Path(path))
        if reason := viewer.wait_for_file():
            raise Refused('record_failed', f'{path}: {reason}', 'path')
        self.recording = Path(path)

    def record_past(self, path: Path) -> None:
        """
        Record all frames of the history in a `.rrd` file; the world cannot be used after it.

        Other nodes receive none of these frames: the past is replayed from the logged requests.
        """
        simulation = self.node.simulation
        status = simulation.status
        for robot in self.node.fleet.scene_robots.topics.values():
            # The last command came too late for the test, and would be refused in the past.
            for commands in robot.command_topics:
                with suppress(Refusal):
                    commands.take()
        simulation.seek(round(status.oldest * 1e9))
        self.node.loop.apply_requests()
        self.node.outputs.viewer.record(path)
        for _ in range(self._frames(status.newest - status.oldest)):
            self.node.loop.advance_frame()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        self._closing.close()
        if kind is None:
            self._executor.raise_error()


@contextmanager
def own_world(**parameters: Unpack[Parameters]) -> Iterator[PhysSim]:
    """
    Yield a world with its own context and domain, such as one with other parameters.

    :param parameters: parameters of its node
    :raises PhysSimError: a parameter is unknown, or its value is refused
    """
    with (
        pytest.MonkeyPatch.context() as monkeypatch,
        own_context(monkeypatch) as context,
        PhysSim(context, **parameters) as world,
    ):
        yield world


def _stamped(point: PointStamped | tuple[float, float]) -> PointStamped:
    if not isinstance(point, tuple):
        return point
    message = PointStamped()
    message.point.x, message.point.y = map(float, point)
    return message
