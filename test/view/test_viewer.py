# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Viewers are changed while the world runs; none leaves anything behind."""

from __future__ import annotations

import subprocess
import sys

from physsim_ros.view import endpoints, ViewerMode

from .viewers import frame, rows, run_alone
from ..outside import until


def test_what_is_recorded_goes_on_when_the_viewer_changes(viewers, server, tmp_path):
    server.start()
    path = tmp_path / 'it.rrd'
    viewer = viewers(record_file=str(path))
    viewer.show(frame(0, 'first'))
    viewer.open_viewer(ViewerMode.CONNECT, server.url)
    viewer.show(frame(4, 'second'))
    # The one before is in the new viewer too: the world may stand still.
    server.wait_for('/events', 2)
    viewer.open_viewer(ViewerMode.NONE)
    viewer.show(frame(8, 'third'))

    def is_left():
        viewer.poll()
        return 'connect' not in viewer.state

    until(is_left)
    viewer.close()

    assert rows(path)['/events'] == 3


def test_of_a_flood_of_changes_the_last_counts_and_few_are_carried_out(viewers, monkeypatch):
    started = []
    start = endpoints.start_child

    def count(*arguments, **options):
        started.append(start(*arguments, **options))
        return started[-1]

    monkeypatch.setattr(endpoints, 'start_child', count)
    viewer = viewers()
    for _ in range(100):
        viewer.open_viewer(ViewerMode.WEB)
        viewer.open_viewer(ViewerMode.NONE)
    viewer.open_viewer(ViewerMode.WEB)

    def one_runs():
        viewer.poll()
        running = [program for program in started if program.poll() is None]
        return viewer.state.startswith('web: http') and len(running) == 1

    until(one_runs)
    assert len(started) <= 2


# A process that looks what viewers leave behind.
MANY_VIEWERS = """
    import psutil, threading
    from test.outside import until
    from test.view.viewers import Events, show
    from physsim_ros.view import Viewer, ViewerMode

    process = psutil.Process()
    viewer = Viewer()
    events = Events(viewer)

    def open_and_close():
        viewer.open_viewer(ViewerMode.WEB)
        events.wait_for('')
        show(viewer, 50)
        until(lambda: 'open, 5' in viewer.state)
        viewer.open_viewer(ViewerMode.NONE)
        until(lambda: not any('viewer' in each.name for each in threading.enumerate()))

    def held():
        return process.num_threads(), process.num_fds(), len(process.net_connections())

    open_and_close()
    open_and_close()
    print(most := held())
    for _ in range(4):
        open_and_close()
    # Viewers that close are waited for: the threads of Rerun end some time after their server.
    until(lambda: all(now <= before for now, before in zip(held(), most)))
    print('no more')
"""


def test_many_viewers_leave_no_threads_descriptors_or_ports():
    assert run_alone(MANY_VIEWERS).splitlines()[-1] == 'no more'


def test_importing_the_viewer_does_not_import_rerun():
    check = 'import sys, physsim_ros.view; sys.exit("rerun" in sys.modules)'

    assert subprocess.run([sys.executable, '-c', check], check=False).returncode == 0
