# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Recordings open and close beside one that goes on, and none waits for another for ever."""

from __future__ import annotations

from pathlib import Path
import textwrap

import pytest

from ..outside import ROOT, run_python

# In a process of its own: what waits for ever there keeps the interpreter's lock.
PROGRAM = """
    import sys, threading
    import numpy as np
    from physsim_ros.view.stream import send_blueprint, RerunStream
    import rerun as rr
    import rerun.blueprint as rrb

    closed = threading.Event()
    points = np.zeros((2000, 2), np.float32)

    def go_on():
        stream = RerunStream(rr.FileSink('one.rrd', write_footer=False))
        while not closed.is_set():
            for _ in range(20):
                stream.recording.log('points', rr.Points2D(points))
            send_blueprint(stream.recording, rrb.Blueprint(rrb.Spatial2DView()))
        stream.close()

    thread = threading.Thread(target=go_on)
    thread.start()
    for _ in range(100):
        stream = RerunStream(rr.FileSink('other.rrd', write_footer=False))
        stream.recording.log('points', rr.Points2D(points))
        stream.close()
    closed.set()
    thread.join()
    print('CLOSED')
"""


@pytest.mark.slow
def test_recordings_open_and_close_beside_one_that_goes_on(tmp_path: Path) -> None:
    printed = run_python('-c', textwrap.dedent(PROGRAM), cwd=tmp_path, PYTHONPATH=str(ROOT))
    assert printed.endswith('CLOSED\n')
