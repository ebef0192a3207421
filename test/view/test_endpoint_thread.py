# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The queue of an endpoint: what is new comes first, and no answer is lost."""

from __future__ import annotations

import sys
import threading
import weakref

from physsim_ros.model.sizes import frame_size
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.view import endpoint_thread
from physsim_ros.view.endpoint_thread import EndpointThread
from physsim_ros.view.endpoints import Endpoint
from physsim_ros.view.file_endpoint import FileEndpoint

from .viewers import BOX, frame, rows
from ..outside import PATIENCE, until


class Blocked(FileEndpoint):
    """A file that takes nothing more after the first frame, until it is released."""

    period, closing = 0.01, PATIENCE

    def __init__(self, path):
        super().__init__(path, overwrite=True)
        self.entered, self.release = threading.Event(), threading.Event()

    def check(self):
        self.entered.set()
        assert self.release.wait(PATIENCE)


def test_a_full_queue_drops_the_oldest_frames_and_keeps_all_answers(tmp_path, monkeypatch):
    path, told = tmp_path / 'it.rrd', []
    one = frame(0)
    size = frame_size(one.snapshot, one.contacts)
    monkeypatch.setattr(endpoint_thread, 'WAITING_BYTES', 10.5 * size)
    endpoint = Blocked(path)
    output = EndpointThread(endpoint, ErrorBoundary(), told.append)
    output.put(frame(0, 'answer 0'))
    until(lambda: ' 1 frames' in output.state)
    assert endpoint.entered.wait(PATIENCE)

    for step in range(1, 101):
        output.put(frame(step, f'answer {step}'))
    output.poll()
    endpoint.release.set()

    assert output.join()
    assert '11 frames, 90 dropped' in output.state
    assert [each.code for each in told] == ['', 'frames_dropped']
    counts = rows(path)
    assert counts['/events'] == 101
    assert counts[BOX] >= 11


def test_where_rerun_is_missing_it_is_told_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, 'rerun', None)
    told = []
    endpoint = FileEndpoint(tmp_path / 'it.rrd', overwrite=True)
    output = EndpointThread(endpoint, ErrorBoundary(), told.append)

    reason = 'rerun is not installed: install physsim_ros with its extra [viewer]'
    assert output.wait_until_tried() == reason
    assert output.join()
    assert [(each.code, reason in each.message) for each in told] == [('record_failed', True)]
    assert list(tmp_path.iterdir()) == []


def test_closing_gives_up_on_one_that_takes_nothing(tmp_path):
    endpoint = Blocked(tmp_path / 'it.rrd')
    output = EndpointThread(endpoint, ErrorBoundary(), lambda _: None)
    assert endpoint.entered.wait(PATIENCE)
    endpoint.closing = 0.0

    assert not output.join()
    endpoint.release.set()


def test_a_bug_is_told_and_nothing_is_open_any_more():
    class Buggy(Endpoint):
        kind = 'buggy'

        def open_stream(self):
            raise ZeroDivisionError('by zero')

    told, log = [], []
    output = EndpointThread(Buggy(), ErrorBoundary(log.append), told.append)

    until(lambda: output.has_ended)
    assert not output.is_open
    (answer,) = told
    assert answer.code == 'viewer_lost'
    assert 'failure 1' in answer.message
    assert 'failure 1' in log[0]
    assert 'ZeroDivisionError: by zero' in log[0]


def test_what_waited_for_a_receiver_that_failed_is_let_go():
    class Failing(Endpoint):
        kind, reopens = 'failing', False

        def __init__(self):
            self.release = threading.Event()

        def open_stream(self):
            assert self.release.wait(PATIENCE)
            raise ConnectionError('there never can be one')

    endpoint = Failing()
    output = EndpointThread(endpoint, ErrorBoundary(), lambda _: None)
    waiting = frame(0, 'answer')
    kept = weakref.ref(waiting.snapshot)
    output.put(waiting)
    del waiting

    endpoint.release.set()

    assert output.join()
    assert kept() is None
    assert 'there never can be one, 0 frames, 1 dropped' in output.state
    assert output.failure == 'failing: there never can be one'
