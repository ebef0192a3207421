# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Answers wait where listeners have not kept up, so that no burst pushes one out."""

from __future__ import annotations

from typing import Any

from physsim_ros.model.answer import Answer
from physsim_ros.ros.publishers import event_publisher
from physsim_ros.ros.publishers.event_publisher import (
    ACK_TIMEOUT,
    EVENTS_DEPTH,
    MOST_WAITING,
    STOPPED_ANSWERS,
    STOPPED_PERIOD,
)
from physsim_ros.ros.publishers.publishers import Publishers
from physsim_ros.testing import PhysSim
import pytest


class Slow:
    """A publisher whose listener takes what it was sent when the test says so."""

    def __init__(self) -> None:
        self.sent: list[bytes] = []
        self.taken = True
        self.asked = 0

    def get_subscription_count(self) -> int:
        return 1

    def publish(self, message: bytes) -> None:
        self.sent.append(message)

    def wait_for_all_acked(self, _: Any) -> bool:
        self.asked += 1
        return self.taken


class Bench:
    """The streams of a world, their listener, and the time on the wall."""

    def __init__(self, streams: Publishers) -> None:
        self.streams = streams
        self.slow = Slow()
        self.now = 1000.0
        streams.events._publisher = self.slow  # noqa: SLF001 - a listener is not slow on command

    def report(self, count: int) -> None:
        for number in range(count):
            self.streams.events.publish(Answer(topic='~/spawn', subject=f'a/{number}'))


@pytest.fixture
def bench(physsim: PhysSim, monkeypatch: pytest.MonkeyPatch) -> Bench:
    bench = Bench(physsim.node.outputs.publishers)
    monkeypatch.setattr(event_publisher.time, 'monotonic', lambda: bench.now)
    return bench


def test_answers_go_out_at_once_while_listeners_keep_up(bench: Bench) -> None:
    bench.report(3 * EVENTS_DEPTH)
    assert len(bench.slow.sent) == 3 * EVENTS_DEPTH


def test_a_burst_waits_for_a_listener_that_has_not_taken_the_last(bench: Bench) -> None:
    bench.slow.taken = False
    bench.report(2 * EVENTS_DEPTH + 7)
    assert len(bench.slow.sent) == EVENTS_DEPTH
    # Asking costs a fifth of a millisecond: once a tick, not once an answer.
    assert bench.slow.asked == 1
    bench.streams.events.flush()
    assert len(bench.slow.sent) == EVENTS_DEPTH
    bench.slow.taken = True
    bench.streams.events.flush()
    assert len(bench.slow.sent) == 2 * EVENTS_DEPTH + 7
    names = [f'a/{number}'.encode() for number in range(2 * EVENTS_DEPTH + 7)]
    assert all(name in message for name, message in zip(names, bench.slow.sent, strict=True))


def test_a_listener_that_has_stopped_holds_nobody_up(bench: Bench) -> None:
    bench.slow.taken = False
    bench.report(3 * EVENTS_DEPTH)
    bench.now += ACK_TIMEOUT - 0.1
    bench.streams.events.flush()
    assert len(bench.slow.sent) == EVENTS_DEPTH
    assert not bench.streams.events.stopped
    bench.now += 0.2
    bench.streams.events.flush()
    assert len(bench.slow.sent) == EVENTS_DEPTH + STOPPED_ANSWERS
    assert bench.streams.events.stopped
    # Some ten thousand answers a second, which a listener that reads can ask for again.
    for _ in range(2):
        bench.now += STOPPED_PERIOD + 0.001
        bench.streams.events.flush()
    assert len(bench.slow.sent) == EVENTS_DEPTH + 3 * STOPPED_ANSWERS


def test_a_listener_has_stopped_until_it_takes_all(bench: Bench) -> None:
    bench.slow.taken = False
    bench.report(EVENTS_DEPTH + 1)
    bench.now += ACK_TIMEOUT + 0.1
    bench.streams.events.flush()
    assert bench.streams.events.stopped
    bench.slow.taken = True
    bench.streams.events.flush()
    assert not bench.streams.events.stopped
    bench.slow.taken = False
    bench.report(2 * EVENTS_DEPTH)
    assert bench.streams.events.waiting == EVENTS_DEPTH


def test_a_listener_that_too_many_answers_wait_for_has_stopped(bench: Bench) -> None:
    bench.slow.taken = False
    bench.report(EVENTS_DEPTH + MOST_WAITING)
    bench.streams.events.flush()
    assert not bench.streams.events.stopped
    bench.report(1)
    bench.streams.events.flush()
    assert bench.streams.events.stopped
    assert len(bench.slow.sent) == EVENTS_DEPTH + STOPPED_ANSWERS


def test_an_answer_goes_out_before_the_frame_that_shows_it(bench: Bench, physsim: PhysSim) -> None:
    bench.slow.taken = False
    bench.report(EVENTS_DEPTH + 1)
    bench.slow.taken = True
    physsim.node.loop.advance_frame()
    assert len(bench.slow.sent) == EVENTS_DEPTH + 1
