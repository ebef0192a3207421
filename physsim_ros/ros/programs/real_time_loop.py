# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The loop of the program: ticks at the publish rate, and messages in between.

Laws: a flood of messages does not stop time, and a world that is too slow for real time does not
stop the answers. A timer of rclpy would wait behind all messages that have arrived before it:
4,000 requests in a burst took a second, in which the world stood still.
"""

from __future__ import annotations

from collections.abc import Callable
import time

from physsim_ros.ros.node import PhysSimNode
from rclpy.executors import Executor

# The longest wait for messages before the loop checks whether it is over [s].
_LONGEST_SPIN = 0.1


class RealTimeLoop:
    """
    Alternates between ticks of a node and the handling of its messages, on one thread.

    :param node: whose ticks advance the world
    :param executor: that has the node
    :param is_over: whether the loop is to end
    """

    def __init__(self, node: PhysSimNode, executor: Executor, is_over: Callable[[], bool]) -> None:
        self._node = node
        self._messages = node.requests.queue
        self._executor = executor
        self._is_over = is_over
        self._period = round(node.publish_period * 1e9)
        # Steady time at which the last mark was queued [ns]; None if it is reached.
        self._queued: int | None = None

    def run(self) -> None:
        """Run until it is over."""
        due = time.monotonic_ns()
        while not self._is_over():
            began = time.monotonic_ns()
            self._node.tick(began)
            self._queue_mark()
            ended = time.monotonic_ns()
            due += self._period
            if due > ended:
                self._spin_until(due)
            else:
                # As long as the tick took: with a period for messages and a second for a crowded
                # world, a burst of thousands would wait for minutes. The next tick carries out
                # what has arrived until then.
                self._handle_waiting(ended + max(self._period, ended - began))
                due = time.monotonic_ns()

    def _spin_until(self, due: int) -> None:
        """Handle messages as they come, until a steady time [ns]."""
        while (left := (due - time.monotonic_ns()) * 1e-9) > 0.0 and not self._is_over():
            self._executor.spin_once(timeout_sec=min(left, _LONGEST_SPIN))

    def _handle_waiting(self, latest: int) -> None:
        """Handle the messages that have arrived, at most until a steady time [ns]."""
        while self._queued is not None and time.monotonic_ns() < latest and not self._is_over():
            self._executor.spin_once(timeout_sec=0)

    def _queue_mark(self) -> None:
        """Queue a call behind the messages that have arrived, to measure how long they wait."""
        now = time.monotonic_ns()
        if self._queued is None:
            self._queued = now
            self._messages.add_call_behind_arrived(self._reach_mark)
        else:
            self._node.message_delay = (now - self._queued) * 1e-9

    def _reach_mark(self) -> None:
        if self._queued is not None:
            self._node.message_delay = (time.monotonic_ns() - self._queued) * 1e-9
        self._queued = None
