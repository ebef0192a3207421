# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Pages of the sketchpad without a browser: sockets that read all that comes.

`python -m tools.bench.page_client LOGIN COUNT STROKES` opens pages, prints `open`, then how long
each stroke of the first of them took to be a body [ms], and the mean bytes of its frames.
"""

from __future__ import annotations

import asyncio
import json
import math
import sys
import time

from tornado.httpclient import AsyncHTTPClient, HTTPRequest
from tornado.websocket import websocket_connect, WebSocketClientConnection


async def cookie_of(login: str) -> str:
    """Return the cookie that an address of a login gives."""
    response = await AsyncHTTPClient().fetch(login, follow_redirects=False, raise_error=False)
    return str(response.headers['Set-Cookie'].partition(';')[0])


async def open_page(login: str) -> WebSocketClientConnection:
    """Open the page of an address of a login."""
    origin = login.partition('/login')[0]
    headers = {'Cookie': await cookie_of(login), 'Origin': origin}
    request = HTTPRequest(origin.replace('http', 'ws') + '/ws', headers=headers)
    return await websocket_connect(request)


async def _main(login: str, count: int, strokes: int) -> None:
    pages = [await open_page(login) for _ in range(count)]
    sizes: list[int] = []
    bodies: list[int] = []

    async def read(page: WebSocketClientConnection) -> None:
        while (message := await page.read_message()) is not None:
            if page is not pages[0]:
                continue
            if isinstance(message, bytes):
                sizes.append(len(message))
            elif message.startswith('{"type":"scene"'):
                bodies.append(len(json.loads(message)['bodies']))

    readers = [asyncio.create_task(read(page)) for page in pages]
    while not sizes:  # noqa: ASYNC110 - a poll adds nothing to the work of the reader
        await asyncio.sleep(0.01)
    print('open', flush=True)
    for number in range(strokes):
        turns = [math.tau * each / 60 for each in range(61)]
        points = [[number + 0.4 * math.cos(t), 50 + 0.4 * math.sin(t), t / 6] for t in turns]
        before, began = bodies[-1], time.perf_counter()
        await pages[0].write_message(json.dumps({'id': 's', 'type': 'stroke', 'points': points}))
        while bodies[-1] == before or sizes[-1] < 24 + 12 * bodies[-1]:  # noqa: ASYNC110
            await asyncio.sleep(0.0005)
        print(1e3 * (time.perf_counter() - began), flush=True)
        await asyncio.sleep(0.1)
    print(sum(sizes) / len(sizes), flush=True)
    await asyncio.gather(*readers)


if __name__ == '__main__':
    asyncio.run(_main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])))
