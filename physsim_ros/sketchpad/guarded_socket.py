# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The checks of every web socket: its origin, how many there are, and how often it sends.

Law: a socket that sends faster than a page does is closed.
"""

from __future__ import annotations

from abc import abstractmethod
import time
from typing import TYPE_CHECKING

from physsim_ros.sketchpad.handlers import Guarded
from tornado.websocket import WebSocketHandler

if TYPE_CHECKING:
    from physsim_ros.sketchpad.server import Server

# Messages of a socket: a second's worth in the long run, and at once. A pen and a hand send one
# each frame of the page, at 60 to 144 Hz.
RATE, BURST = 200.0, 400.0
# Codes of closing, RFC 6455, section 7.4.1.
POLICY_VIOLATION, TOO_BIG = 1008, 1009


class GuardedSocket(Guarded, WebSocketHandler):
    """A web socket of a page of this server, with a token bucket for its messages."""

    def initialize(self, server: Server) -> None:
        """Set the server, and fill the bucket."""
        super().initialize(server)
        self._tokens, self._refilled = BURST, time.monotonic()

    @property
    @abstractmethod
    def too_many(self) -> str:
        """Return why one more is refused; '' where there is room for it."""

    @abstractmethod
    def receive(self, message: str | bytes) -> None:
        """Handle a message, which has a token."""

    def check_origin(self, origin: str) -> bool:
        """Accept the pages of this server."""
        return self.server.access.allows_origin(origin, self.request.host)

    async def prepare(self) -> None:
        """Refuse a page without the right to be here, or one too many."""
        await super().prepare()
        # Browsers always send it; tornado asks only where it is there.
        self.require_origin()
        if reason := self.too_many:
            self.refuse(503, reason)

    def on_message(self, message: str | bytes) -> None:
        """Receive a message that has a token."""
        if self._take_token():
            self.receive(message)

    def on_ping(self, data: bytes) -> None:  # noqa: ARG002 - tornado's name
        """Count a ping, which tornado has answered, among the messages; no browser sends any."""
        self._take_token()

    def on_pong(self, data: bytes) -> None:  # noqa: ARG002 - tornado's name
        """Count a pong among the messages; a browser sends one for each ping of the server."""
        self._take_token()

    def _take_token(self) -> bool:
        """
        Take a token of the bucket that limits the rate of messages.

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
