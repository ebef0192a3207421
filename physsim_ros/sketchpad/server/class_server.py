# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The page of a class with a world for each pupil.

Pupils come to it by one address, and each is sent to a world. A teacher sees who is where, and
opens any of them.

`seats` has who is where.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
import sys
from urllib.parse import quote, urlsplit

from physsim_ros.files import user_directory
from physsim_ros.model.checks import Whole
from physsim_ros.model.errors import Refusal, WorldFull
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.sketchpad.message import json_object
from physsim_ros.sketchpad.messages import fields
from physsim_ros.sketchpad.rights import Role
from physsim_ros.sketchpad.server.guarded import Guarded, GuardedSocket, POLICY_VIOLATION
from physsim_ros.sketchpad.server.page_handlers import ResultList
from physsim_ros.sketchpad.server.seats import MOST_OF_MACHINE, SEAT_AGE, Seats, WorldAddresses
from physsim_ros.sketchpad.server.website import BoundedServer, Site
from tornado.httpclient import AsyncHTTPClient, HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect, WebSocketClientConnection, WebSocketClosedError

# Size of a request [bytes].
MOST_BYTES = 4096
# Size of a message of a world that is watched [bytes].
_MOST_WATCHED = 2**25
# Time from one check whether the class is over to the next [s].
_CHECK_PERIOD = 0.2


class ClassServer:
    """
    The server of a class.

    :param worlds: addresses of the worlds
    :param address: to listen on
    :param port: to listen on, or the first free one after it
    :param seats_of_machine: greatest number of seats of one machine; 0 is no limit
    :raises PhysSimError: it cannot listen there
    """

    def __init__(
        self,
        worlds: Sequence[WorldAddresses],
        *,
        address: str,
        port: int,
        seats_of_machine: int = MOST_OF_MACHINE,
    ) -> None:
        self._site = Site(address, port)
        directory = user_directory('XDG_STATE_HOME', '.local', 'state')
        seats = Seats(worlds, directory / f'class_{self._site.port}.json', seats_of_machine)
        self._application = self._site.application(
            'class.html',
            [
                (r'/ws/([0-9]{1,4})', _Watch, {'seats': seats}),
                ('/seats', _SeatList, {'seats': seats, 'address': partial(self.url, Role.DRAW)}),
                ('/results', ResultList, {'files': [world.results for world in seats.worlds]}),
                ('/join', _Join, {'seats': seats}),
                ('/free', _Free, {'seats': seats}),
            ],
            ErrorBoundary(lambda text: sys.stderr.write(f'{text}\n')),
        )

    def url(self, role: Role) -> str:
        """Return the address of the class with its token."""
        return self._site.url(role)

    def run(self, is_over: Callable[[], bool]) -> None:
        """Serve until it is over."""
        asyncio.run(self._serve(is_over))

    async def _serve(self, is_over: Callable[[], bool]) -> None:
        server = BoundedServer(self._application, max_body_size=MOST_BYTES)
        server.add_sockets(self._site.sockets)
        # It is asked, since a signal handler of a thread sets it.
        while not is_over():  # noqa: ASYNC110
            await asyncio.sleep(_CHECK_PERIOD)
        server.stop()
        await server.close_all_connections()


class _SeatList(Guarded):
    """Who is where."""

    def initialize(self, seats: Seats, address: Callable[[], str]) -> None:
        """Set the seats, and the address of pupils."""
        self.seats, self.address = seats, address

    async def get(self) -> None:
        """Answer a teacher with names and addresses, others with nothing but their role."""
        teaches = self.role is Role.TEACH
        seats = zip(self.seats.names, self.seats.worlds, strict=True)
        listed = [{'name': name, 'address': world.teacher} for name, world in seats]
        told = {'seats': listed, 'pupils': self.address()} if teaches else {'seats': []}
        self.finish({'teacher': teaches, **told})


