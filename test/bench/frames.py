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
What a frame costs, side by side in one run: the node, the bare engine, and the naive way.

Every figure is a mean over frames that take turns, so that a machine whose speed drifts does not
favour one of them; over whole times between keyframes, after what is done once has been done.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
import math
from pathlib import Path
import random
import statistics
import subprocess
import sys
import tempfile
import time
from typing import NamedTuple

from geometry_msgs.msg import Pose, PoseArray
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import Configure, Spawn
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.ros.node import PhysSimNode, reduce_latency
from physsim_ros.simulation.world import World
from physsim_ros.testing import own_domain
import pymunk
import rclpy
from rclpy.parameter import Parameter

FRAMES = 360
# Before them: a keyframe is among these, the first of so many bodies.
WARM = 200
# Frames in a row of each: one alone would leave what is to be sent to the others' time.
TURN = 20
PERIOD = 16_666_667  # ns
SETTLE = 30.0  # simulated seconds in which a pile of a thousand comes to rest
TOPICS = ('clock', 'poses', 'states', 'contacts', 'markers', 'events')
# Subscribes to topics from another process, as serialised bytes: what a viewer costs is its own
# affair.
LISTENER = """
import sys, rclpy, rclpy.executors
from rclpy.experimental import EventsExecutor
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseArray
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray
rclpy.init(domain_id=int(sys.argv[1]))
node = rclpy.create_node('listener')
kinds = {'poses': PoseArray, 'states': MultiDOFJointState, 'contacts': MultiDOFJointState,
         'markers': MarkerArray, 'events': DiagnosticStatus, 'clock': Clock}
for topic in sys.argv[2:]:
    name = '/clock' if topic == 'clock' else f'/physsim/{topic}'
    node.create_subscription(kinds[topic], name, lambda _: None, 5, raw=True)
executor = EventsExecutor()
executor.add_node(node)
try:
    while rclpy.ok():
        executor.spin_once(timeout_sec=0.1)
except rclpy.executors.ExternalShutdownException:
    pass
"""


class Pile(NamedTuple):
    """
    What is measured.

    :ivar count: of bodies
    :ivar settled: whether they lie; else they fall onto one another all the time
    :ivar topics: that somebody subscribes to
    :ivar paced: whether a frame begins each sixtieth of a second; else one follows the other, and
        what it leaves to other threads, it pays for in the next
    """

    count: int
    settled: bool = True
    topics: tuple[str, ...] = TOPICS
    paced: bool = False

    def __str__(self) -> str:
        topics = 'all' if self.topics == TOPICS else ', '.join(self.topics)
        state, pace = 'settled' if self.settled else 'falling', '60 Hz' if self.paced else 'free'
        return f'{self.count:6}  {state}  {topics:13}  {pace:5}'


def fill(world: World, count: int, *, settle: float = SETTLE) -> None:
    """Let a pile of discs and boxes fall into a bin, for seconds; by then it is at rest."""
    rng = random.Random(count)
    half = math.sqrt(count) * 0.6
    row = int(2 * half / 0.7)
    world.apply(Configure(changes={'bounds': (-half, 0.0, half, 1000.0)}))
    for number in range(count):
        world.apply(
            Spawn(
                name=f'body/{number}',
                shape=Disc(radius=0.25) if number % 2 else Box(width=0.5, height=0.5),
                pose=(
                    0.5 - half + number % row * 0.7 + rng.uniform(-0.1, 0.1),
                    0.5 + number // row * 0.7,
                    0.0,
                ),
                properties=Properties(elasticity=0.0),
            )
        )
    world.step(round(settle * world.physics_rate))


class Bare:
    """The engine alone, in a space that nothing of ours is in: four calls of `Space.step`."""

    def __init__(self, pile: Pile) -> None:
        world = World()
        fill(world, pile.count, settle=0.0)
        ours = world._space._space
        self.space = pymunk.Space()
        self.space.gravity, self.space.collision_slop = ours.gravity, ours.collision_slop
        for body in ours.bodies:
            twin = pymunk.Body(body.mass, body.moment)
            twin.position, twin.angle = body.position, body.angle
            self.space.add(twin, *(_twin(shape, twin) for shape in body.shapes))
        walls = ours.static_body.shapes
        self.space.add(*(_twin(wall, self.space.static_body) for wall in walls))
        for _ in range(round(SETTLE * pile.settled * 60)):
            self._go_on()

    def frame(self) -> None:
        """Make four steps."""
        self._go_on()

    def _go_on(self) -> None:
        for _ in range(4):
            self.space.step(1 / 240)


