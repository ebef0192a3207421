# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The legend of forces: an arrow for those of contacts, a bar of colours for those of joints."""

from __future__ import annotations

import itertools

import numpy as np
from physsim_ros.appearance import full_scale_force, PULL, PUSH, SLATE
from physsim_ros.view import styles
from physsim_ros.view.arrows import CONTACT_COLOR, ForceScale, LONGEST
from physsim_ros.view.camera import PIXELS
from physsim_ros.view.frame_batch import FrameBatch
import rerun as rr

# In pixels of the image of the camera, so that they stay when the camera moves.
_ARROW, _BAR, _LABELS = (f'world/camera/legend/{name}' for name in ('arrow', 'bar', 'labels'))
# Left end of the arrow, and middle of the bar [pixels].
_ARROW_AT, _BAR_AT = (300.0, 8.0), (680.0, 8.0)
# Half the length of the bar [pixels], and its number of colours.
_HALF, _COLORS = 100.0, 11
# Distance of labels from the arrow and the bar [pixels].
_BELOW = 4.0


class Legend:
    """
    Sends the legend.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        recording.log(_LABELS, styles.IMAGE_LABELS, static=True)
        arrow = rr.Arrows2D.from_fields(colors=[CONTACT_COLOR], radii=rr.Radius.ui_points(1.2))
        recording.log(_ARROW, arrow, static=True)
        edges = np.linspace(-_HALF, _HALF, _COLORS + 1) + _BAR_AT[0]
        strips = [
            [(left, _BAR_AT[1]), (right, _BAR_AT[1])]
            for left, right in itertools.pairwise(edges.tolist())
        ]
        self._strips = strips
        shares = np.linspace(-1.0, 1.0, _COLORS)[:, None]
        full = np.where(shares < 0.0, PUSH, PULL)
        levels = (1.0 - np.abs(shares)) * np.array(SLATE) + np.abs(shares) * full
        bar = rr.LineStrips2D.from_fields(
            colors=np.rint(levels * 255).astype(np.uint8), radii=rr.Radius.ui_points(3.0)
        )
        recording.log(_BAR, bar, static=True)

    def send(self, batch: FrameBatch, forces: ForceScale, unit: float) -> None:
        """
        Send the legend of a scene, at the first frame of a batch.

        :param forces: scale of the arrows of contacts
        :param unit: length of a unit of the view [m]
        """
        times, scene = batch.times_at([0]), batch.scene
        x, y = _ARROW_AT
        long = PIXELS * forces.length / unit
        arrow = rr.Arrows2D.columns(origins=[(x, y)], vectors=[(long, 0.0)])
        self._recording.send_columns(_ARROW, times, arrow)
        words = f'contact {forces.force:g} N, cut at {LONGEST * forces.force:g} N'
        labels = [((x + long / 2, y + _BELOW), words)]
        strips = self._strips if scene.joints else []
        if strips:
            x, y = _BAR_AT
            full = full_scale_force(scene)
            labels += [
                ((x - _HALF, y + _BELOW), f'push {full:g} N'),
                ((x + _HALF, y + _BELOW), f'pull {full:g} N'),
            ]
        bar = rr.LineStrips2D.columns(strips=strips).partition([len(strips)])
        self._recording.send_columns(_BAR, times, bar)
        points = rr.Points2D.columns(
            positions=[at for at, _ in labels], labels=[text for _, text in labels]
        )
        self._recording.send_columns(_LABELS, times, points.partition([len(labels)]))
