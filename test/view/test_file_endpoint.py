# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Whatever happens to a disk, the world is neither slowed nor stopped by it."""

from __future__ import annotations

import os
import sys
import threading

from physsim_ros.view import file_endpoint, ViewerMode

from .viewers import BOX, Events, frame, rows, rows_when, run_alone, show
from ..outside import PATIENCE, until
from ..rerun_program import rerun


def test_a_recording_holds_every_frame_once_it_is_closed(viewers, tmp_path):
    path = tmp_path / 'it.rrd'
    viewer = viewers(record_file=path)

    show(viewer, 1000)
    viewer.close()

    assert rows(path)[BOX] >= 1000
    assert ', ended, 1000 frames, 0 dropped' in viewer.state


def verified(path):
    """Return whether Rerun finds a file complete."""
    return rerun('rrd', 'verify', path).wait(PATIENCE) == 0


def test_a_recording_that_is_closed_is_complete_and_one_that_is_not_can_be_mended(
    viewers, tmp_path
):
    path, copy, mended = (tmp_path / f'{name}.rrd' for name in ('it', 'copy', 'mended'))
    path.touch(mode=0o640)
    viewer = viewers(record_file=path)
    show(viewer, 100)
    until(lambda: ', 100 frames' in viewer.state)
    rows_when(path, BOX, 100)
    # As after a crash; rows of other entities may be missing.
    copy.write_bytes(path.read_bytes())
    viewer.close()

    assert verified(path)
    assert path.stat().st_mode & 0o777 == 0o640
    assert [each.name for each in tmp_path.iterdir() if 'it' in each.name] == ['it.rrd']
    assert not verified(copy)
    assert rerun('rrd', 'optimize', copy, '-o', mended).wait(PATIENCE) == 0
    assert verified(mended)
    assert 100 <= rows(mended)[BOX] <= rows(path)[BOX]


def test_a_link_to_a_recording_stays_a_link(viewers, tmp_path):
    path, link = tmp_path / 'it.rrd', tmp_path / 'link.rrd'
    link.symlink_to(path)
    viewer = viewers(record_file=link)
    show(viewer, 10)
    viewer.close()

    assert link.is_symlink()
    assert verified(path)


def test_a_recording_whose_index_takes_too_long_stays_as_it_is(viewers, tmp_path, monkeypatch):
    never = tmp_path.parent / f'{tmp_path.name}-never'
    never.write_text('#!/bin/sh\n: > "$5"\nexec sleep infinity\n')
    never.chmod(0o755)
    monkeypatch.setattr(file_endpoint, 'rerun_program', lambda: str(never))
    monkeypatch.setattr(file_endpoint.FileEndpoint, 'closing', PATIENCE)
    path = tmp_path / 'it.rrd'
    viewer = viewers(record_file=path)
    show(viewer, 100)
    until(lambda: ', 100 frames' in viewer.state)
    viewer.close(within=1.0)
    until(lambda: ', ended' in viewer.state)

    assert list(tmp_path.iterdir()) == [path]
    assert rows(path)[BOX] >= 100


def test_a_file_that_cannot_be_written_is_told_and_the_rest_goes_on(viewers, server, tmp_path):
    path = tmp_path / 'nowhere' / 'it.rrd'
    server.start()
    viewer = viewers(mode=ViewerMode.CONNECT, url=server.url, record_file=(path))
    events = Events(viewer)

    failure = events.wait_for('record_failed')
    events.wait_for('')
    show(viewer, 50)
    viewer.close()

    assert failure.topic == 'viewer'
    assert str(path) in failure.message
    server.wait_for(BOX, 50)


def test_a_file_that_is_no_regular_one_is_refused_and_blocks_nothing(viewers, tmp_path):
    path = tmp_path / 'fifo.rrd'
    os.mkfifo(path)
    viewer = viewers(record_file=path)

    assert 'not a regular file' in Events(viewer).wait_for('record_failed').message
    until(lambda: not viewer.is_open)


