# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Viewers, servers and recordings that are closed after each test."""

from __future__ import annotations

from pathlib import Path

from physsim_ros.view import Viewer, ViewerMode
import pytest

from ..outside import PATIENCE


@pytest.fixture
def server(tmp_path, monkeypatch):
    from .viewers import Server  # noqa: PLC0415  Rerun may be missing

    # For the last frames, which a busy machine sends late.
    monkeypatch.setattr('physsim_ros.view.endpoints.ClientEndpoint.closing', PATIENCE)
    it = Server(tmp_path / 'server.rrd')
    yield it
    if it.process is not None:
        it.kill()


@pytest.fixture
def viewers():
    """Make viewers that are closed afterwards."""
    made = []

    def make(*, mode=ViewerMode.NONE, url='', record_file=''):
        viewer = Viewer()
        made.append(viewer)
        viewer.open_viewer(mode, url)
        if record_file:
            viewer.record(Path(record_file))
        return viewer

    yield make
    for viewer in made:
        viewer.close()


@pytest.fixture
def recording(tmp_path):
    from .picture_file import Recording  # noqa: PLC0415  the same

    it = Recording(tmp_path / 'picture.rrd')
    yield it
    it.close()
