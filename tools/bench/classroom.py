# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A class: as many worlds as pupils, each with a page that reads all that comes, in real time.

A world has ten balls in a box, one of which its pupil lifts each second.
"""

from __future__ import annotations

import asyncio
from contextlib import ExitStack
import json
from pathlib import Path
import re
import struct
import tempfile
from test.outside import Outside
import time

from physsim_ros.testing.domain import own_domain
from tornado.httpclient import AsyncHTTPClient
from tornado.websocket import WebSocketClientConnection

from .node_process import cpu_seconds
from .page_client import cookie_of, open_page

PUPILS = (10, 30)
# Wall time in which the worlds are watched [s].
SECONDS = 20.0
WORLD = 'format: 1\nbounds: [-5, 0, 5, 8]\nelasticity: 0.6\nbodies:\n' + ''.join(
    f'  - {{name: ball/{each}, circle: {{radius: 0.3}}, at: [{each - 4.5}, {1 + each % 4}]}}\n'
    for each in range(10)
)


async def _open_pages(teacher: str) -> list[WebSocketClientConnection]:
    """Open a page of each world of a class."""
    seats = teacher.partition('/login')[0] + '/seats'
    headers = {'Cookie': await cookie_of(teacher)}
    response = await AsyncHTTPClient().fetch(seats, headers=headers)
    return [await open_page(seat['address']) for seat in json.loads(response.body)['seats']]


async def _watch(teacher: str) -> list[float]:
    """Return the simulation time of each world in the time in which they are watched [s]."""
    pages = await _open_pages(teacher)
    times: list[list[float]] = [[] for _ in pages]

    async def read(number: int) -> None:
        while (message := await pages[number].read_message()) is not None:
            if isinstance(message, bytes):
                times[number].append(struct.unpack_from('<d', message, 8)[0])

    readers = [asyncio.create_task(read(number)) for number in range(len(pages))]
    await asyncio.sleep(2.0)
    first = [each[-1] for each in times]
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        for page in pages:
            lift = {'id': '', 'type': 'move_bodies', 'names': ['ball/0'], 'by': [0, 0.5]}
            await page.write_message(json.dumps(lift))
        await asyncio.sleep(1.0)
    passed = [each[-1] - begun for each, begun in zip(times, first, strict=True)]
    for reader in readers:
        reader.cancel()
    return passed


def _measured(pupils: int) -> tuple[float, float, float]:
    """Return the least and the mean pace of the worlds, and their processors."""
    with ExitStack() as closing:
        domain = closing.enter_context(own_domain())
        directory = Path(closing.enter_context(tempfile.TemporaryDirectory()))
        outside = Outside(directory, domain, closing)
        outside.environment['XDG_DATA_HOME'] = str(directory)
        world = directory / 'balls.yaml'
        world.write_text(WORLD, encoding='utf-8')
        program = outside.start_installed(
            *('physsim_class', '--port', 0, '--pupils', pupils, '--ros-args'),
            *('-p', f'world_file:={world}', '--log-level', 'warn'),
        )
        teacher = re.search(r'http\S+', program.wait_for('teacher', 300))
        assert teacher is not None
        before, began = cpu_seconds(program.process.pid), time.monotonic()
        paces = [each / SECONDS for each in asyncio.run(_watch(teacher[0]))]
        processors = (cpu_seconds(program.process.pid) - before) / (time.monotonic() - began)
    return min(paces), sum(paces) / len(paces), processors


def table() -> None:
    """Print the pace of a class."""
    print('\nA class with a world for each pupil, a page open in each')
    print(f'{"pupils":>8}{"least pace":>12}{"mean pace":>12}{"processors":>12}{"at pace 1":>12}')
    for count in PUPILS:
        least, mean, processors = _measured(count)
        needed = processors / mean
        print(f'{count:8d}{least:12.2f}{mean:12.2f}{processors:12.2f}{needed:12.2f}')
