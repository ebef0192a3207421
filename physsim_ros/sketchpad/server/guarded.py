# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The checks of every request and every web socket: host, cookie, origin, rate of messages.

Laws: every request passes `Guarded.prepare` before it is answered; a socket that sends faster than
a page does is closed.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable
from html import escape
from http import HTTPStatus
import time
from typing import Any, NoReturn

from physsim_ros.model.errors import Busy
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.sketchpad.message import text_content
from physsim_ros.sketchpad.rights import Role
from physsim_ros.sketchpad.server.access import Access, headers_for
from physsim_ros.sketchpad.server.turns import Turns
from tornado.iostream import StreamClosedError
from tornado.web import HTTPError, RequestHandler, stream_request_body
from tornado.websocket import (
    WebSocketClosedError,
    WebSocketHandler,
    WebSocketProtocol,
    WebSocketProtocol13,
)

# Content types by suffix; the machine's own table may lack some.
TYPES = {
    '.css': 'text/css; charset=utf-8',
    '.html': 'text/html; charset=utf-8',
    '.js': 'text/javascript; charset=utf-8',
    '.json': 'application/json',
    '.png': 'image/png',
    '.svg': 'image/svg+xml',
    '.webmanifest': 'application/manifest+json',
    '.yaml': 'application/yaml; charset=utf-8',
}
# Rate of the frames of a socket in the long run [1/s], and frames at once: a message is one frame,
# or a few. A pen and a hand send one message each frame of the page, at 60 to 144 Hz.
RATE, BURST = 200.0, 400.0
# Time from one frame of a socket that is being closed to the next [s].
PAUSE = 0.005
# Size of a file that is read to its end though it is refused [bytes].
MOST_READ = 2**26
# Errors of a client that has left.
LEFT = (StreamClosedError, WebSocketClosedError)
# Codes of closing, RFC 6455, section 7.4.1; the last one is this server's own.
POLICY_VIOLATION, TOO_BIG, REPLACED = 1008, 1009, 4000

