# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The preview of an unfinished drawing, or the reading of a stroke for some seconds."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from physsim_ros.model.arrays import Singles
from physsim_ros.model.snapshot import NO_PREVIEW
from physsim_ros.model.transform import Point
from physsim_ros.view import styles
from physsim_ros.view.frame_batch import FrameBatch
import rerun as rr

LINES, POINTS, LABEL = (f'world/preview/{name}' for name in ('lines', 'points', 'label'))
# Duration of the preview of a stroke [frames].
LINGER = 180
# Distance of the label, which hangs below its point, from the highest point [units].
_ABOVE = 0.7


class PreviewLines:
    """
    Sends previews.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        # The preview in the recording; that of the last frame, and the frame in which it began.
        self._sent = self._current = NO_PREVIEW
        self._since = 0
        lines = rr.LineStrips3D.from_fields(radii=rr.Radius.ui_points(1.5), colors=[styles.PEN])
        points = rr.Points3D.from_fields(radii=rr.Radius.ui_points(3.0), colors=[styles.PEN])
        recording.log(LINES, lines, static=True)
        recording.log(POINTS, points, static=True)
        recording.log(LABEL, styles.LABELS, static=True)

    def send(self, batch: FrameBatch, *, unit: float, height: float, repeat: int) -> None:
        """
        Send previews that have changed, end after `LINGER` frames, or are due again.

        :param unit: length of a unit of the view [m]
        :param height: z of the lines [m]
        :param repeat: period of sending a preview again [frames]
        """
        for index, number in enumerate(batch.numbers):
            preview = batch.frames[index].preview
            if preview != self._current:
                self._current, self._since = preview, number
            if not preview.points and number - self._since >= LINGER:
                preview = NO_PREVIEW
            if preview == self._sent and (preview == NO_PREVIEW or number % repeat):
                continue
            self._sent = preview
            times = batch.times_at([index])
            lines = [_raised(line, height) for line in preview.lines]
            strips = rr.LineStrips3D.columns(strips=lines).partition([len(lines)])
            self._recording.send_columns(LINES, times, strips)
            points = rr.Points3D.columns(positions=_raised(preview.points, height))
            self._recording.send_columns(POINTS, times, points.partition([len(preview.points)]))
            words = [preview.label] if preview.label else []
            x, y = preview.top
            top = _raised([(x, y + _ABOVE * unit)] * len(words), height)
            label = rr.Points3D.columns(positions=top, labels=words).partition([len(words)])
            self._recording.send_columns(LABEL, times, label)


def _raised(points: Sequence[Point], height: float) -> Singles:
    """Return points of the plane at a height, (n, 3) float32 [m]."""
    return np.array([(x, y, height) for x, y in points], dtype=np.float32).reshape(-1, 3)
