# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The legend, in the image of the camera: an arrow for forces of contacts, a bar for those of joints.

Law: it has its place in pixels, and stays where it is when the camera moves.
"""

from __future__ import annotations

import itertools

import numpy as np
from physsim_ros.appearance import full_scale_force, PULL, PUSH, SLATE
from physsim_ros.view.frame_batch import FrameBatch
from physsim_ros.view.scenery import IMAGE_LABELS, PIXELS
import rerun as rr

CONTACT_COLOR = (214, 39, 40)
# Length of the arrow of the force that the legend tells [units], and the greatest one in lengths
# of that: arrows of impacts are cut.
LENGTH, CUT = 1.2, 1.5
_ARROW, _BAR, _WORDS = (f'world/camera/legend/{name}' for name in ('arrow', 'bar', 'labels'))
# Left end of the arrow, and middle of the bar [pixels].
_ARROW_AT, _BAR_AT = (150.0, 14.0), (640.0, 14.0)
# Half the length of the bar [pixels], and its number of colours.
_HALF, _COLORS = 100.0, 11
# Distance of labels from the arrow and the bar [pixels].
_BELOW = 4.0


class Legend:
    """
    Sends the legend: an arrow for forces of contacts, a bar of colours for those of joints.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        recording.log(_WORDS, IMAGE_LABELS, static=True)
        arrow = rr.Arrows2D.from_fields(colors=[CONTACT_COLOR], radii=rr.Radius.ui_points(1.2))
        recording.log(_ARROW, arrow, static=True)
        edges = np.linspace(-_HALF, _HALF, _COLORS + 1) + _BAR_AT[0]
        self._strips = [
            [(left, _BAR_AT[1]), (right, _BAR_AT[1])]
            for left, right in itertools.pairwise(edges.tolist())
        ]
        shares = np.linspace(-1.0, 1.0, _COLORS)[:, None]
        full = np.where(shares < 0.0, PUSH, PULL)
        levels = (1.0 - np.abs(shares)) * np.array(SLATE) + np.abs(shares) * full
        bar = rr.LineStrips2D.from_fields(
            colors=np.rint(levels * 255).astype(np.uint8), radii=rr.Radius.ui_points(3.0)
        )
        recording.log(_BAR, bar, static=True)

    def send(self, batch: FrameBatch, force: float) -> None:
        """
        Send the legend of a scene, at the first frame of a batch.

        :param force: of the arrow; 0 where there was no contact yet [N]
        """
        labels, arrows, strips = [], [], []
        if force:
            x, y = _ARROW_AT
            arrows = [(LENGTH * PIXELS, 0.0)]
            words = f'contact force: this length = {force:g} N (max {CUT * force:g} N)'
            labels.append(((x + LENGTH * PIXELS / 2, y + _BELOW), words))
        if batch.scene.joints:
            x, y = _BAR_AT
            strips, full = self._strips, full_scale_force(batch.scene)
            labels += [
                ((x - _HALF, y + _BELOW), f'joint pushes {full:g} N'),
                ((x + _HALF, y + _BELOW), f'joint pulls {full:g} N'),
            ]
        points = rr.Points2D.columns(
            positions=np.array([at for at, _ in labels]).reshape(-1, 2),
            labels=[text for _, text in labels],
        )
        origins = np.array([_ARROW_AT] * len(arrows)).reshape(-1, 2)
        vectors = np.array(arrows).reshape(-1, 2)
        times = batch.times_at([0])
        for path, columns, count in (
            (_ARROW, rr.Arrows2D.columns(origins=origins, vectors=vectors), len(arrows)),
            (_BAR, rr.LineStrips2D.columns(strips=strips), len(strips)),
            (_WORDS, points, len(labels)),
        ):
            self._recording.send_columns(path, times, columns.partition([count]))