# A refusal as a browser shows it. The page's own style is behind the cookie, and the policy allows
# nothing inline.
_REFUSAL = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>physsim</title>
<h1>This cannot be opened</h1>
<p>{reason}.</p>
<p>The node prints the address of its page when it starts, with a token that is new each time: copy
that one from the terminal, or ask the person who started it.</p>
</html>
"""


class Guarded(RequestHandler):
    """
    A handler behind the checks of host and cookie.

    :ivar role: that the cookie gives; None without a valid cookie
    """

    needs_cookie = True
    role: Role | None = None
    _refusal = _code = ''

    @property
    def access(self) -> Access:
        """Return the tokens and checks of the server."""
        access: Access = self.settings['access']
        return access

    def set_default_headers(self) -> None:
        """Set the headers of every answer, errors included."""
        self.set_header('Server', 'physsim')
        host = self.request.host
        known = host if self.access.allows_host(host) else 'localhost'
        for name, value in headers_for(known).items():
            self.set_header(name, value)

    @property
    def boundary(self) -> ErrorBoundary:
        """Return the error boundary of the node."""
        boundary: ErrorBoundary = self.settings['boundary']
        return boundary

    @property
    def turns(self) -> Turns:
        """Return the turns of the server."""
        turns: Turns = self.settings['turns']
        return turns

    async def prepare(self) -> None:
        """Refuse a foreign host, and a request without the cookie."""
        if not self.access.allows_host(self.request.host):
            self.refuse(403, 'this name is not one of this machine')
        self.role = self.access.role_of_cookie(self.get_cookie(self.access.cookie) or '')
        if self.needs_cookie and self.role is None:
            self.refuse(403, 'open the address that the node has printed: it holds the token')

    def head(self, *arguments: str) -> Awaitable[None] | None:
        """Answer as `get` does; tornado sends the headers alone."""
        return self.get(*arguments)

    def on_finish(self) -> None:
        """End the turn of the request."""
        self.turns.end()

    def require_origin(self) -> None:
        """Refuse a request that no page of this server has made."""
        origin = self.request.headers.get('Origin')
        if not self.access.allows_origin(origin, self.request.host):
            self.refuse(403, 'this request comes from another page')

    def require_drawing(self) -> None:
        """Refuse a request of a page that only shows the world."""
        if self.role is None or not self.role.draws:
            self.refuse(403, 'this page only shows the world')

    def refuse(self, status: int, reason: str, code: str = '') -> NoReturn:
        """Answer with an error and its reason, and to programs with its code where it has one."""
        self._refusal, self._code = reason, code
        raise HTTPError(status)

    def log_exception(self, *details: Any) -> None:
        """Note the unexpected errors of this server, not those of its clients."""
        error = details[1]
        if not isinstance(error, (HTTPError, *LEFT)):
            self._refusal = str(self.boundary.failed('page', error))

    def write_error(self, status_code: int, **_: Any) -> None:
        """Write the reason of a refusal, or the meaning of the status; nothing of the request."""
        reason = self._refusal or HTTPStatus(status_code).phrase
        accepted = self.request.headers.get('Accept', '')
        if self._code or 'application/json' in accepted:
            text = text_content(reason)
            self.finish({'ok': False, 'message': reason, 'text': text, 'code': self._code})
            return
        if 'text/html' not in accepted:
            self.set_header('Content-Type', 'text/plain; charset=utf-8')
            self.finish(f'{reason}\n')
            return
        # A person has opened the address in a browser.
        self.set_header('Content-Type', TYPES['.html'])
        self.finish(_REFUSAL.format(reason=escape(reason[:1].upper() + reason[1:])))


@stream_request_body
class GuardedUpload(Guarded):
    """
    A handler of files that a drawing page of this server sends.

    A file that is too large is read to its end, and not kept: a client that is refused before has
    nothing but a broken connection.

    :cvar most: greatest size [bytes]
    """

    most: int
    _size = 0

    async def prepare(self) -> None:
        """Refuse who may not send files, and what is too large to be read, before the file."""
        self._parts: list[bytes] = []
        connection: Any = self.request.connection
        connection.set_max_body_size(MOST_READ)
        await super().prepare()
        if self.request.method != 'POST':
            return
        self.require_origin()
        self.require_drawing()
        length = self.request.headers.get('Content-Length', '')
        if length.isdecimal() and int(length) > MOST_READ:
            self.refuse_size()

    def data_received(self, chunk: bytes) -> None:
        """Keep a part of a file that is not too large."""
        self._size += len(chunk)
        if self._size <= self.most:
            self._parts.append(chunk)
        else:
            self._parts.clear()

    @property
    def content(self) -> bytes:
        """Return the file; one that is too large is refused."""
        if self._size > self.most:
            self.refuse_size()
        return b''.join(self._parts)

    def refuse_size(self) -> NoReturn:
        """Answer with an error about the size of the file."""
        self.refuse(413, f'a file has at most {self.most / 2**10:g} KiB here', code='malformed')


class GuardedSocket(Guarded, WebSocketHandler):
    """A web socket of a page of this server, with a token bucket for its frames."""

    # RFC 6455, section 4.1; the headers of a handshake are no answer.
    SUPPORTED_METHODS = ('GET',)

    def initialize(self) -> None:
        """Fill the bucket."""
        self._tokens, self._refilled = BURST, time.monotonic()

    @property
    def too_many(self) -> str:
        """Return why one more socket is refused; '' where there is room for it, as here."""
        return ''

    def check_origin(self, origin: str) -> bool:
        """Accept the pages of this server."""
        return self.access.allows_origin(origin, self.request.host)

    async def prepare(self) -> None:
        """Refuse a page without the right to be here, or one too many."""
        await super().prepare()
        # A browser always sends the origin; tornado checks it only where it is there.
        self.require_origin()
        if reason := self.too_many:
            self.refuse(503, reason, Busy.code)

    def get_websocket_protocol(self) -> WebSocketProtocol | None:
        """Return the protocol of this socket, whose frames are limited."""
        protocol = super().get_websocket_protocol()
        if isinstance(protocol, WebSocketProtocol13):
            return _LimitedFrames(self, protocol.mask_outgoing, protocol.params)
        return protocol

    def on_message(self, message: str | bytes) -> Awaitable[None] | None:
        """Receive a message in its turn; until then, nothing more is read from the socket."""
        if self.ws_connection is None or self.ws_connection.is_closing():
            return None
        if self.turns.begin(self):
            return self._receive(message)
        return self._receive_later(message)

    async def _receive_later(self, message: str | bytes) -> None:
        await self.turns.take(self, self)
        received = self._receive(message)
        if received is not None:
            await received

    def _receive(self, message: str | bytes) -> Awaitable[None] | None:
        received = self.receive(message)
        self.turns.end()
        return received

    def receive(self, message: str | bytes) -> Awaitable[None] | None:
        """Receive a message in its turn; the socket may be closed already."""
        raise NotImplementedError

    def take_token(self) -> bool:
        """
        Take a token of the bucket that limits the rate of frames.

        :return: whether there was one; without one the socket is closed
        """
        now = time.monotonic()
        self._tokens = min(BURST, self._tokens + RATE * (now - self._refilled))
        self._refilled = now
        if self._tokens < 1.0:
            self.close(POLICY_VIOLATION, 'too many messages')
            return False
        self._tokens -= 1.0
        return True


class _LimitedFrames(WebSocketProtocol13):
    """
    The protocol of a socket, each frame of which takes a token: also a ping, and an empty part.

    Tornado 6.6 tells its handlers of whole messages alone, so `_receive_frame` is extended.
    """

    handler: GuardedSocket

    async def _receive_frame(self) -> None:
        if not self.handler.take_token():
            # Until the client knows that it is closed, not more is read than before.
            await asyncio.sleep(PAUSE)
        await super()._receive_frame()
