# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The preview of an unfinished drawing, or the reading of a stroke for some seconds."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from physsim_ros.model.arrays import Singles
from physsim_ros.model.preview import NO_PREVIEW
from physsim_ros.model.transform import Point
from physsim_ros.view.frame_batch import Change, FrameBatch
from physsim_ros.view.scenery import LABELS, PREVIEW
import rerun as rr

_LINES, _POINTS, _LABEL = (f'world/preview/{name}' for name in ('lines', 'points', 'label'))
_PEN = (230, 51, 128)
# Duration of the preview of a stroke [s].
LINGER = 3.0
# Distance of the label, which hangs below its point, from the highest point [units].
_ABOVE = 0.7


class PreviewLines:
    """
    Sends previews.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        # The preview in the recording; that of the last frame, and the time at which it began
        # [ns].
        self._sent = self._current = NO_PREVIEW
        self._since = 0
        lines = rr.LineStrips3D.from_fields(radii=rr.Radius.ui_points(1.5), colors=[_PEN])
        points = rr.Points3D.from_fields(radii=rr.Radius.ui_points(3.0), colors=[_PEN])
        recording.log(_LINES, lines, static=True)
        recording.log(_POINTS, points, static=True)
        recording.log(_LABEL, LABELS, static=True)

    def send(self, batch: FrameBatch, change: Change) -> None:
        """Send previews that have changed, or end after `LINGER`."""
        height = PREVIEW * change.unit
        for index, recorded in enumerate(batch.recorded.tolist()):
            preview = batch.frames[index].preview
            if preview != self._current:
                self._current, self._since = preview, recorded
            if not preview.points and recorded - self._since >= LINGER * 1e9:
                preview = NO_PREVIEW
            again = change.resends_all and index == 0 and preview != NO_PREVIEW
            if preview == self._sent and not again:
                continue
            self._sent = preview
            x, y = preview.top
            words = [preview.label] if preview.label else []
            lines = [_raised(line, height) for line in preview.lines]
            top = _raised([(x, y + _ABOVE * change.unit)] * len(words), height)
            clicked = _raised(preview.points, height)
            times = batch.times_at([index])
            for path, columns, count in (
                (_LINES, rr.LineStrips3D.columns(strips=lines), len(lines)),
                (_POINTS, rr.Points3D.columns(positions=clicked), len(clicked)),
                (_LABEL, rr.Points3D.columns(positions=top, labels=words), len(words)),
            ):
                self._recording.send_columns(path, times, columns.partition([count]))


def _raised(points: Sequence[Point], height: float) -> Singles:
    """Return points of the plane at a height, (n, 3) float32 [m]."""
    return np.array([(x, y, height) for x, y in points], dtype=np.float32).reshape(-1, 3)
