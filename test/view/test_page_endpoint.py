# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The recording on a page: it is sent what it has the time to show."""

from __future__ import annotations

from .viewers import Events, rows, show, until


def test_a_page_is_sent_the_next_batch_when_it_shows_the_one_before(viewers):
    viewer, sent = viewers(), []
    page = viewer.open_page(lambda batch, recorded: sent.append((batch, recorded)))
    show(viewer, 10)
    until(lambda: sent)

    # As many as a page of two seconds a frame leaves out.
    show(viewer, 120, first=10)
    until(lambda: ' dropped' in viewer.state and ', 0 dropped' not in viewer.state)
    assert len(sent) == 1
    page.note_shown(sent[0][1] - 1)
    assert Events(viewer).wait_for('frames_dropped').code == 'frames_dropped'
    assert len(sent) == 1
    page.note_shown(sent[0][1])
    until(lambda: len(sent) == 2)

    assert sent[1][1] > sent[0][1]
    viewer.close_page(page)
    until(lambda: not viewer.is_open)


def test_a_page_begins_with_what_is_shown_last(viewers, tmp_path):
    viewer, sent = viewers(), []
    show(viewer, 100)
    page = viewer.open_page(lambda batch, _: sent.append(batch))
    until(lambda: sent)
    viewer.close_page(page)

    path = tmp_path / 'page.rrd'
    path.write_bytes(sent[0])
    assert rows(path)['/plots/energy'] == 1
