# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Robots: how many times faster than real time they run, in the fixture and in the whole node.

Each robot has a laser of 360 beams that is read five times a second, among walls. Beside it the
same world in ir-sim, a simulator of robots in Python, where it is installed (`pip install ir-sim`
in an environment of its own, whose Python the variable IRSIM_PYTHON names).
"""

from __future__ import annotations

from collections.abc import Iterator
import json
import math
import os
from pathlib import Path
import subprocess
import tempfile
from test.building import spawn
import time

from physsim_ros.files import save_world, shipped_robot
from physsim_ros.model.requests import DriveRobot, Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.model.transform import Pose
from physsim_ros.simulation.world import World
from physsim_ros.testing import own_context, PhysSim
from physsim_ros.testing.domain import own_domain
import pytest
from sensor_msgs.msg import LaserScan

from .bodies import cpu_time
from .joints import median_step
from .node_process import cpu_seconds, executable, listening, Remote

WALLS = 50
# Numbers of robots in the fixture, and in the whole node.
COUNTS, MANY = (1, 10), 50
# Distance between robots [m], which drive on circles of 0.1 m.
APART, SPEED, TURN = 1.0, 0.1, 1.0
# Simulated time of a turn [s]; turns, the fastest of which counts.
SECONDS, TURNS = 2.0, 5
# Frames from one scan to the next.
EVERY = 12
PEER = Path(__file__).with_name('irsim_world.py')


def places(count: int) -> Iterator[tuple[float, float]]:
    """Yield places in a square [m]."""
    side = math.ceil(math.sqrt(count))
    for number in range(count):
        row, column = divmod(number, side)
        yield APART * (column - side / 2), APART * (row - side / 2)


def placed_walls(count: int) -> Iterator[Pose]:
    """Yield poses of walls of 0.5 by 0.1 m, in rings around so many robots."""
    inner = 1.0 + APART * math.ceil(math.sqrt(count)) * 0.75
    for number in range(WALLS):
        angle, far = 2.4 * number, inner + 0.05 * number
        yield far * math.cos(angle), far * math.sin(angle), angle


def scene(count: int) -> World:
    """Return robots that drive on circles for ever, and walls."""
    settings = WorldSettings(gravity=(0.0, 0.0), floor_friction=0.6)
    world = World(settings=settings)
    burger = shipped_robot('turtlebot3_burger')
    burger['robot']['drive']['timeout'] = 0.0
    for number, pose in enumerate(placed_walls(count)):
        spawn(world, f'wall/{number}', Box(width=0.5, height=0.1), pose, anchored=True)
    for number, (x, y) in enumerate(places(count)):
        name = f'robot/{number}'
        spawn(world, name, Disc(radius=0.105), (x, y, 0.0), mass=1.0, robot=burger['robot'])
        world.apply(DriveRobot(name=name, velocity=(SPEED, 0.0, TURN)))
    return world


def in_fixture(count: int) -> float:
    """Return how many times faster than real time robots are in the fixture, by CPU time."""
    with (
        pytest.MonkeyPatch.context() as patch,
        own_context(patch) as context,
        PhysSim(context) as sim,
    ):
        sim.node.simulation.perform(Restore(state=scene(count).save()))
        sim.step()
        robots = [sim.find_robot(f'robot/{number}') for number in range(count)]
        frames = round(SECONDS * 60)

        def play() -> None:
            for number in range(frames):
                sim.step()
                if number % EVERY == 0:
                    for robot in robots:
                        robot.scan()

        play()
        return 1e3 * SECONDS / min(cpu_time(play) for _ in range(TURNS))


def in_node(count: int) -> tuple[float, float]:
    """
    Return how many times faster than real time robots are in a node that is not paced.

    A process of its own, whose lasers another one reads.

    :return: by the wall, and by the CPU time of the node
    """
    scans = {f'/robot_{number}/scan': LaserScan for number in range(count)}
    with own_domain() as domain, tempfile.TemporaryDirectory() as directory:
        state = scene(count).save()
        path = save_world(state, 'scene', world_dir=Path(directory), physics_rate=240.0)
        with (
            listening(domain, scans),
            Remote(domain) as remote,
            executable(domain, world_file=path, speed=0.0) as process,
        ):
            remote.spin_until(
                lambda: all(
                    remote.node.count_publishers(topic) and remote.node.count_subscribers(topic)
                    for topic in scans
                )
            )
            before, began = cpu_seconds(process.pid), time.perf_counter()
            remote.play()
            remote.spin_until(lambda: remote.now() >= SECONDS * TURNS)
            cpu, wall = cpu_seconds(process.pid) - before, time.perf_counter() - began
            return remote.now() / wall, remote.now() / cpu


def in_peer(count: int, step: float, beams: int = 360) -> float:
    """
    Return how many times faster than real time robots are in ir-sim, by CPU time.

    :param step: of the time [s], in each of which it reads all lasers
    :param beams: of each
    """
    world = {
        'robots': [*places(count)],
        'walls': [*placed_walls(count)],
        'step': step,
        'beams': beams,
    }
    world |= {'speed': SPEED, 'turn': TURN, 'seconds': SECONDS / 2}
    python = os.environ['IRSIM_PYTHON']
    done = subprocess.run(
        [python, str(PEER)], input=json.dumps(world), capture_output=True, text=True, check=True
    )
    return float(done.stdout.split()[-1])


def table() -> None:
    """Print rows for the fixture, the whole node, and a peer."""
    print(f'\nRobots with lasers of 360 beams at 5 Hz among {WALLS} walls, in times of real time')
    print('robots  fixture  ir-sim at 5 Hz  ir-sim at 60 Hz')
    for count in COUNTS:
        cells = [f'{in_fixture(count):8.1f}']
        if 'IRSIM_PYTHON' in os.environ:
            cells += [f'{in_peer(count, 0.2):15.1f}', f'{in_peer(count, 1 / 60):16.1f}']
        else:
            cells += ['  skipped: IRSIM_PYTHON names no Python that has ir-sim']
        print(f'{count:6} {" ".join(cells)}', flush=True)
    for count in (*COUNTS, MANY):
        print(f'{count:6} a step, median: {median_step(scene(count)):.3f} ms', flush=True)
    wall, cpu = in_node(MANY)
    print(f'{MANY:6} in the whole node: {wall:.1f} by the wall, {cpu:.1f} by its CPU', flush=True)
