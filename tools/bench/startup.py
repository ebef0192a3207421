# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Start and memory of the node: the installed executable, seen from outside."""

from __future__ import annotations

from collections import Counter
import re
import statistics
import subprocess
import sys
import time

from geometry_msgs.msg import PoseArray
from physsim_ros.testing.domain import own_domain
import psutil
from visualization_msgs.msg import Marker, MarkerArray

from .node_process import ENVIRONMENT, executable, Remote

RUNS = 3
BODIES = 1000
# Imports of the program before its first pose, and the least time of a package that is told [s].
IMPORTS = 'import physsim_ros.ros.node, physsim_ros.ros.programs.real_time_loop'
TOLD = 0.005


def first_pose() -> tuple[float, float]:
    """
    Return the time from the command to the first message elsewhere [s].

    :return: until the world runs; and from then until it is found. The stamp of the first message
        is the time for which the world has run
    """
    with own_domain() as domain, Remote(domain) as remote:
        poses = remote.last_of(PoseArray, '/physsim/poses')
        began = time.perf_counter()
        with executable(domain):
            remote.spin_until(poses)
            took, stamp = time.perf_counter() - began, poses().header.stamp
        found = stamp.sec + stamp.nanosec * 1e-9
        return took - found, found


def memory() -> float:
    """Return the resident memory of the node with its bodies [MB]."""
    with own_domain() as domain, executable(domain) as process, Remote(domain) as remote:
        poses = remote.last_of(PoseArray, '/physsim/poses')
        publisher = remote.node.create_publisher(MarkerArray, '/physsim/spawn_array', 10)
        remote.spin_until(poses)
        remote.spin_until(publisher.get_subscription_count)
        array = MarkerArray()
        for number in range(BODIES):
            marker = Marker(id=number, type=Marker.SPHERE)
            marker.scale.x = marker.scale.y = 0.5
            marker.pose.position.x, marker.pose.position.y = number % 40.0, number // 40.0
            array.markers.append(marker)
        publisher.publish(array)
        remote.spin_until(lambda: len(poses().poses) >= BODIES)
        return psutil.Process(process.pid).memory_info().rss / 2**20


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
    print(f'\nFrom the command to the first pose elsewhere, in {RUNS} runs [s]')
    parts = zip(*(first_pose() for _ in range(RUNS)), strict=True)
    for part, times in zip(('until the world runs', 'discovery after that'), parts, strict=True):
        print(
            f'{part}: median {statistics.median(times):.2f}, {min(times):.2f} .. {max(times):.2f}'
        )
    packages = imports()
    print(f'Imports before it, {sum(packages.values()):.2f} s in all [ms]:')
    for package, own in packages.most_common():
        if own >= TOLD:
            print(f'{own * 1e3:7.0f}  {package}')
    print(f'Resident memory with {BODIES} bodies, no viewer: {memory():.0f} MB')
