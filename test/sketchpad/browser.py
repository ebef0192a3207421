# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A page as a test has it: an HTTP client with a cookie, and sockets, in the fixture's time."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
import json
import struct
import time
from typing import Any, NamedTuple

import numpy as np
from physsim_ros.sketchpad import Role
from physsim_ros.sketchpad.server.frame_codec import Show, VERSION
from physsim_ros.testing import PhysSim
from tornado.httpclient import AsyncHTTPClient, HTTPRequest, HTTPResponse
from tornado.websocket import websocket_connect, WebSocketClientConnection

from ..outside import PATIENCE

# Tornado's own are 20 s.
TIMEOUTS = {'connect_timeout': PATIENCE, 'request_timeout': PATIENCE}


class Picture(NamedTuple):
    """A frame as a page gets it."""

    flags: int
    epoch: int
    time: float
    speed: float
    count: int
    columns: np.ndarray  # (3, n) float32 and what else is shown, as it comes

    @property
    def poses(self) -> np.ndarray:
        """(n, 3) float32."""
        return self.columns[: 3 * self.count].reshape(3, -1).T

    @property
    def hands(self) -> bool:
        """Whether hands drag bodies."""
        return bool(self.flags & Show.HANDS)

    @property
    def hand_lines(self) -> np.ndarray:
        """(h, 4) float32: grip x, y, hand x, y; of a frame without other parts."""
        begin = 3 * self.count + 1
        return self.columns[begin:].reshape(4, -1).T

    @property
    def scan(self) -> np.ndarray:
        """(3, k) float32: x, y, hit; of a frame without other parts."""
        begin = 3 * self.count + 1
        return self.columns[begin:].reshape(3, -1)


def decoded(message: bytes) -> Picture:
    """Decode a frame as the page's own module does."""
    version, flags, zero, epoch, seconds, speed, count = struct.unpack_from('<BBHIdfI', message)
    assert (version, zero) == (VERSION, 0)
    return Picture(flags, epoch, seconds, speed, count, np.frombuffer(message[24:], '<f4'))


class Page:
    """An open socket and all messages from it."""

    def __init__(self, browser: Browser, socket: WebSocketClientConnection) -> None:
        self.browser = browser
        self.socket = socket
        self.frames: list[Picture] = []
        self.ghosts: list[Picture] = []
        self.messages: list[dict[str, Any]] = []
        # Types of all of these, in their order.
        self.order: list[str] = []
        self.closed = False
        self._numbers = 0
        self._reading = browser.loop.create_task(self._read())

    async def _read(self) -> None:
        while (message := await self.socket.read_message()) is not None:
            if isinstance(message, bytes):
                picture = decoded(message)
                (self.ghosts if picture.flags & Show.GHOST else self.frames).append(picture)
                self.order.append('frame')
            else:
                self.messages.append(json.loads(message))
                self.order.append(self.messages[-1]['type'])
        self.closed = True

    def send(self, kind: str, **fields: Any) -> str:
        """Send a message, and return its id."""
        self._numbers += 1
        id_ = f'm{self._numbers}'
        self.send_raw(json.dumps({'id': id_, 'type': kind, **fields}))
        return id_

    def send_raw(self, message: str | bytes) -> None:
        async def write() -> None:
            await self.socket.write_message(message, binary=isinstance(message, bytes))

        self.browser.run(write())

    def of_type(self, kind: str) -> list[dict[str, Any]]:
        return [each for each in self.messages if each['type'] == kind]

    def last(self, kind: str) -> dict[str, Any]:
        """Wait for a message of a type, and return the last one."""
        self.until(lambda: self.of_type(kind))
        return self.of_type(kind)[-1]

    def answers(self, id_: str) -> list[dict[str, Any]]:
        return [each for each in self.of_type('answer') if each['request'] == id_]

    def ask(self, kind: str, **fields: Any) -> dict[str, Any]:
        """Send a message, and return its last answer once an answer has arrived."""
        id_ = self.send(kind, **fields)
        self.browser.until(lambda: self.answers(id_))
        return self.answers(id_)[-1]

    def spawn(self, name: str, x: float = 0.0, y: float = 5.0, **fields: Any) -> dict[str, Any]:
        """Add a body, a disc where its fields have no shape, and return the answer."""
        shape = {} if {'box', 'polygon', 'robot'} & fields.keys() else {'circle': {'radius': 0.5}}
        return self.ask('spawn', body={'name': name, 'at': [x, y], **shape, **fields})

    def until(self, predicate: Callable[[], object]) -> None:
        self.browser.until(predicate)

    def until_last(self, kind: str, predicate: Callable[[dict[str, Any]], object]) -> None:
        """Wait until something holds of the last message of a type."""
        self.until(lambda: any(map(predicate, self.of_type(kind)[-1:])))

    def until_frame(self, predicate: Callable[[Picture], object]) -> None:
        """Wait until something holds of the last frame of the course."""
        self.until(lambda: any(map(predicate, self.frames[-1:])))

    def close(self) -> None:
        self.socket.close()
        self.until(lambda: self.closed)


