# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A flood does not stop time, and a slow world does not stop the answers."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from itertools import pairwise
from typing import Any

from physsim_ros.ros.programs import real_time_loop
from physsim_ros.ros.programs.real_time_loop import RealTimeLoop
import pytest

MS = 1_000_000


class Machine:
    """A node and its executor, on a clock that passes only where they work."""

    publish_period = 0.02

    def __init__(self, *, tick: int, message: int, answer: int = 0) -> None:
        self.now = 0
        self.message_delay = 0.0
        self.diagnostics = self
        self.ticks: list[int] = []
        self.handled: list[int] = []
        self.waiting: deque[Callable[[], object]] = deque()
        self._cost_of_tick, self._cost_of_message = tick, message
        self._cost_of_answer, self._answered = answer, 0

    def monotonic_ns(self) -> int:
        return self.now

    def tick(self, now: int) -> None:
        self.ticks.append(now)
        self.now += self._cost_of_tick
        self.now += self._cost_of_answer * (len(self.handled) - self._answered)
        self._answered = len(self.handled)

    def create_task(self, call: Callable[[], object]) -> None:
        self.waiting.append(call)

    def send(self, count: int) -> None:
        self.waiting.extend([lambda: self.handled.append(self.now)] * count)

    def spin_once(self, timeout_sec: float) -> None:
        if self.waiting:
            self.now += self._cost_of_message
            self.waiting.popleft()()
        else:
            self.now += max(1, round(timeout_sec * 1e9))

    def run(self, monkeypatch: pytest.MonkeyPatch, until: int) -> None:
        node: Any = self
        monkeypatch.setattr(real_time_loop.time, 'monotonic_ns', self.monotonic_ns)
        RealTimeLoop([node], node, lambda: self.now >= until).run()


def gaps(times: list[int]) -> list[int]:
    return [after - before for before, after in pairwise(times)]


def test_ticks_come_at_their_period(monkeypatch: pytest.MonkeyPatch) -> None:
    machine = Machine(tick=2 * MS, message=MS)
    machine.run(monkeypatch, 1000 * MS)
    assert set(gaps(machine.ticks)) == {20 * MS}


def test_a_flood_does_not_delay_a_tick_by_more_than_a_message(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    machine = Machine(tick=2 * MS, message=MS)
    machine.send(100_000)
    machine.run(monkeypatch, 10_000 * MS)
    assert max(gaps(machine.ticks)) <= 21 * MS
    # Of each period, what the tick leaves.
    assert len(machine.handled) > 0.85 * 10_000
    # The mark of the first tick lies behind all that had arrived.
    assert machine.message_delay > 9.0


def test_a_flood_whose_answers_are_slower_than_its_messages_does_not_lengthen_its_own_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    machine = Machine(tick=2 * MS, message=MS, answer=2 * MS)
    machine.send(100_000)
    machine.run(monkeypatch, 30_000 * MS)
    # 0.1 s for messages, and their answers.
    assert max(gaps(machine.ticks)) <= 310 * MS
    assert len(machine.handled) > 0.3 * 30_000


def test_a_world_too_slow_for_real_time_handles_messages_as_long_as_it_ticks(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    machine = Machine(tick=100 * MS, message=MS)
    machine.send(1000)
    machine.run(monkeypatch, 1200 * MS)
    assert max(gaps(machine.ticks)) <= 202 * MS
    assert len(machine.handled) >= 500


def test_a_slow_world_without_messages_ticks_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    machine = Machine(tick=100 * MS, message=MS)
    machine.run(monkeypatch, 1200 * MS)
    # Besides a tick, one message: the mark.
    assert max(gaps(machine.ticks)) <= 101 * MS
    assert machine.message_delay == pytest.approx(0.001)
