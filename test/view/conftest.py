# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Viewers, servers and recordings that are closed after each test."""

from __future__ import annotations

from pathlib import Path

from physsim_ros.view import Viewer, ViewerMode
import pytest


@pytest.fixture
def server(tmp_path):
    from .viewers import Server  # noqa: PLC0415  Rerun may be missing

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
