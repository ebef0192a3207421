# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Texts at the centroids of bodies: their names, and their labels.

Names are hidden at first; a click on the eye of `names` in the panel of the blueprint shows them.
Rerun (0.41) tells instances of a mesh apart neither where one points nor in a selection.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.scene import Scene
from physsim_ros.view import styles
from physsim_ros.view.arrows import sampling_period
from physsim_ros.view.frame_batch import FrameBatch
import rerun as rr

NAMES_PATH = 'world/names'
LABELS_PATH = 'world/labels'
# Shortest period at which their places are sent [frames]: ten times a second.
_PERIOD = 6


class BodyTexts:
    """
    Sends the texts of bodies.

    :param recording: stream to log to
    :param path: of the entity
    :param texts: of a scene, one for each body; '' is none
    """

    def __init__(
        self, recording: rr.RecordingStream, path: str, texts: Callable[[Scene], Sequence[str]]
    ) -> None:
        self._recording = recording
        self._path = path
        self._texts = texts
        # Rows of the bodies that have a text.
        self._rows: NDArray[np.intp] = np.empty(0, np.intp)
        recording.log(path, styles.LABELS, static=True)

    def send_texts(self, batch: FrameBatch) -> None:
        """Send the texts of a scene, at the first frame of a batch."""
        texts = self._texts(batch.scene)
        before = len(self._rows)
        self._rows = np.flatnonzero([bool(text) for text in texts])
        if not (before or len(self._rows)):
            return
        shown = [text for text in texts if text]
        nowhere = None if shown else np.empty((0, 3), np.float32)
        points = rr.Points3D.columns(labels=shown, positions=nowhere).partition([len(shown)])
        self._recording.send_columns(self._path, batch.times_at([0]), points)

    def send_places(self, batch: FrameBatch, moved: NDArray[np.bool_], height: float) -> None:
        """
        Send the places of the texts, if a body that has one has moved.

        :param moved: (n,) bool: whether each body has
        :param height: z of the texts [m]
        """
        rows, count = self._rows, len(self._rows)
        if not moved[rows].any():
            return
        chosen = batch.sampled(max(_PERIOD, sampling_period(count)))
        places = np.full((len(chosen), count, 3), height, dtype=np.float32)
        for number, index in enumerate(chosen):
            places[number, :, :2] = batch.frames[index].snapshot.centers[rows]
        points = rr.Points3D.columns(positions=places.reshape(-1, 3))
        times = batch.times_at(chosen)
        self._recording.send_columns(self._path, times, points.partition([count] * len(chosen)))
