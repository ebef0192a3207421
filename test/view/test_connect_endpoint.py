# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Viewers elsewhere: they may come late, go, freeze and thaw; the world goes on."""

from __future__ import annotations

import os
import signal

from physsim_ros.view import ViewerMode

from .viewers import BOX, bulk, Events, frame, rows, run_alone, show
from ..outside import until
from ..rerun_program import free_port


def test_nobody_at_the_other_end_holds_nothing_up_and_is_said(viewers):
    viewer = viewers(mode=ViewerMode.CONNECT, url=f'rerun+http://127.0.0.1:{free_port()}/proxy')

    until(lambda: 'nobody there' in viewer.state)
    show(viewer, 1000)
    viewer.close()


def test_an_address_that_is_none_is_told(viewers):
    viewer = viewers(mode=ViewerMode.CONNECT, url='http://nonsense')

    assert 'http://nonsense' in Events(viewer).wait_for('viewer_lost').message


def test_a_server_that_comes_late_is_found_and_gets_every_answer(viewers, server):
    viewer = viewers(mode=ViewerMode.CONNECT, url=server.url)
    until(lambda: 'nobody there' in viewer.state)
    for step in range(200):
        viewer.show(frame(step, f'answer {step}'))

    server.start()
    Events(viewer).wait_for('')
    until(lambda: ' 200 frames, 0 dropped' in viewer.state)
    viewer.close()

    written = server.wait_for('/events', 200)
    assert written[BOX] >= 200


def test_a_server_that_goes_and_comes_again_is_found_again(viewers, server):
    server.start()
    viewer = viewers(mode=ViewerMode.CONNECT, url=server.url)
    events = Events(viewer)
    events.wait_for('')
    show(viewer, 10)

    server.kill()
    events.wait_for('viewer_lost')
    server.start()
    events.wait_for('')
    show(viewer, 10, first=10)
    viewer.close()

    # With the geometry, as nothing of before has been kept.
    assert server.wait_for(BOX, 10)['/world/camera'] == 1


# The whole life of a process whose viewer freezes: a frozen one would keep this one from ending.
FROZEN = """
    import os, signal, sys, threading
    from pathlib import Path
    from test.outside import until
    from test.view.viewers import bulk, Events, frame
    from physsim_ros.view import endpoint_thread, Viewer, ViewerMode

    endpoint_thread.SILENT_AFTER = 1.0
    url, path, server = sys.argv[1], sys.argv[2], int(sys.argv[3])
    viewer = Viewer()
    viewer.record(Path(path))
    viewer.open_viewer(ViewerMode.CONNECT, url)
    events = Events(viewer)
    until(lambda: viewer.state.count(', open,') == 2)
    os.kill(server, signal.SIGSTOP)
    step = 0
    while 'no answer' not in viewer.state:
        viewer.show(frame(step, bulk()))
        events.all += viewer.poll()
        step += 1
        threading.Event().wait(0.01)
    events.wait_for('viewer_lost')
    viewer.close()
    print(step)
"""


def test_a_frozen_viewer_holds_up_neither_frames_nor_closing_nor_the_end(server, tmp_path):
    server.start()
    path = tmp_path / 'it.rrd'
    arguments = [server.url, str(path), str(server.process.pid)]

    done = run_alone(FROZEN, *arguments)

    # It came to its end, and the file is whole all the same.
    assert rows(path)['/events'] == int(done)


def test_a_viewer_that_thaws_is_shown_what_is_new(viewers, server, monkeypatch):
    monkeypatch.setattr('physsim_ros.view.endpoint_thread.SILENT_AFTER', 1.0)
    server.start()
    viewer = viewers(mode=ViewerMode.CONNECT, url=server.url)
    until(lambda: ', open,' in viewer.state)

    os.kill(server.process.pid, signal.SIGSTOP)
    steps = iter(range(10_000))

    def is_stuck():
        viewer.show(frame(next(steps), bulk()))
        viewer.poll()
        return 'no answer' in viewer.state

    until(is_stuck)
    os.kill(server.process.pid, signal.SIGCONT)
    until(lambda: ', open,' in viewer.state)
    viewer.show(frame(20_000))
    viewer.close()

    server.wait_for('/events', next(steps))
