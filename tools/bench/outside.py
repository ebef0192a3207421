# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The whole node from outside: its CPU time, beside that of the bare steps of the same bodies.

The node is a process of its own; another one reads all streams over DDS, and all is recorded. CPU
time is that of all threads and children, as the operating system counts it.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
import subprocess
import sys
import tempfile
import time

from physsim_ros.files import save_world
from physsim_ros.model.requests import Restore
from physsim_ros.simulation.world import World
from physsim_ros.testing.domain import own_domain
import psutil
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger

from .bodies import Bare, falling, sparse
from .frames import LISTENER, TOPICS
from .startup import executable

COUNT = 1000
# Measured simulation time [s].
SECONDS = 6.0


def cpu_seconds(pid: int) -> float:
    """Return the CPU time that a process and its children have taken [s]."""
    process = psutil.Process(pid)
    all_times = [each.cpu_times() for each in (process, *process.children(recursive=True))]
    ended = all_times[0].children_user + all_times[0].children_system
    return float(sum(each.user + each.system for each in all_times) + ended)


class Remote:
    """
    The node's clock and services, from this process.

    :param domain: of the node

    :ivar now: time of the simulation [s]
    """

    def __init__(self, domain: int) -> None:
        self._context = rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain)
        self.node = rclpy.create_node('remote', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self.now = 0.0
        self.node.create_subscription(Clock, '/clock', self._hear, 1)

    def _hear(self, message: Clock) -> None:
        self.now = message.clock.sec + message.clock.nanosec * 1e-9

    def spin_until(self, condition: Callable[[], object]) -> None:
        """Spin until something holds."""
        while not condition():
            self._executor.spin_once(timeout_sec=0.05)

    def play(self) -> None:
        """Let the time of the simulation run."""
        client = self.node.create_client(Trigger, '/physsim/play')
        self.spin_until(client.service_is_ready)
        answer = client.call_async(Trigger.Request())
        self.spin_until(answer.done)

    def close(self) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.shutdown()


def measure(name: str, world: World) -> None:
    """Print a row."""
    state = world.save()
    with own_domain() as domain, tempfile.TemporaryDirectory() as directory:
        path = save_world(state, 'scene', world_dir=Path(directory), physics_rate=240.0)
        listener = subprocess.Popen([sys.executable, '-c', LISTENER, str(domain), *TOPICS])
        remote = Remote(domain)
        given = {'world_file': path, 'record_file': Path(directory) / 'all.rrd', 'speed': 0.0}
        try:
            with executable(domain, **given) as process:
                # Subscribers are the listener, and this process for the clock.
                remote.spin_until(lambda: remote.node.count_subscribers('/diagnostics'))
                remote.spin_until(lambda: remote.node.count_publishers('/physsim/states'))
                time.sleep(1.0)
                before, began = cpu_seconds(process.pid), time.perf_counter()
                remote.play()
                remote.spin_until(lambda: remote.now >= SECONDS)
                node, elapsed = cpu_seconds(process.pid) - before, time.perf_counter() - began
                steps = round(remote.now * 240.0)
        finally:
            listener.terminate()
            listener.wait()
            remote.close()
    copy = World()
    copy.apply(Restore(state=state))
    bare = Bare(copy)
    started = time.process_time()
    bare.step(steps)
    base = time.process_time() - started
    frames = steps / 4
    pace = remote.now / elapsed
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
