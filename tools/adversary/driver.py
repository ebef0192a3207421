# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A node that does to a running world what peers, pages and people do to it, at random."""

from __future__ import annotations

from collections import Counter
import random
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Point, Pose, PoseStamped
from nav_msgs.msg import Path
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Box, Compound, Disc
from physsim_ros.ros.node_without_qos_events import NodeWithoutQosEvents
from physsim_ros.ros.topics import LOSSLESS
from physsim_ros.sketchpad.messages import ACTIONS
from physsim_ros.testing import messages
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import SetParameters
from rclpy.experimental import EventsExecutor
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker

# The longest that a world may leave a service unanswered [s].
PATIENCE = 60.0
WORLDS = ('demo', 'bridge', 'galton', 'gear_train', 'newtons_cradle', 'dominoes')
VIEWERS = ('none', 'web', 'connect', 'spawn')


class Driver:
    """
    Publishers and clients of bodies, joints, commands, strokes, time, services and parameters.

    :param seed: of the choices

    :ivar doing: name of the last disturbance
    :ivar codes: events by code
    :ivar values: those of the last `/diagnostics`, by key
    """

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.doing = ''
        self.codes: Counter[str] = Counter()
        self.values: dict[str, str] = {}
        self.divergences: list[str] = []
        # Bodies of a scene whose answers are missing.
        self._unanswered: set[str] = set()
        self.node = NodeWithoutQosEvents('driver')
        self._executor = EventsExecutor()
        self._executor.add_node(self.node)
        self._spawn = self._publisher(Marker, 'spawn')
        self._join = self._publisher(Marker, 'join')
        self._command = self._publisher(MultiDOFJointState, 'command')
        self._seek = self._publisher(Clock, 'seek')
        self._stroke = self._publisher(Path, 'stroke')
        self._clients = {
            name: self.node.create_client(Trigger, f'/physsim/{name}') for name in ACTIONS
        }
        self._parameters = self.node.create_client(SetParameters, '/physsim/set_parameters')
        self.node.create_subscription(
            DiagnosticStatus, '/physsim/events', self._hear_event, LOSSLESS
        )
        self.node.create_subscription(DiagnosticArray, '/diagnostics', self._hear_values, 10)
        self._wait(self._parameters.service_is_ready, 'the services')
        self._wait(self._spawn.get_subscription_count, 'the topics')

    def close(self) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self.node.destroy_node()

    def disturb(self) -> None:
        """Do one thing, chosen at random."""
        kinds = (
            self.spawn_some,
            self.join_some,
            self.command_some,
            self.seek_somewhere,
            self.call_some,
            self.change_speed,
            self.change_viewer,
            self.change_settings,
            self.draw,
        )
        kind = self.random.choice(kinds)
        self.doing = kind.__name__
        kind()

    def settle(self) -> None:
        """Bring the world to where it is compared: the same file, at speed 1, without viewers."""
        self.set_parameters(viewer='none', world_file='demo', gravity=[0.0, -9.81], bounds=[])
        self.call('load_world')
        self.call('play')

    def spin(self, seconds: float) -> None:
        """Hear what there is to hear for some time."""
        end = time.monotonic() + seconds
        while (remaining := end - time.monotonic()) > 0:
            self._executor.spin_once(timeout_sec=min(0.05, remaining))

    def late_frames(self) -> int:
        """Return the count of frames that came late since the node began."""
        self.values.clear()
        self._wait(lambda: 'late frames' in self.values, 'diagnostics')
        return int(self.values['late frames'])

    def past(self) -> float:
        """Return the memory of the past in the last diagnostics [MB]."""
        return float(self.values['memory of the past [MB]'].partition(' ')[0])

    # Actions

    def publish_scene(self, requests: list[Spawn]) -> float:
        """Publish requests for bodies as markers; return the time to the last answer [s]."""
        began = time.monotonic()
        self._unanswered = {request.name for request in requests}
        for request in requests:
            self._spawn.publish(_marker(request))
        self._wait(lambda: not self._unanswered, 'answers to a scene')
        return time.monotonic() - began

    def spawn_some(self) -> None:
        for number in range(self.random.randrange(1, 200)):
            at = (self.random.uniform(-8, 8), self.random.uniform(0, 12), self.random.random())
            make = self.random.choice((messages.box, messages.disc))
            text = self.random.choice(('', '{elasticity: 0.9}', '{anchored: true}', '{mass: -1}'))
            self._spawn.publish(make(f'some/{number}', at=at, text=text, lifetime=20.0))

    def join_some(self) -> None:
        for number in range(self.random.randrange(1, 5)):
            points = [(self.random.uniform(-8, 8), self.random.uniform(0, 8)) for _ in range(2)]
            kind = self.random.choice(('pin', 'axle', 'spring', 'rod', 'rope', 'nothing'))
            points = points[: 1 if kind in {'pin', 'axle'} else 2]
            self._join.publish(
                messages.marker(0, f'join/{number}', points=points, text=f'{{kind: {kind}}}')
            )

    def command_some(self) -> None:
        for number in range(self.random.randrange(1, 100)):
            values = [tuple(self.random.uniform(-20, 20) for _ in range(3))]
            name = f'some/{number}'
            self._command.publish(
                self.random.choice(
                    (
                        messages.command(name, twists=values),
                        messages.command(name, wrenches=values),
                        messages.command(name, poses=[(float('nan'), 0.0, 0.0)]),
                    )
                )
            )

    def seek_somewhere(self) -> None:
        for _ in range(self.random.randrange(1, 4)):
            message = Clock()
            message.clock.sec = self.random.randrange(0, 120)
            self._seek.publish(message)

    def call_some(self) -> None:
        for name in self.random.choices(ACTIONS, k=3):
            if name == 'load_world':
                self.set_parameters(world_file=self.random.choice(WORLDS))
            elif name == 'save_world':
                self.set_parameters(world_file='soak')
            self.call(name)

    def change_speed(self) -> None:
        self.set_parameters(
            speed=self.random.choice((-64.0, -4.0, -0.3, 0.0, 0.3, 1.0, 4.0, 64.0))
        )
        self.spin(0.5)

    def change_viewer(self) -> None:
        for viewer in self.random.choices(VIEWERS, k=self.random.randrange(1, 20)):
            self.set_parameters(viewer=viewer)
        self.spin(1.0)

    def change_settings(self) -> None:
        self.set_parameters(
            gravity=[self.random.uniform(-10, 10), self.random.uniform(-10, 10)],
            iterations=self.random.randrange(1, 30),
            bounds=self.random.choice(([], [-10.0, 0.0, 10.0, 12.0])),
        )

    def draw(self) -> None:
        message = Path()
        x, y = self.random.uniform(-8, 8), self.random.uniform(0, 8)
        for _ in range(self.random.choice((0, 1, 50, 2000))):
            x, y = x + self.random.gauss(0, 0.1), y + self.random.gauss(0, 0.1)
            message.poses.append(PoseStamped(pose=Pose(position=Point(x=x, y=y))))
        self._stroke.publish(message)

    # Asking

    def call(self, name: str) -> bool:
        """Call a service, and return whether it was done; one that is not answered fails."""
        return bool(self._request(self._clients[name], Trigger.Request(), name).success)

    def set_parameters(self, **values: Any) -> None:
        """Set parameters of the world, by name; refusals are answers too."""
        found: list[ParameterMessage] = [
            Parameter(name, Parameter.Type.DOUBLE_ARRAY, value).to_parameter_msg()
            if isinstance(value, list)
            else Parameter(name, value=value).to_parameter_msg()
            for name, value in values.items()
        ]
        self._request(self._parameters, SetParameters.Request(parameters=found), 'set_parameters')

    def _request(self, client: Any, request: Any, name: str) -> Any:
        future = client.call_async(request)
        self._wait(future.done, f'an answer of {name}')
        return future.result()

    def _wait(self, predicate: Any, what: str) -> None:
        deadline = time.monotonic() + PATIENCE
        while not predicate():
            if time.monotonic() > deadline:
                raise TimeoutError(f'not within {PATIENCE:g} s: {what}')
            self._executor.spin_once(timeout_sec=0.05)

    def _publisher(self, kind: type, topic: str) -> Any:
        return self.node.create_publisher(kind, f'/physsim/{topic}', LOSSLESS)

    def _hear_event(self, status: DiagnosticStatus) -> None:
        code = next(pair.value for pair in status.values if pair.key == 'code')
        self.codes[code] += 1
        self._unanswered.discard(status.hardware_id)
        if code == 'divergence':
            self.divergences.append(status.message)

    def _hear_values(self, array: DiagnosticArray) -> None:
        for status in array.status:
            self.values |= {pair.key: pair.value for pair in status.values}


def _marker(request: Spawn) -> Marker:
    """Return the marker that becomes a body."""
    if isinstance(request.shape, Disc):
        diameter = 2 * request.shape.radius
        return messages.disc(request.name, at=request.pose, diameter=diameter)
    if isinstance(request.shape, Box):
        size = (request.shape.width, request.shape.height)
        return messages.box(request.name, at=request.pose, size=size)
    assert isinstance(request.shape, Compound)
    assert isinstance(request.shape.element, Disc)
    diameter = 2 * request.shape.element.radius
    scale, points = (diameter, diameter, diameter), request.shape.centers
    kind = Marker.SPHERE_LIST
    return messages.marker(kind, request.name, at=request.pose, scale=scale, points=points)
