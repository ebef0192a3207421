# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The cost of a frame, side by side in one run: the node, the bare engine, and the naive way.

Every figure is a mean over frames that take turns, so that a machine whose speed drifts does not
favour one of them; over whole times between checkpoints, after what is done once has been done.
"""

from __future__ import annotations

from itertools import count
import math
from pathlib import Path
import statistics
import tempfile
import time
from typing import NamedTuple

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Pose, PoseArray
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.programs.physsim import reduce_latency
from physsim_ros.simulation.world import World
from physsim_ros.testing.domain import own_domain
import rclpy
from rclpy.logging import LoggingSeverity
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray

from .bodies import Bare, fill, SETTLE, timed
from .node_process import listening

FRAMES = 200
# Frames before the measured ones, with the first checkpoint of this number of bodies.
WARM = 100
# Frames in a row of each: a single frame would be sent during the others' time.
TURN = 20
PERIOD = 16_666_667  # ns
TOPICS = {
    '/clock': Clock,
    '/physsim/poses': PoseArray,
    '/physsim/states': MultiDOFJointState,
    '/physsim/contacts': MultiDOFJointState,
    '/physsim/markers': MarkerArray,
    '/physsim/events': DiagnosticStatus,
    '/diagnostics': DiagnosticArray,
}
# All of them, and those that a client of many bodies reads.
ALL, FEW = tuple(TOPICS), ('/physsim/poses', '/physsim/states')


class Pile(NamedTuple):
    """
    A pile that is measured.

    :ivar count: of bodies
    :ivar settled: whether they lie; else they fall onto one another all the time
    :ivar topics: that somebody subscribes to
    :ivar paced: whether a frame begins each sixtieth of a second; else one follows the other, and
        what it leaves to other threads, it pays for in the next
    """

    count: int
    settled: bool = True
    topics: tuple[str, ...] = ALL
    paced: bool = False

    def __str__(self) -> str:
        topics = 'all' if self.topics == ALL else 'poses, states'
        state, pace = 'settled' if self.settled else 'falling', '60 Hz' if self.paced else 'free'
        return f'{self.count:6}  {state}  {topics:13}  {pace:5}'


class Naive(Bare):
    """The engine, read attribute by attribute into message objects, one a body."""

    def __init__(self, world: World, node: PhysSimNode) -> None:
        super().__init__(world)
        self._poses = node.create_publisher(PoseArray, 'naive', 5)

    def frame(self) -> None:
        """Make four steps and publish the poses, one stream of the six."""
        super().frame()
        self._poses.publish(naive_message(self))


def naive_message(bare: Bare) -> PoseArray:
    """Return the poses of all bodies, read attribute by attribute."""
    message = PoseArray()
    for body in bare.space.bodies:
        pose = Pose()
        pose.position.x, pose.position.y = body.position
        pose.orientation.z = math.sin(body.angle / 2)
        pose.orientation.w = math.cos(body.angle / 2)
        message.poses.append(pose)
    return message


def measure(pile: Pile, directory: Path, domain: int) -> None:
    """Print a row."""
    record = directory / 'frames.rrd'
    overrides = [
        Parameter('viewer', value='none'),
        Parameter('record_file', value=str(record)),
        Parameter('speed', value=0.0),
    ]
    node = PhysSimNode(parameter_overrides=overrides)
    node.get_logger().set_level(LoggingSeverity.WARN)
    node.start()
    world = node.simulation.world
    fill(world, pile.count, settle=SETTLE * pile.settled)
    with listening(domain, {topic: TOPICS[topic] for topic in pile.topics}):
        while not node.count_subscribers(pile.topics[1]):
            time.sleep(0.01)
        node.simulation.speed = 1.0
        ticks = count()
        ways = {
            'bare': Bare(world).frame,
            'node': lambda: node.tick(next(ticks) * PERIOD),
            'naive': Naive(world, node).frame,
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
        Pile(1000, topics=FEW),
        Pile(1000, settled=False),
    ]
    with own_domain() as domain, tempfile.TemporaryDirectory() as directory:
        rclpy.init(domain_id=domain)
        for pile in piles:
            measure(pile, Path(directory), domain)
        rclpy.shutdown()
