# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The cost of pages of the sketchpad in the world's loop, and how soon a stroke is a body.

The pages are sockets in another process, which read all that comes. Two equal worlds take turns,
frame by frame, one with pages and one without: the cost is the median of the differences of their
frames, so that neither a machine whose speed drifts nor a frame that was disturbed changes it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
import math
from pathlib import Path
import statistics
import subprocess
import sys
import time

import numpy as np
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.testing.domain import own_domain
import rclpy
from rclpy.context import Context
from rclpy.logging import LoggingSeverity
from rclpy.parameter import Parameter

from .bodies import fill, SETTLE

ROOT = Path(__file__).parents[2]
BODIES = 1000
# Zero pages show how equal the two worlds are.
COUNTS = (0, 1, 20)
# Number of compared frames, and of frames before them that do not count.
FRAMES, WARM = 360, 30
# Pause between the frames of the two worlds, in which pages do their work beside the loop.
PERIOD = 1 / 60
STROKES = 20


@contextmanager
def open_pages(node: PhysSimNode, count: int, strokes: int = 0) -> Iterator[Callable[[], str]]:
    """
    Open pages in another process, and give a function of its next line; see `page_client`.

    :param node: that serves them
    :param count: of pages; without any there is no process
    :param strokes: that the first of them draws
    """
    if not count:
        yield str
        return
    assert node.outputs.sketchpad is not None
    words = ['-m', 'tools.bench.page_client', node.outputs.sketchpad.url(), str(count)]
    process = subprocess.Popen(
        [sys.executable, *words, str(strokes)], cwd=ROOT, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    try:
        yield process.stdout.readline
    finally:
        process.kill()
        process.wait()


def served_node(context: Context | None = None) -> PhysSimNode:
    """Return a paused node of an empty world, whose pages are served."""
    values = {'viewer': 'none', 'sketchpad': 'serve', 'sketchpad_port': 0, 'speed': 0.0}
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    node = PhysSimNode(context=context, parameter_overrides=overrides)
    node.get_logger().set_level(LoggingSeverity.WARN)
    return node


def served_world(bodies: int) -> PhysSimNode:
    """Return a node with a settled pile, whose pages are served."""
    node = served_node()
    fill(node.simulation.world, bodies, settle=SETTLE)
    node.simulation.speed = 1.0
    return node


def ticks(nodes: Sequence[PhysSimNode], frames: int) -> np.ndarray:
    """
    Run nodes in turns, each frame of theirs a 60th of a second of simulation.

    :return: (frames, n, 2) float64: wall time of each tick, and its CPU time in this thread [ms]
    """
    times = np.empty((frames, len(nodes), 2))
    due, now = time.perf_counter(), time.monotonic_ns()
    for row in times:
        now += round(1e9 / 60)
        for column, node in enumerate(nodes):
            began, used = time.perf_counter(), time.thread_time()
            node.tick(now)
            row[column] = time.perf_counter() - began, time.thread_time() - used
            due += PERIOD
            time.sleep(max(0.0, due - time.perf_counter()))
    return 1e3 * times


def run_until(
    nodes: Sequence[PhysSimNode], read_line: Callable[[], str], count: int = 1
) -> list[str]:
    """Run nodes until their pages have printed so many lines, and return these."""
    with ThreadPoolExecutor(1) as pool:
        found = pool.submit(lambda: [read_line() for _ in range(count)])
        ticks(nodes, WARM)
        while not found.done():
            ticks(nodes, WARM)
    return found.result()


def measure(bodies: int) -> None:
    """Print the rows of a count of bodies."""
    alone, paged = served_world(bodies), served_world(bodies)
    try:
        for count in COUNTS:
            with open_pages(paged, count) as read_line:
                run_until((alone, paged), read_line)
                times = ticks((alone, paged), FRAMES)
            words = [f'{bodies:6} {count:6}']
            for kind in range(2):
                median = float(np.median(times[:, 0, kind]))
                costs = times[:, 1, kind] - times[:, 0, kind]
                quarter, cost, rest = np.quantile(costs, (0.25, 0.5, 0.75))
                # Of a median of n values: 0.93 (q3 - q1) / sqrt(n), for a normal distribution.
                error = 0.93 * (rest - quarter) / math.sqrt(FRAMES)
                share = 100 / median
                words.append(f'{median:10.2f} {share * cost:9.1f} {share * error:5.1f}')
            print(*words, flush=True)
    finally:
        alone.destroy_node()
        paged.destroy_node()


def measure_strokes(bodies: int) -> None:
    """Print how long it takes from a stroke to its body, and the size of a frame."""
    node = served_world(bodies)
    try:
        with open_pages(node, 1, STROKES) as read_line:
            opened, *took, size = run_until((node,), read_line, STROKES + 2)
            assert opened == 'open\n'
    finally:
        node.destroy_node()
    times, each = [float(line) for line in took], float(size)
    print(
        f'{bodies:6} {statistics.median(times):16.1f} {max(times):8.1f} {each:12.0f}'
        f' {each / bodies:12.1f}',
        flush=True,
    )


def table() -> None:
    """Print what pages cost, and how soon they see what they draw."""
    with own_domain() as domain:
        rclpy.init(domain_id=domain)
        print('\nPages of the sketchpad, a settled pile at 60 Hz, recorded by nobody')
        print('bodies  pages  frame [ms]  more [%]   +-  CPU [ms]  more [%]   +-')
        measure(BODIES)
        print('bodies  stroke to body [ms]  greatest  bytes/frame  bytes/body')
        for count in (100, BODIES):
            measure_strokes(count)
        rclpy.shutdown()
