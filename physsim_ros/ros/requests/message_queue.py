# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The queue of messages that the middleware has delivered and that wait to be decoded.

Laws: messages and calls of services are handled in the order in which they came; what waits is
bounded in memory. The middleware itself bounds it by count alone (5,000 of Fast DDS, KEEP_ALL):
arrays of 2 MB that came faster than they were decoded took a gigabyte, which is never freed.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial

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


class MessageQueue:
    """
    Messages that wait to be decoded, and calls that wait behind them.

    :param node: whose executor handles one after the other, behind all messages that have arrived
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._waiting: deque[tuple[Callable[[], None], int]] = deque()
        self._size = 0

    def add_message(self, decode: Callable[[bytes], None], data: bytes) -> None:
        """
        Decode a small message, or add a large one, and any behind it.

        :param decode: decodes a message and submits it
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

    def _add(self, call: Callable[[], None], size: int) -> None:
        executor = self._node.executor
        if executor is None or (size < LARGE and not self._waiting):
            call()
            return
        if not self._waiting:
            executor.create_task(self._handle_next)
        self._waiting.append((call, size + _ENTRY))
        self._size += size + _ENTRY

    def _handle_next(self) -> None:
        call, size = self._waiting.popleft()
        self._size -= size
        if self._waiting and self._node.executor is not None:
            # Behind the messages that have arrived meanwhile.
            self._node.executor.create_task(self._handle_next)
        call()
