# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A site: sockets that listen, its address, its tokens, what every site serves."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Awaitable, Callable, Sequence
from contextlib import suppress
import errno
from functools import partial
from ipaddress import ip_address
import resource
import socket
from typing import Any
from weakref import WeakSet

from physsim_ros.model.errors import PhysSimError
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.sketchpad.rights import Role
from physsim_ros.sketchpad.server.access import Access
from physsim_ros.sketchpad.server.page_handlers import (
    CookieCheck,
    Login,
    Missing,
    PAGE,
    Page,
    PageFiles,
    QrCode,
)
from physsim_ros.sketchpad.server.turns import Turns
from tornado.httpserver import HTTPServer
from tornado.httputil import (
    HTTPConnection,
    HTTPHeaders,
    HTTPInputError,
    HTTPMessageDelegate,
    RequestStartLine,
    ResponseStartLine,
)
from tornado.iostream import IOStream, StreamClosedError
from tornado.netutil import bind_sockets
from tornado.web import Application

# Connections at once, besides the sockets of pages, and their greatest share of the files that a
# process may have open.
MOST_CONNECTIONS, _SHARE_OF_FILES = 256, 0.25
# Time until a connection without a request, or a request without the rest of it, is closed [s];
# size of the headers of a request [bytes]: 16 KiB take 10 ms, before the request has its turn.
LIMITS = {'idle_connection_timeout': 10.0, 'body_timeout': 10.0, 'max_header_size': 2**14}
# Ports that are tried after the given one.
_MORE_PORTS = 20


class Site:
    """
    A site of pages: what the server of a world and that of a class have in common.

    :param address: to listen on
    :param port: to listen on; where it is taken, one of the next; 0 is any
    :raises PhysSimError: it cannot listen there

    :ivar sockets: that listen
    :ivar port: that they listen on
    """

    def __init__(self, address: str, port: int) -> None:
        self.sockets = listening_sockets(address, port)
        self.port: int = self.sockets[0].getsockname()[1]
        self._address = address
        self._access = Access(address, self.port)

    def url(self, role: Role) -> str:
        """Return the address of the site with the token of a role."""
        host = reachable_host(self._address)
        return f'http://{host}:{self.port}/login?token={self._access.tokens[role]}'

    def application(
        self, page: str, handlers: Sequence[Any], boundary: ErrorBoundary, **options: Any
    ) -> Application:
        """
        Return the application of a site.

        :param page: name of the file of its page
        :param handlers: of other requests
        :param boundary: where unexpected errors end
        :param options: of tornado
        """
        return Application(
            [
                ('/', Page, {'file': page}),
                ('/login', Login),
                ('/session', CookieCheck),
                ('/qr.svg', QrCode, {'address': partial(self.url, Role.DRAW)}),
                ('/page/(.*)', PageFiles, {'path': str(PAGE)}),
                *handlers,
            ],
            access=self._access,
            boundary=boundary,
            turns=Turns(),
            compress_response=True,
            default_handler_class=Missing,
            # Answers with an error concern those who asked.
            log_function=lambda _: None,
            **options,
        )


def most_connections() -> int:
    """Return the number of connections at once that leaves the process files for all else."""
    files, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return min(MOST_CONNECTIONS, int(_SHARE_OF_FILES * files))


