# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The queue of messages that the middleware has delivered and that wait to be decoded.

Laws: messages and calls of services are handled in the order in which they came; what waits is
bounded in memory; a message that takes long is handled in pieces, between which the node does
other things. The middleware itself bounds it by count alone (5,000 of Fast DDS, KEEP_ALL):
arrays of 2 MB that came faster than they were decoded took a gigabyte, which is never freed.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from functools import partial
import math
import time

from physsim_ros.model.errors import Busy
from rclpy.node import Node

# Size from which on messages wait, and others behind them [bytes]; smaller ones are decoded at
# once, in less than 1 ms.
LARGE = 2**14
# Memory that they may take [bytes]: a dozen of the largest messages that are decoded, or 130,000
# small ones behind a large one.
MOST_WAITING = 2**26
# Memory of an entry beside its message [bytes]: a million of 12 bytes took 422 MiB.
_ENTRY = 512
# Time for the pieces of a message at once, while time runs [s].
PIECE = 0.005

# Handles a message, or a piece of it, and returns what is left in pieces; None is nothing.
Work = Callable[[], Iterator[None] | None]


class MessageQueue:
    """
    Messages that wait to be decoded, and calls that wait behind them.

    :param node: whose executor handles one after the other, behind all messages that have arrived

    :ivar piece: time for the pieces of a message at once [s]
    """

    def __init__(self, node: Node) -> None:
        self.piece = math.inf
        self._node = node
        self._waiting: deque[tuple[Work, int]] = deque()
        self._size = 0

    def add_message(self, decode: Callable[[bytes], Iterator[None] | None], data: bytes) -> None:
        """
        Decode a small message, or add a large one, and any behind it.

        :param decode: decodes a message and submits it, or returns the pieces of that
        :raises Busy: too many wait; it is not decoded
        """
        self._check_memory(len(data))
        self._add(partial(decode, data), len(data))

    def add_call(self, call: Callable[[], None]) -> None:
        """
        Make a call behind the messages that wait; at once if no message waits.

        :raises Busy: too many wait; it is not called
        """
        self._check_memory(0)
        self._add(call, 0)

    def add_call_behind_arrived(self, call: Callable[[], None]) -> None:
        """Make a call behind the messages of the middleware and those that wait."""
        if self._node.executor is not None:
            self._node.executor.create_task(self._add, call, 0)

    def _check_memory(self, size: int) -> None:
        """Raise `Busy` if an entry of a size [bytes] does not fit into the memory."""
        if self._waiting and self._size + size + _ENTRY > MOST_WAITING:
            raise Busy(f'{self._size / 2**20:.0f} MiB of messages wait to be decoded')

    def _add(self, work: Work, size: int) -> None:
        executor, rest = self._node.executor, work
        if executor is None or (size < LARGE and not self._waiting):
            left = self._rest_of(work)
            if left is None:
                return
            rest = left
        if not self._waiting and executor is not None:
            executor.create_task(self._handle_next)
        self._waiting.append((rest, size + _ENTRY))
        self._size += size + _ENTRY

    def _handle_next(self) -> None:
        work, size = self._waiting[0]
        rest = self._rest_of(work)
        if rest is None:
            self._waiting.popleft()
            self._size -= size
        else:
            self._waiting[0] = rest, size
        if self._waiting and self._node.executor is not None:
            # Behind the messages that have arrived meanwhile.
            self._node.executor.create_task(self._handle_next)

    def _rest_of(self, work: Work) -> Work | None:
        """Do some work, for as long as a piece may take, and return the rest of it."""
        pieces = work()
        if pieces is not None:
            until = time.perf_counter() + self.piece
            for _ in pieces:
                if time.perf_counter() > until:
                    return lambda: pieces
        return None
