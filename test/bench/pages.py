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
What pages of the sketchpad cost the world's loop, and how soon a stroke is a body.

The pages are sockets in another process, which read all that comes. Turns without pages, with one
and with many follow each other, so that a machine whose speed drifts does not favour one of them.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time

from physsim_ros.ros.node import PhysSimNode
import rclpy
from rclpy.logging import LoggingSeverity
from rclpy.parameter import Parameter

from .bodies import fill, SETTLE
from ..outside import own_domain

COUNTS = (0, 1, 20)
ROUNDS = 3
# Frames of a turn at 60 Hz, and those before them that do not count.
FRAMES, WARM = 180, 30
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


def ticks(node: PhysSimNode, frames: int) -> list[float]:
    """Run at 60 Hz; return the time that each tick took [ms]."""
    times = []
    due = time.perf_counter()
    for _ in range(frames):
        began = time.perf_counter()
        node.tick(time.monotonic_ns())
        times.append(1e3 * (time.perf_counter() - began))
        due += PERIOD
        time.sleep(max(0.0, due - time.perf_counter()))
    return times


def served_world(bodies: int) -> PhysSimNode:
    """Return a node that serves its page, with a settled pile of bodies."""
    values = {'viewer': 'none', 'sketchpad': 'serve', 'sketchpad_port': 0, 'speed': 0.0}
    node = PhysSimNode(
        parameter_overrides=[Parameter(name, value=value) for name, value in values.items()]
    )
    node.get_logger().set_level(LoggingSeverity.WARN)
    fill(node.simulation.world, bodies, settle=SETTLE)
    node.simulation.speed = 1.0
    return node


def measure(bodies: int) -> None:
    """Print the rows of a count of bodies."""
    node = served_world(bodies)
    times: dict[int, list[float]] = {count: [] for count in COUNTS}
    cpu: dict[int, float] = dict.fromkeys(COUNTS, 0.0)
    try:
        for _ in range(ROUNDS):
            for count in COUNTS:
                clients = Clients(node, count) if count else None
                ticks(node, WARM)
                if clients is not None:
                    clients.read_line()
                began = time.process_time()
                times[count] += ticks(node, FRAMES)
                cpu[count] += time.process_time() - began
                if clients is not None:
                    clients.close()
        alone = statistics.median(times[0])
        for count, each in times.items():
            median, share = statistics.median(each), 1e3 * cpu[count] / ROUNDS / FRAMES
            print(
                f'{bodies:6} {count:6} {median:10.2f} {100 * (median / alone - 1):+10.1f}'
                f' {share:12.2f}',
                flush=True,
            )
    finally:
        node.destroy_node()


def measure_strokes(bodies: int) -> None:
    """Print how long it takes from a stroke to its body, and the size of a frame."""
    node = served_world(bodies)
    clients = Clients(node, 1, STROKES)
    try:
        # A tick a frame; the client is done long before them.
        ticks(node, WARM + 60 * STROKES // 3)
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
        print('bodies  pages  tick [ms]  cost [%]  CPU/frame [ms]')
        measure(bodies)
        print('bodies  stroke to body [ms]  greatest  bytes/frame  bytes/body')
        for count in (100, bodies):
            measure_strokes(count)
        rclpy.shutdown()