class BoundedServer(HTTPServer):
    """
    A server of a bounded number of connections, whose requests have turns.

    Law: a connection that asks nothing, does not read, or waits for its turn shuts nobody out.
    Beyond the number, that one of the address with most connections is closed whose request was
    begun first.
    """

    def initialize(self, request_callback: Any, *arguments: Any, **options: Any) -> None:
        """Begin without a connection, as `HTTPServer` does; the callback is an `Application`."""
        super().initialize(request_callback, *arguments, **(LIMITS | options))
        self._turns: Turns = request_callback.settings['turns']
        # All connections; those whose request was begun first, or has not come, are first.
        self._by_age: dict[Any, None] = {}
        self._streams: WeakSet[IOStream] = WeakSet()

    def handle_stream(self, stream: IOStream, address: Any) -> None:
        """Serve a connection; where there are too many, close one."""
        self._streams.add(stream)
        if len(self._by_age) >= most_connections():
            numbers = Counter(map(_address_of, self._by_age))
            oldest = max(self._by_age, key=lambda each: numbers[_address_of(each)])
            del self._by_age[oldest]
            oldest.stream.close()
            self._turns.give_up(oldest)
        super().handle_stream(stream, address)

    def start_request(
        self, server_conn: object, request_conn: HTTPConnection
    ) -> HTTPMessageDelegate:
        """Wait for the next request of a connection, and its turn."""
        self._by_age.pop(server_conn, None)
        self._by_age[server_conn] = None
        delegate = super().start_request(server_conn, request_conn)
        return _InTurn(delegate, partial(self._take_turn, server_conn))

    async def _take_turn(self, connection: Any) -> None:
        """
        Wait for the turn of a request.

        :raises HTTPInputError: the client has left; tornado would answer all that it has sent
        """
        with suppress(StreamClosedError):
            await self._turns.take(connection, _address_of(connection))
        if connection.stream.closed():
            raise HTTPInputError('the client has left')

    async def close_all_connections(self) -> None:
        """Close all connections, also those of web sockets, which tornado has detached."""
        await super().close_all_connections()
        for stream in [*self._streams]:
            stream.close()
        # Their readers end.
        await asyncio.sleep(0.0)

    def on_close(self, server_conn: object) -> None:
        """Forget a connection."""
        self._by_age.pop(server_conn, None)
        super().on_close(server_conn)


class _InTurn(HTTPMessageDelegate):
    """
    A request that waits for its turn when its headers have come.

    :param delegate: receives it
    :param take_turn: waits
    """

    def __init__(
        self, delegate: HTTPMessageDelegate, take_turn: Callable[[], Awaitable[None]]
    ) -> None:
        self._delegate = delegate
        self._take_turn = take_turn

    async def headers_received(
        self, start_line: RequestStartLine | ResponseStartLine, headers: HTTPHeaders
    ) -> None:
        """Wait for the turn; meanwhile nothing more is read from the connection."""
        await self._take_turn()
        received = self._delegate.headers_received(start_line, headers)
        if received is not None:
            await received

    def data_received(self, chunk: bytes) -> Awaitable[None] | None:
        """Hand a part of the body on."""
        return self._delegate.data_received(chunk)

    def finish(self) -> None:
        """Have the request answered."""
        self._delegate.finish()

    def on_connection_close(self) -> None:
        """Tell that the client has left."""
        self._delegate.on_connection_close()


def _address_of(connection: Any) -> str:
    """Return the address of the client of a connection."""
    return str(connection.context.remote_ip)


def listening_sockets(address: str, port: int) -> list[socket.socket]:
    """
    Return sockets that listen on a port, or on one of the next.

    :raises PhysSimError: this machine does not have the address, or all ports are taken
    """
    last = port if port == 0 else min(port + _MORE_PORTS, 65535)
    for tried in range(port, last + 1):
        try:
            return bind_sockets(tried, address)
        except PermissionError as error:
            reason = str(error)
        except (OSError, UnicodeError) as error:
            # The error of an invalid name, as `a..b`, has no errno.
            if tried == last or getattr(error, 'errno', None) != errno.EADDRINUSE:
                raise PhysSimError(
                    f'the sketchpad cannot listen on {address!r}, port {tried}: {error}'
                ) from error
            continue
        raise PhysSimError(f'the sketchpad may not listen on port {tried}: {reason}')
    raise PhysSimError(f'the ports {port} to {last} are all taken')


def reachable_host(address: str) -> str:
    """Return the host of the page's address: that of this machine where it listens on all."""
    if not address or _is_unspecified(address):
        return _own_address()
    return f'[{address}]' if ':' in address else address


def _is_unspecified(address: str) -> bool:
    """Tell whether an address stands for all of a machine: 0.0.0.0 or ::."""
    try:
        return ip_address(address).is_unspecified
    except ValueError:
        return False


def _own_address() -> str:
    """Return the address of this machine in its network; no packet is sent."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            # TEST-NET-1, RFC 5737: routed like any other address, and never in use.
            probe.connect(('192.0.2.1', 9))
        except OSError:
            return socket.gethostname()
        return str(probe.getsockname()[0])
