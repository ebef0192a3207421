# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The executor of a test: it spins until all messages have arrived."""

from __future__ import annotations

from collections.abc import Callable
import time

from rclpy.context import Context
from rclpy.experimental import EventsExecutor
from rclpy.node import Node

# Timeout for events that take milliseconds in this process, in wall time [s]: a busy machine may
# stop it for seconds.
TIMEOUT = 60.0
# The greatest number of rounds of messages in reaction to messages: two nodes that answer each
# other never end.
_MOST_ROUNDS = 100


class SettlingExecutor:
    """
    An events executor that spins until messages have arrived.

    :param context: of the nodes

    :ivar errors: to be raised where nodes spin, from whatever thread they are
    """

    def __init__(self, context: Context) -> None:
        self.errors: list[BaseException] = []
        self._executor = EventsExecutor(context=context)
        self._nodes: list[Node] = []

    def add_node(self, node: Node) -> None:
        """Spin a node from now on."""
        self._nodes.append(node)
        self._executor.add_node(node)

    def shutdown(self) -> None:
        """Remove all nodes, and shut the executor down."""
        for node in self._nodes:
            self._executor.remove_node(node)
        self._executor.shutdown()

    def settle(self) -> None:
        """
        Spin until all messages have arrived, those in reaction to them too.

        :raises TimeoutError: nodes keep answering each other
        """
        for _ in range(_MOST_ROUNDS):
            spins = self._spin_to_barrier()
            self.raise_error()
            if spins <= 1:
                return
        raise TimeoutError('nodes keep answering each other while time is paused')

    def spin_until(
        self, predicate: Callable[[], object], otherwise: str, timeout: float = TIMEOUT
    ) -> None:
        """
        Spin until a predicate is true.

        :param otherwise: message of the error
        :param timeout: wall time [s]
        :raises TimeoutError: it is not true in time
        """
        __tracebackhide__ = True
        deadline = time.monotonic() + timeout
        while not predicate():
            if time.monotonic() > deadline:
                raise TimeoutError(otherwise)
            self._executor.spin_once(timeout_sec=0.01)
            self.raise_error()

    def raise_error(self) -> None:
        """Raise the first of the errors that no call has raised."""
        if self.errors:
            raise self.errors.pop(0)

    def _spin_to_barrier(self) -> int:
        """Spin until all events queued now are handled, and return the number of spins."""
        reached: list[bool] = []
        self._executor.create_task(lambda: reached.append(True))
        spins = 0
        while not reached:
            self._executor.spin_once(timeout_sec=0)
            spins += 1
        return spins