def test_a_recording_is_replaced_and_another_file_is_not(viewers, tmp_path):
    path, counts = tmp_path / 'it.rrd', []
    for _ in range(2):
        viewer = viewers(record_file=path)
        show(viewer, 10)
        viewer.close()
        counts.append(rows(path)[BOX])
    assert counts[0] == counts[1] > 0
    path.write_text('notes of an evening')
    viewer = viewers(record_file=path)

    assert 'no recording' in Events(viewer).wait_for('record_failed').message
    until(lambda: not viewer.is_open)
    assert path.read_text() == 'notes of an evening'


def test_a_share_that_does_not_answer_is_told_and_delays_nothing(viewers, tmp_path, monkeypatch):
    monkeypatch.setattr('physsim_ros.view.endpoint_thread.SILENT_AFTER', 0.1)
    go_on = threading.Event()
    create = file_endpoint._create_regular_file  # noqa: SLF001  it stands for the share

    def late(path):
        assert go_on.wait(PATIENCE)
        return create(path)

    monkeypatch.setattr(file_endpoint, '_create_regular_file', late)
    viewer = viewers(record_file=tmp_path / 'it.rrd')
    events = Events(viewer)

    assert 'no answer' in events.wait_for('record_failed').message
    # The frames that wait are logged, with their contacts.
    assert (viewer.is_open, viewer.reads_contacts) == (False, True)
    show(viewer, 10)
    go_on.set()
    events.wait_for('')
    until(lambda: ', open, 10 frames' in viewer.state)


def test_a_recording_that_was_deleted_is_told_once_and_begun_again(viewers, tmp_path):
    path = tmp_path / 'it.rrd'
    viewer = viewers(record_file=path)
    events = Events(viewer)
    events.wait_for('')
    show(viewer, 10)

    path.unlink()
    assert 'gone' in events.wait_for('record_failed').message
    until(lambda: not viewer.is_open)
    assert 'the file is gone' in viewer.failure
    viewer.show(frame(10, 'before'))
    assert ', the file is gone' in viewer.state
    viewer.open_viewer(ViewerMode.NONE)
    events.wait_for('')
    assert viewer.failure == ''
    viewer.show(frame(20, 'after'))
    viewer.close()

    assert not [each for each in [*events.all, *viewer.poll()] if each.code]
    # With the last frame of before.
    assert rows(path)['/events'] == 2


# A process whose files cannot grow past a limit: a disk that is full, and has space again later.
FULL_DISK = """
    import sys
    from pathlib import Path
    from resource import getrlimit, RLIM_INFINITY, RLIMIT_FSIZE, setrlimit
    from test.outside import until
    from test.view.viewers import bulk, Events, frame
    from physsim_ros.view import endpoint_thread, Viewer, ViewerMode

    endpoint_thread.SILENT_AFTER = 1.0
    setrlimit(RLIMIT_FSIZE, (300_000, RLIM_INFINITY))
    viewer = Viewer()
    viewer.record(Path(sys.argv[1]))
    events = Events(viewer)
    events.wait_for('')
    for step in range(10):
        viewer.show(frame(step, bulk()))
    print(events.wait_for('record_failed').message)
    until(lambda: not viewer.is_open)
    setrlimit(RLIMIT_FSIZE, (RLIM_INFINITY, RLIM_INFINITY))
    viewer.open_viewer(ViewerMode.NONE)
    print(events.wait_for('').message)
    for step in range(10, 20):
        viewer.show(frame(step, bulk()))
    viewer.close()
    print([each.code for each in (*events.all, *viewer.poll())])
"""


def test_a_disk_that_is_full_is_told_once_and_recording_begins_again_beside(tmp_path):
    path = tmp_path / 'it.rrd'

    failed, begun, others = run_alone(FULL_DISK, path).splitlines()

    assert str(path) in failed
    assert begun == f'Rerun record: {tmp_path / "it-2.rrd"}'
    assert others == '[]'
    # The last frame of before, and all since.
    assert rows(tmp_path / 'it-2.rrd')['/events'] == 11


def test_where_there_is_no_rerun_that_is_told_and_nothing_is_open(viewers, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, 'rerun', None)
    viewer = viewers(record_file=(tmp_path / 'it.rrd'))

    assert 'rerun' in Events(viewer).wait_for('record_failed').message
    until(lambda: not viewer.is_open)
    assert 'rerun' in viewer.failure
