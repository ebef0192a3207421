# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The loop of the program: ticks at the publish rate, and messages in between.

Laws: a flood of messages does not stop time, and a world that is too slow for real time does not
stop the answers. A timer of rclpy would wait behind all messages that have arrived before it:
4,000 requests in a burst took a second, in which the world stood still.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
import time

from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.programs.collector import Collector
from physsim_ros.runtime.ending import CLOSING
import rclpy
from rclpy.executors import Executor
from rclpy.experimental import EventsExecutor

# The longest wait for messages before the loop checks whether it is over [s].
_LONGEST_SPIN = 0.1
# Longest time for messages after a late tick [ns], as long as a tick simulates. Answers are a part
# of the next tick: without this bound a flood would lengthen its own time, up to seconds.
_MOST_MESSAGES_NS = 100_000_000


def run_worlds(nodes: Sequence[PhysSimNode], is_over: Callable[[], bool]) -> None:
    """
    Start worlds, run them in real time until it is over, and end them and ROS.

    :param nodes: of the worlds, on one thread
    :param is_over: whether they are to end
    """
    executor = EventsExecutor()
    try:
        for node in nodes:
            executor.add_node(node)
            node.start()
        # EventsExecutor.spin (rclpy 7, Jazzy) never returns; spin_once does, and raises the
        # exceptions of callbacks.
        RealTimeLoop(nodes, executor, is_over, Collector()).run()
    finally:
        # Also after an exception, so that no viewer process remains.
        for node in nodes:
            executor.remove_node(node)
        executor.shutdown()
        for node in nodes:
            node.outputs.viewer.close(CLOSING)
            node.destroy_node()
        rclpy.shutdown()


class RealTimeLoop:
    """
    Alternates between ticks of nodes and the handling of their messages, on one thread.

    :param nodes: whose ticks advance their worlds, all at the rate of the first
    :param executor: that has the nodes
    :param is_over: whether the loop is to end
    :param collector: of the garbage of the process; None leaves it to CPython
    """

    def __init__(
        self,
        nodes: Sequence[PhysSimNode],
        executor: Executor,
        is_over: Callable[[], bool],
        collector: Collector | None = None,
    ) -> None:
        self._collector = collector
        self._nodes = nodes
        self._marks = [_Mark(node, executor) for node in nodes]
        self._executor = executor
        self._is_over = is_over
        self._period = round(nodes[0].publish_period * 1e9)

    def run(self) -> None:
        """Run until it is over."""
        due = time.monotonic_ns()
        while not self._is_over():
            began = time.monotonic_ns()
            for node, mark in zip(self._nodes, self._marks, strict=True):
                node.tick(time.monotonic_ns())
                mark.queue()
            if self._collector is not None:
                self._collector.collect_if_due()
            ended = time.monotonic_ns()
            due += self._period
            if due > ended:
                self._spin_until(due)
            else:
                # As long as the tick took: with a period for messages and 0.1 s for a crowded
                # world, a burst of thousands would wait for half a minute. The next tick carries
                # out what has arrived until then.
                share = min(ended - began, _MOST_MESSAGES_NS)
                self._handle_waiting(ended + max(self._period, share))
                due = time.monotonic_ns()

    def _spin_until(self, due: int) -> None:
        """Handle messages as they come, until a steady time [ns]."""
        while (left := (due - time.monotonic_ns()) * 1e-9) > 0.0 and not self._is_over():
            self._executor.spin_once(timeout_sec=min(left, _LONGEST_SPIN))

    def _handle_waiting(self, latest: int) -> None:
        """Handle the messages that have arrived, at most until a steady time [ns]."""
        while not all(mark.is_reached for mark in self._marks):
            if time.monotonic_ns() >= latest or self._is_over():
                return
            self._executor.spin_once(timeout_sec=0)


class _Mark:
    """
    A call behind the messages of a node that have arrived, to measure how long they wait.

    :param node: that is told their delay
    :param executor: that has the node
    """

    def __init__(self, node: PhysSimNode, executor: Executor) -> None:
        self._node = node
        self._executor = executor
        # Steady time at which it was queued [ns]; None if it is reached.
        self._queued: int | None = None

    @property
    def is_reached(self) -> bool:
        """Whether all messages before it are handled."""
        return self._queued is None

    def queue(self) -> None:
        """Queue it, unless it waits already."""
        now = time.monotonic_ns()
        if self._queued is None:
            self._queued = now
            self._executor.create_task(self._reach)
        else:
            self._node.diagnostics.message_delay = (now - self._queued) * 1e-9

    def _reach(self) -> None:
        if self._queued is not None:
            self._node.diagnostics.message_delay = (time.monotonic_ns() - self._queued) * 1e-9
        self._queued = None
