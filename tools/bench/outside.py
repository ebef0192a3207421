# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The whole node from outside: its CPU time, beside that of the bare steps of the same bodies.

The node is a process of its own; another one reads all streams over DDS, and all is recorded. CPU
time is that of all threads and children, as the operating system counts it.
"""

from __future__ import annotations

from pathlib import Path
import tempfile
import time

from physsim_ros.files import save_world
from physsim_ros.model.requests import Restore
from physsim_ros.simulation.world import World
from physsim_ros.testing.domain import own_domain

from .bodies import Bare, cpu_time, falling, sparse
from .frames import TOPICS
from .node_process import cpu_seconds, executable, listening, Remote

COUNT = 1000
# Measured simulation time [s].
SECONDS = 6.0


def measure(name: str, world: World) -> None:
    """Print a row."""
    state = world.save()
    with own_domain() as domain, tempfile.TemporaryDirectory() as directory:
        path = save_world(state, 'scene', world_dir=Path(directory), physics_rate=240.0)
        given = {'world_file': path, 'record_file': Path(directory) / 'all.rrd', 'speed': 0.0}
        with (
            listening(domain, TOPICS),
            Remote(domain) as remote,
            executable(domain, **given) as process,
        ):
            # Subscribers are the listener, and this process for the clock.
            remote.spin_until(lambda: remote.node.count_subscribers('/diagnostics'))
            remote.spin_until(lambda: remote.node.count_publishers('/physsim/states'))
            time.sleep(1.0)
            before, began = cpu_seconds(process.pid), time.perf_counter()
            remote.play()
            remote.spin_until(lambda: remote.now() >= SECONDS)
            node, elapsed = cpu_seconds(process.pid) - before, time.perf_counter() - began
            pace, steps = remote.now() / elapsed, round(remote.now() * 240.0)
    copy = World()
    copy.apply(Restore(state=state))
    bare = Bare(copy)
    base = 1e-3 * cpu_time(lambda: bare.step(steps))
    frames = steps / 4
    print(
        f'{len(state.bodies):6}  {name:8} {1e3 * base / frames:10.2f} {1e3 * node / frames:10.2f}'
        f' {node / base:10.2f} {pace:9.2f}',
        flush=True,
    )


def table() -> None:
    """Print a row for bodies that fall, and one for bodies that drift."""
    print('\nCPU of a frame of the node, all streams read elsewhere and recorded, all processes')
    print('bodies  scene     bare [ms]  node [ms]  node/bare  realtime')
    measure('falling', falling(COUNT))
    measure('sparse', sparse(COUNT))
