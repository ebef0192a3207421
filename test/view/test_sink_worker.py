# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The queue of a viewer: what is new comes first, and no answer is lost."""

from __future__ import annotations

import threading
import weakref

from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.view.sinks.sink import Endpoint
from physsim_ros.view.sinks.sink_worker import SinkWorker

from .viewers import CONTEXT, frame, PATIENCE


class Blocked(Endpoint):
    """An endpoint that takes nothing until it is released."""

    kind, where, capacity = 'blocked', 'here', 10

    def __init__(self):
        self.entered, self.release = threading.Event(), threading.Event()
        self.drawn = []

    def open_sink(self):
        return self

    def draw(self, frames, **_):
        self.entered.set()
        assert self.release.wait(PATIENCE)
        self.drawn += frames

    def flush(self, patience):
        pass

    def close(self):
        pass


def test_a_full_queue_drops_the_oldest_frames_and_keeps_all_answers():
    endpoint, told = Blocked(), []
    worker = SinkWorker(endpoint, ErrorBoundary(), report=told.append)
    worker.put_frame(frame(0, 'answer 0'), context=CONTEXT)
    assert endpoint.entered.wait(PATIENCE)

    for step in range(1, 101):
        worker.put_frame(frame(step, f'answer {step}'), context=CONTEXT)
    endpoint.release.set()
    worker.end()

    assert worker.join()
    assert [each.snapshot.step for each in endpoint.drawn] == [0, *range(91, 101)]
    answers = [answer.message for each in endpoint.drawn for answer in each.answers]
    assert answers == [f'answer {step}' for step in range(101)]
    assert '11 frames, 90 dropped' in worker.state
    assert [each.code for each in told] == ['', 'frames_dropped']


def test_closing_gives_up_on_one_that_never_draws():
    endpoint = Blocked()
    worker = SinkWorker(endpoint, ErrorBoundary(), report=lambda _: None)
    worker.put_frame(frame(0), context=CONTEXT)
    assert endpoint.entered.wait(PATIENCE)

    worker.end()

    assert not worker.join()
    endpoint.release.set()


def test_a_bug_in_drawing_is_told_and_nothing_is_open_any_more():
    class Buggy(Endpoint):
        kind = 'buggy'

        def open_sink(self):
            raise ZeroDivisionError('by zero')

    told, log = [], []
    worker = SinkWorker(Buggy(), ErrorBoundary(log.append), report=told.append)

    assert worker.join()
    assert not worker.is_open
    (answer,) = told
    assert answer.code == 'viewer_lost'
    assert 'failure 1' in answer.message
    assert 'failure 1' in log[0]
    assert 'ZeroDivisionError: by zero' in log[0]


def test_what_waited_for_a_way_that_failed_is_let_go():
    class Failing(Endpoint):
        kind = 'failing'

        def __init__(self):
            self.release = threading.Event()

        def open_sink(self):
            assert self.release.wait(PATIENCE)
            raise ConnectionError('there never can be one')

    endpoint = Failing()
    worker = SinkWorker(endpoint, ErrorBoundary(), report=lambda _: None)
    waiting = frame(0, 'answer')
    kept = weakref.ref(waiting.snapshot)
    worker.put_frame(waiting, context=CONTEXT)
    del waiting

    endpoint.release.set()

    assert worker.join()
    assert kept() is None
    assert 'failed (there never can be one), 0 frames, 1 dropped' in worker.state
