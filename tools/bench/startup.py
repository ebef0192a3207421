# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Start and memory of the node: the installed executable, seen from outside."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
import os
from pathlib import Path
import re
import signal
import statistics
import subprocess
import sys
import time

from geometry_msgs.msg import PoseArray
from physsim_ros.testing.domain import own_domain
import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from visualization_msgs.msg import Marker, MarkerArray

RUNS = 3
BODIES = 1000
# Imports of the program before its first pose, and the least time of a package that is told [s].
IMPORTS = 'import physsim_ros.ros.node, physsim_ros.ros.programs.real_time_loop'
TOLD = 0.005
# An installed package has its bytecode: without this variable the first run writes it.
ENVIRONMENT = {key: os.environ[key] for key in os.environ.keys() - {'PYTHONDONTWRITEBYTECODE'}}


@contextmanager
def executable(domain: int, **parameters: object) -> Iterator[subprocess.Popen[bytes]]:
    """Run the installed node on a domain."""
    given = {'viewer': 'none'} | parameters
    words = [word for name, value in given.items() for word in ('-p', f'{name}:={value}')]
    process = subprocess.Popen(
        [Path(sys.executable).with_name('physsim'), '--ros-args', *words],
        env=ENVIRONMENT | {'ROS_DOMAIN_ID': str(domain)},
        stderr=subprocess.DEVNULL,
    )
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()


class Watcher:
    """Another process's end: the poses that it receives."""

    def __init__(self, domain: int) -> None:
        self._context = rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain)
        self.node = Node('watcher', context=self._context)
        self._executor = EventsExecutor(context=self._context)
        self._executor.add_node(self.node)
        self.bodies = -1
        self.node.create_subscription(PoseArray, '/physsim/poses', self._hear, 5)

    def _hear(self, message: PoseArray) -> None:
        self.bodies = len(message.poses)

    def wait(self, bodies: int) -> None:
        """Spin until a message with at least so many poses has come."""
        while self.bodies < bodies:
            self._executor.spin_once(timeout_sec=0.1)

    def close(self) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.shutdown()


def first_pose() -> float:
    """Return the seconds from the command to the first message elsewhere."""
    with own_domain() as domain:
        watcher = Watcher(domain)
        began = time.perf_counter()
        with executable(domain):
            watcher.wait(0)
            elapsed = time.perf_counter() - began
        watcher.close()
    return elapsed


def memory() -> float:
    """Return the resident memory of the node with its bodies [MB]."""
    with own_domain() as domain, executable(domain) as process:
        watcher = Watcher(domain)
        publisher = watcher.node.create_publisher(MarkerArray, '/physsim/spawn_array', 10)
        watcher.wait(0)
        while publisher.get_subscription_count() == 0:
            time.sleep(0.01)
        array = MarkerArray()
        for number in range(BODIES):
            marker = Marker(id=number, type=Marker.SPHERE)
            marker.scale.x = marker.scale.y = 0.5
            marker.pose.position.x, marker.pose.position.y = number % 40.0, number // 40.0
            array.markers.append(marker)
        publisher.publish(array)
        watcher.wait(BODIES)
        status = Path(f'/proc/{process.pid}/status').read_text(encoding='ascii')
        watcher.close()
    kilobytes = next(line for line in status.splitlines() if line.startswith('VmRSS')).split()[1]
    return int(kilobytes) / 1024


def imports() -> Counter[str]:
    """Return the time that the modules of each package take to import, the least of all [s]."""
    modules: dict[str, float] = {}
    for _ in range(RUNS):
        command = [sys.executable, '-X', 'importtime', '-c', IMPORTS]
        told = subprocess.run(
            command, env=ENVIRONMENT, stderr=subprocess.PIPE, text=True, check=True
        ).stderr
        # The wheels of ROS start the interpreter anew: the last list is that of the program.
        told = told.rpartition('imported package')[2]
        for own, module in re.findall(r'import time: +(\d+) \| +\d+ \| +(.*)', told):
            modules[module] = min(modules.get(module, float('inf')), int(own) / 1e6)
    packages: Counter[str] = Counter()
    for module, own in modules.items():
        packages['.'.join(module.split('.')[: 1 + module.startswith('physsim_ros.')])] += own
    return packages


def table() -> None:
    """Print times and memory."""
    first_pose()
    times = [first_pose() for _ in range(RUNS)]
    print(
        f'\nFrom the command to the first pose elsewhere: median {statistics.median(times):.2f} s,'
        f' {min(times):.2f} .. {max(times):.2f} s in {RUNS} runs'
    )
    packages = imports()
    print(f'Imports before it, {sum(packages.values()):.2f} s in all [ms]:')
    for package, own in packages.most_common():
        if own >= TOLD:
            print(f'{own * 1e3:7.0f}  {package}')
    print(f'Resident memory with {BODIES} bodies, no viewer: {memory():.0f} MB')