class _Watch(GuardedSocket):
    """
    A socket of a teacher's page to the world of a seat, handed on both ways.

    The world sends it as many frames as are watched, and it is nobody there (`/ws?watch`).
    """

    def initialize(self, seats: Seats) -> None:  # type: ignore[override]
        """Set the seats."""
        super().initialize()
        self._seats = seats
        self._world: WebSocketClientConnection | None = None

    async def open(self, number: str) -> None:  # noqa: A003 - tornado's name
        """Connect with the world."""
        if self.role is not Role.TEACH or int(number) >= len(self._seats.worlds):
            self.close(POLICY_VIOLATION, 'this is for teachers')
            return
        try:
            self._world = await _socket_to(self._seats.worlds[int(number)].teacher)
        except (OSError, HTTPClientError):
            # The page connects again.
            self.close()
            return
        self._handing_on = asyncio.create_task(self._hand_on(self._world))

    async def _hand_on(self, world: WebSocketClientConnection) -> None:
        """Hand on what the world sends until one side leaves."""
        try:
            with suppress(WebSocketClosedError):
                while (message := await world.read_message()) is not None:
                    await self.write_message(message, binary=isinstance(message, bytes))
        finally:
            # The teacher may have left before there was a socket.
            world.close()
        self.close()

    async def receive(self, message: str | bytes) -> None:
        """Hand a message on to the world."""
        if self._world is not None:
            await self._world.write_message(message, binary=isinstance(message, bytes))

    def on_close(self) -> None:
        """Leave the world."""
        if self._world is not None:
            self._world.close()


async def _socket_to(login: str) -> WebSocketClientConnection:
    """
    Return a socket to the world of an address with a token, which watches it.

    :raises OSError: it does not answer
    :raises HTTPClientError: it refuses
    """
    client, origin = AsyncHTTPClient(), '{0.scheme}://{0.netloc}'.format(urlsplit(login))
    answer = await client.fetch(login, follow_redirects=False, raise_error=False)
    cookie = answer.headers.get('Set-Cookie', '').partition(';')[0]
    url = origin.replace('http', 'ws', 1) + '/ws?watch'
    request = HTTPRequest(url, headers={'Cookie': cookie, 'Origin': origin})
    return await websocket_connect(request, max_message_size=_MOST_WATCHED)


class _Join(Guarded):
    """A pupil comes to the class."""

    def initialize(self, seats: Seats) -> None:
        """Set the seats."""
        self.seats = seats

    async def post(self) -> None:
        """Answer with the address of the pupil's world, and the key of the browser."""
        self.require_origin()
        self.require_drawing()
        cookie = f'{self.access.cookie}_seat'
        try:
            name, key = _name_and_key(self.request.body)
            keys, address = (key, self.get_cookie(cookie) or ''), self.request.remote_ip or ''
            number, key = self.seats.join(name, *keys, address=address)
        except WorldFull as refusal:
            self.refuse(409, refusal.text)
        except Refusal as refusal:
            self.refuse(400, refusal.text)
        # Some browsers forget what pages store, or a pupil asks twice.
        self.set_cookie(cookie, key, httponly=True, samesite='Strict', max_age=SEAT_AGE)
        name = quote(self.seats.names[number], safe='')
        self.finish({'address': f'{self.seats.worlds[number].pupil}#name={name}', 'key': key})


class _Free(Guarded):
    """A teacher frees a seat."""

    def initialize(self, seats: Seats) -> None:
        """Set the seats."""
        self.seats = seats

    async def post(self) -> None:
        """Free the seat of a number, from 0."""
        self.require_origin()
        if self.role is not Role.TEACH:
            self.refuse(403, 'this is for teachers')
        try:
            content = json_object(self.request.body)
            number = Whole(0, len(self.seats.worlds) - 1)(content.get('seat'), 'seat')
        except Refusal as refusal:
            self.refuse(400, str(refusal))
        self.seats.free(number)
        self.finish({'seats': self.seats.names})


def _name_and_key(body: bytes) -> tuple[str, str]:
    """
    Return the name of a pupil, and the key of the browser.

    :raises Refusal: the request is not well-formed
    """
    given = json_object(body)
    return fields.person(given.get('name'), 'name'), fields.text(given.get('key', ''), 'key')
