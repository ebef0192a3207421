# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pictures of recordings, by a viewer of Rerun's without a screen."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import io
from pathlib import Path
import time

import numpy as np
from PIL import Image
from rerun.experimental import ViewerClient

from .rerun_program import free_port, is_open, rerun

# Seconds for a viewer to start, and to show a recording, on a machine that is busy.
PATIENCE = 60.0
TIMELINE = 'recorded'


def has_vulkan() -> bool:
    """Tell whether there is a driver to draw with."""
    return any(Path('/usr/share/vulkan/icd.d').glob('*.json'))


@contextmanager
def headless_viewer(width: int, height: int) -> Iterator[HeadlessViewer]:
    """Start a viewer with a window of a size [pixels], and end it."""
    port = free_port()
    process = rerun(
        '--headless', f'--port={port}', f'--window-size={width}x{height}', '--hide-welcome-screen'
    )
    deadline = time.monotonic() + PATIENCE
    try:
        while not is_open(port):
            assert time.monotonic() < deadline, 'the viewer did not start'
            assert process.poll() is None, 'the viewer ended'
        yield HeadlessViewer(ViewerClient.connect(f'rerun+http://127.0.0.1:{port}/proxy'))
    finally:
        process.kill()
        process.wait()


class HeadlessViewer:
    """A viewer and its recording."""

    def __init__(self, client: ViewerClient) -> None:
        self.client = client

    def open_recording(self, path: Path) -> None:
        """Show a recording in place of the last one."""
        if self.client.get_state().recordings:
            self.client.close('all')
        self.client.open(str(path))

    def picture(self, recorded: int, *, view: str = 'World') -> Image.Image:
        """
        Return a view at a time, when it is complete.

        :param recorded: on the timeline of the picture [ns]
        :param view: its name; '' is the whole window
        """
        self.client.set_time(TIMELINE, duration=recorded * 1e-9, play_state='paused')
        deadline, before = time.monotonic() + PATIENCE, None
        while True:
            ids = {each.name: each.view_id for each in self.client.get_state().views}
            if not view or view in ids:
                png = self.client.take_screenshot(ids[view] if view else None)
                picture = Image.open(io.BytesIO(png)).convert('RGB')
                # A viewer draws what it has read so far; two alike are all of it.
                if before is not None and np.array_equal(before, picture):
                    return picture
                before = picture
            assert time.monotonic() < deadline, 'the picture did not come to rest'

    def errors(self) -> list[tuple[str, str]]:
        """Return the errors of views: the view and what it says."""
        return [
            (view.name, report.summary)
            for view in self.client.get_state().views
            for report in view.reports
            if report.severity.lower() == 'error'
        ]
