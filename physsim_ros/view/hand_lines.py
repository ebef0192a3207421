# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Hands: a line from each grip on a body to its hand, with the name of the hand."""

from __future__ import annotations

import numpy as np
from physsim_ros.view import styles
from physsim_ros.view.frame_batch import FrameBatch
from physsim_ros.view.line_strips import strip_column
import rerun as rr

LINES, HANDS = 'world/hands/lines', 'world/hands'


class HandLines:
    """
    Sends the hands of frames.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._shown = False
        lines = rr.LineStrips3D.from_fields(radii=rr.Radius.ui_points(1.5), colors=[styles.PEN])
        hands = rr.Points3D.from_fields(
            radii=rr.Radius.ui_points(5.0), colors=[styles.PEN], point_shading='flat'
        )
        recording.log(LINES, lines, static=True)
        recording.log(HANDS, hands, static=True)

    def send(self, batch: FrameBatch, height: float) -> None:
        """
        Send the hands of a batch: an empty row after the last hand, then none.

        :param height: z of the lines [m]
        """
        ends = [each.snapshot.grip_lines for each in batch.frames]
        lengths = [len(each) for each in ends]
        if not self._shown and not any(lengths):
            return
        self._shown = lengths[-1] > 0
        corners = np.full((sum(lengths), 2, 3), height, dtype=np.float32)
        corners[..., :2] = np.concatenate(ends)
        names = [grip.hand for each in batch.frames for grip in each.snapshot.grips]
        lines = strip_column(corners.reshape(-1, 3), 2, lengths)
        self._recording.send_columns(LINES, batch.times, [lines])
        hands = rr.Points3D.columns(positions=corners[:, 1], labels=names).partition(lengths)
        self._recording.send_columns(HANDS, batch.times, hands)