class Browser:
    """
    Clients of the page of a world, driven together with it.

    :param physsim: a world with a sketchpad
    """

    def __init__(self, physsim: PhysSim) -> None:
        self.physsim = physsim
        sketchpad = physsim.node.outputs.sketchpad
        assert sketchpad is not None
        self.url = sketchpad.url
        self.login = sketchpad.url()
        self.base = self.login.partition('/login')[0]
        self.loop = asyncio.new_event_loop()
        self._pages: list[Page] = []
        self.cookie = self.login_cookie(self.login)

    def run(self, coroutine: Coroutine[Any, Any, Any]) -> Any:
        """Wait for something, while the world's messages are handled; return its result."""
        task = self.loop.create_task(coroutine)
        self.until(task.done)
        return task.result()

    def until(self, predicate: Callable[[], object], *, settling: bool = True) -> None:
        """Run until something holds; without settling the world handles no message."""
        deadline = time.monotonic() + PATIENCE
        while not predicate():
            assert time.monotonic() < deadline, 'it did not come about in time'
            self.loop.run_until_complete(self._pass())
            if settling:
                self.physsim.settle()

    async def _pass(self) -> None:
        """Let the sockets work for as long as a message takes on its way."""
        await asyncio.sleep(0.001)

    def fetch(self, path: str, **options: Any) -> HTTPResponse:
        """Return the response to a request, whatever its status."""
        return self.run(self.begin_fetch(path, **options))

    async def begin_fetch(
        self, path: str, *, cookie: str | None = None, **options: Any
    ) -> HTTPResponse:
        """Return the response to a request, as a coroutine."""
        headers = {'Cookie': self.cookie if cookie is None else cookie}
        return await AsyncHTTPClient().fetch(
            self.base + path,
            headers=headers | options.pop('headers', {}),
            follow_redirects=False,
            raise_error=False,
            **TIMEOUTS,
            **options,
        )

    def upload(self, text: str | bytes, path: str = '/world', **options: Any) -> HTTPResponse:
        """Return the response to a file that is sent, whatever its status."""
        headers = {'Origin': self.base} | options.pop('headers', {})
        return self.fetch(path, method='POST', body=text, headers=headers, **options)

    def open_world(self, text: str) -> dict[str, Any]:
        """Replace the world by that of a text, and return the answer."""
        answer: dict[str, Any] = json.loads(self.upload(text).body)
        return answer

    def login_cookie(self, url: str) -> str:
        """Log in, and return the cookie; '' where none is given."""
        response = self.fetch(url.removeprefix(self.base), cookie='')
        return response.headers.get('Set-Cookie', '').partition(';')[0]

    def cookie_of(self, role: Role) -> str:
        """Log in by the address of a role, and return the cookie."""
        return self.login_cookie(self.url(role))

    def open_page(
        self, path: str = '/ws', *, cookie: str | None = None, origin: str | None = None
    ) -> Page:
        """Open a socket as a page does."""
        headers = {
            'Cookie': self.cookie if cookie is None else cookie,
            'Origin': self.base if origin is None else origin,
        }
        if not headers['Origin']:
            del headers['Origin']

        async def connect() -> WebSocketClientConnection:
            url = self.base.replace('http', 'ws') + path
            request = HTTPRequest(url, headers=headers, **TIMEOUTS)
            return await websocket_connect(request, max_message_size=2**27)

        self._pages.append(Page(self, self.run(connect())))
        return self._pages[-1]

    def close(self) -> None:
        """Close all pages, and end what waits for the server."""
        for page in self._pages:
            page.socket.close()
        self.until(lambda: all(page.closed for page in self._pages), settling=False)
        self.loop.run_until_complete(self._end())
        self.loop.close()

    async def _end(self) -> None:
        tasks = asyncio.all_tasks() - {asyncio.current_task()}
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        await self.loop.shutdown_default_executor()
