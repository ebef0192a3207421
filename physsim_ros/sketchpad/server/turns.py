# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Turns of requests and messages on the server's thread.

Laws: all turns together take at most a share of the thread's time, so that frames reach the pages
in between; the next turn is that of the waiting client whose turns took least time.

Method: fair queueing by virtual time, as in the completely fair scheduler of Linux (Molnár 2007);
a token bucket of CPU time for the share.
"""

from __future__ import annotations

import asyncio
from collections.abc import Hashable
from heapq import nsmallest
import time

from tornado.iostream import StreamClosedError

# Share of the thread's time that turns take in the long run, and time that they take at once [s]:
# a first visit asks for a hundred files, of a millisecond each.
SHARE, BURST = 0.5, 0.25
# CPU time in a pass of the loop after which no turn begins [s]. A pass has many turns, since each
# pass may wait 5 ms for the interpreter's lock.
QUANTUM = 0.004
# Turns that are prepared for a pass, and clients whose times are known: sockets, and addresses.
_MOST_OF_PASS, _MOST_CLIENTS = 32, 1000


class Turns:
    """The turns of one server; its methods are those of the server's thread."""

    def __init__(self) -> None:
        # Virtual time of each client [s], and that of the client whose turn began last.
        self._times: dict[Hashable, float] = {}
        self._last = 0.0
        # Clients that wait, each with its turn, by who asked.
        self._waiting: dict[Hashable, tuple[Hashable, asyncio.Future[None]]] = {}
        # Client whose turn it is, CPU time of the thread when that began [s], and CPU time of the
        # turns before it in this pass [s].
        self._client: Hashable = None
        self._began = self._spent = 0.0
        # CPU time that turns may take now [s], and steady time when it was counted [s].
        self._left, self._counted = BURST, time.monotonic()
        # Whether the next pass with turns is due.
        self._is_due = False

    def begin(self, client: Hashable) -> bool:
        """
        Begin a turn at once, if nobody waits and there is time; return whether it has begun.

        It lasts until its end, the next turn, or the loop's next pass.

        :param client: whose time it takes: an address, or a socket
        """
        if len(self._times) >= _MOST_CLIENTS:
            self._times.clear()
        # Time that a client does not ask for is not saved.
        self._times[client] = max(self._time_of(client), self._last)
        return not self._waiting and self._begin(client)

    async def take(self, asker: Hashable, client: Hashable) -> None:
        """
        Begin a turn, as `begin` does, as soon as it comes.

        :param asker: a connection or socket, which waits for one turn at once
        :raises StreamClosedError: the asker has left
        """
        has_begun = self.begin(client)
        while not has_begun:
            turn = asyncio.get_running_loop().create_future()
            self._waiting[asker] = client, turn
            self._await_pass()
            await turn
            has_begun = self._begin(client)

    def end(self) -> None:
        """End the turn, if there is one, and count its time."""
        now = time.thread_time()
        if self._client is not None:
            took = now - self._began
            self._times[self._client] = self._time_of(self._client) + took
            self._left -= took
            self._spent += took
        self._client, self._began = None, now

    def give_up(self, asker: Hashable) -> None:
        """End the waiting of an asker that has left."""
        if asker in self._waiting:
            _, turn = self._waiting.pop(asker)
            turn.set_exception(StreamClosedError())

    def _time_of(self, client: Hashable) -> float:
        return self._times.get(client, 0.0)

    def _begin(self, client: Hashable) -> bool:
        """Begin a turn, unless the time of this pass is spent; return whether it has begun."""
        self.end()
        if self._spent >= QUANTUM or self._left <= 0.0:
            return False
        self._await_pass()
        self._client, self._last = client, max(self._last, self._time_of(client))
        return True

    def _await_pass(self) -> None:
        """Have the turns of this pass end with it."""
        if not self._is_due:
            self._is_due = True
            asyncio.get_running_loop().call_soon(self._begin_pass)

    def _begin_pass(self) -> None:
        """Have those who wait begin, the client with least time first; later, if time is spent."""
        self.end()
        now = time.monotonic()
        self._left = min(BURST, self._left + SHARE * (now - self._counted))
        self._counted, self._spent = now, 0.0
        if self._left <= 0.0:
            asyncio.get_running_loop().call_later(-self._left / SHARE, self._begin_pass)
            return
        self._is_due = False
        for asker in nsmallest(_MOST_OF_PASS, self._waiting, key=self._time_of_asker):
            _, turn = self._waiting.pop(asker)
            turn.set_result(None)

    def _time_of_asker(self, asker: Hashable) -> float:
        return self._time_of(self._waiting[asker][0])
