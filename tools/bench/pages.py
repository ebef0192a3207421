# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The cost of pages of the sketchpad in the world's loop, and how soon a stroke is a body.

The pages are sockets in another process, which read all that comes. Two equal worlds take turns,
frame by frame, one with pages and one without: the cost is the median of the differences of their
frames, so that neither a machine whose speed drifts nor a frame that was disturbed changes it.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
import statistics
import subprocess
import sys
import time

import numpy as np
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.testing.domain import own_domain
import rclpy
from rclpy.logging import LoggingSeverity
from rclpy.parameter import Parameter

from .bodies import fill, SETTLE

# Zero pages show how equal the two worlds are.
COUNTS = (0, 1, 20)
# Number of compared frames, and of frames before them that do not count.
FRAMES, WARM = 360, 30
# Pause between the frames of the two worlds, in which pages do their work beside the loop.
PERIOD = 1 / 60
STROKES = 20
# Opens pages; prints the mean bytes of their frames, then how long each stroke took [ms].
CLIENT = """
import asyncio, json, math, sys, time
from tornado.httpclient import AsyncHTTPClient, HTTPRequest
from tornado.websocket import websocket_connect

async def main(login, count, strokes):
    base = login.partition('/login')[0]
    response = await AsyncHTTPClient().fetch(login, follow_redirects=False, raise_error=False)
    headers = {'Cookie': response.headers['Set-Cookie'].partition(';')[0], 'Origin': base}
    address = base.replace('http', 'ws') + '/ws'
    request = HTTPRequest(address, headers=headers)
    sockets = [await websocket_connect(request) for _ in range(count)]
    sizes, bodies = [], []

    async def read(socket, first):
        while (message := await socket.read_message()) is not None:
            if first and isinstance(message, bytes):
                sizes.append(len(message))
            elif first and message.startswith('{"type":"scene"'):
                bodies.append(len(json.loads(message)['bodies']))

    readers = [asyncio.create_task(read(each, each is sockets[0])) for each in sockets]
    while not sizes:
        await asyncio.sleep(0.01)
    print('open', flush=True)
    for number in range(strokes):
        turns = [math.tau * each / 60 for each in range(61)]
        points = [[number + 0.4 * math.cos(t), 50 + 0.4 * math.sin(t), t / 6] for t in turns]
        before, frames, began = bodies[-1], len(sizes), time.perf_counter()
        await sockets[0].write_message(json.dumps({'id': 's', 'type': 'stroke', 'points': points}))
        while bodies[-1] == before or sizes[-1] < 24 + 12 * bodies[-1]:
            await asyncio.sleep(0.0005)
        print(1e3 * (time.perf_counter() - began), flush=True)
        await asyncio.sleep(0.1)
    print('bytes', sum(sizes) / len(sizes), flush=True)
    await asyncio.gather(*readers)

asyncio.run(main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])))
"""


class Clients:
    """
    Pages in another process.

    :param node: that serves them
    :param count: of pages
    :param strokes: that the first of them draws
    """

    def __init__(self, node: PhysSimNode, count: int, strokes: int = 0) -> None:
        assert node.outputs.sketchpad is not None
        self._process = subprocess.Popen(
            [sys.executable, '-c', CLIENT, node.outputs.sketchpad.url(), str(count), str(strokes)],
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self._process.stdout is not None
        self._lines = self._process.stdout

    def read_line(self) -> list[str]:
        """Return the words of the next line."""
        return self._lines.readline().split()

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.wait()


def served_world(bodies: int) -> PhysSimNode:
    """Return a node with a settled pile, whose pages are served."""
    values = {'viewer': 'none', 'sketchpad': 'serve', 'sketchpad_port': 0, 'speed': 0.0}
    node = PhysSimNode(
        parameter_overrides=[Parameter(name, value=value) for name, value in values.items()]
    )
    node.get_logger().set_level(LoggingSeverity.WARN)
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


def measure(bodies: int) -> None:
    """Print the rows of a count of bodies."""
    alone, paged = served_world(bodies), served_world(bodies)
    try:
        for count in COUNTS:
            clients = Clients(paged, count) if count else None
            ticks((alone, paged), WARM)
            if clients is not None:
                clients.read_line()
            times = ticks((alone, paged), FRAMES)
            if clients is not None:
                clients.close()
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
    clients = Clients(node, 1, STROKES)
    try:
        # Each frame has a tick; the client has finished long before.
        ticks((node,), WARM + 60 * STROKES // 3)
        assert clients.read_line() == ['open']
        took = [float(clients.read_line()[0]) for _ in range(STROKES)]
        size = float(clients.read_line()[1])
    finally:
        clients.close()
        node.destroy_node()
    median = statistics.median(took)
    print(
        f'{bodies:6} {median:16.1f} {max(took):8.1f} {size:12.0f} {size / bodies:12.1f}',
        flush=True,
    )


def table(bodies: int = 1000) -> None:
    """Print what pages cost, and how soon they see what they draw."""
    with own_domain() as domain:
        rclpy.init(domain_id=domain)
        print('\nPages of the sketchpad, a settled pile at 60 Hz, recorded by nobody')
        print('bodies  pages  frame [ms]  more [%]   +-  CPU [ms]  more [%]   +-')
        measure(bodies)
        print('bodies  stroke to body [ms]  greatest  bytes/frame  bytes/body')
        for count in (100, bodies):
            measure_strokes(count)
        rclpy.shutdown()