def _twin(shape: pymunk.Shape, body: pymunk.Body) -> pymunk.Shape:
    """Return the same shape on another body."""
    if isinstance(shape, pymunk.Circle):
        twin: pymunk.Shape = pymunk.Circle(body, shape.radius, shape.offset)
    else:
        assert isinstance(shape, pymunk.Poly)
        twin = pymunk.Poly(body, shape.get_vertices(), radius=shape.radius)
    twin.friction, twin.elasticity = shape.friction, shape.elasticity
    return twin


class Naive(Bare):
    """The engine, read attribute by attribute into message objects, one a body."""

    def __init__(self, pile: Pile, node: PhysSimNode) -> None:
        super().__init__(pile)
        self._poses = node.create_publisher(PoseArray, 'naive', 5)

    def frame(self) -> None:
        """Make four steps and publish the poses, one stream of the six."""
        super().frame()
        message = PoseArray()
        for body in self.space.bodies:
            pose = Pose()
            pose.position.x, pose.position.y = body.position
            pose.orientation.z = math.sin(body.angle / 2)
            pose.orientation.w = math.cos(body.angle / 2)
            message.poses.append(pose)
        self._poses.publish(message)


def timed(act: Callable[[], None]) -> float:
    """Return how long something takes [ms]."""
    began = time.perf_counter()
    act()
    return (time.perf_counter() - began) * 1e3


def measure(pile: Pile, directory: Path, domain: int) -> None:
    """Print a row."""
    record = directory / 'frames.rrd'
    overrides = [
        Parameter('viewer', value='none'),
        Parameter('record_file', value=str(record)),
        Parameter('speed', value=0.0),
    ]
    node = PhysSimNode(parameter_overrides=overrides)
    node.start()
    fill(node.simulation.world, pile.count, settle=SETTLE * pile.settled)
    listener = subprocess.Popen([sys.executable, '-c', LISTENER, str(domain), *pile.topics])
    try:
        while not node.count_subscribers(f'/physsim/{pile.topics[-1]}'):
            time.sleep(0.01)
        node.simulation.speed = 1.0
        ticks = count()
        ways = {
            'bare': Bare(pile).frame,
            'node': lambda: node.tick(next(ticks) * PERIOD),
            'naive': Naive(pile, node).frame,
        }
        times: dict[str, list[float]] = {name: [] for name in ways}
        for _ in range((WARM + FRAMES) // TURN):
            for name, frame in ways.items():
                due = time.perf_counter()
                for _ in range(TURN):
                    times[name].append(timed(frame))
                    due += PERIOD * 1e-9
                    if pile.paced:
                        time.sleep(max(0.0, due - time.perf_counter()))
    finally:
        listener.terminate()
        listener.wait()
        node.destroy_node()
    base, ours, plain = (statistics.mean(each[WARM:]) for each in times.values())
    size = record.stat().st_size / (WARM + FRAMES) / pile.count
    ratios = f'{ours / base:10.2f} {plain / base:11.2f}'
    print(f'{pile} {base:10.2f} {ours:10.2f} {ratios} {size:17.0f}', flush=True)


def table(counts: list[int]) -> None:
    """Print a row for each count of bodies that lie, and some for a thousand that differ."""
    reduce_latency()
    print('A frame of 4 steps of a pile, recorded by Rerun')
    print(
        'bodies  pile     subscribed     pace   bare [ms]  node [ms]  node/bare  naive/bare'
        '  bytes/body/frame'
    )
    piles = [Pile(count) for count in counts]
    piles += [
        Pile(1000, paced=True),
        Pile(1000, topics=('poses', 'states')),
        Pile(1000, settled=False),
    ]
    with own_domain() as domain, tempfile.TemporaryDirectory() as directory:
        rclpy.init(domain_id=domain)
        for pile in piles:
            measure(pile, Path(directory), domain)
        rclpy.shutdown()
