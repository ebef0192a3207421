# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The names of the bodies, written at their centroids.

They are hidden at first, and shown by a click on the eye of `names` in the panel of the blueprint.
Rerun (0.41) tells instances of a mesh apart neither where one points nor in a selection.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from physsim_ros.view import columns, styles
from physsim_ros.view.arrows import sampling_period
from physsim_ros.view.frame_batch import FrameBatch
import rerun as rr

PATH = 'world/names'
# Shortest period at which their places are sent [frames]: ten times a second.
_PERIOD = 6


class NameLabels:
    """
    Sends names.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        recording.log(PATH, styles.LABELS, static=True)

    def send_names(self, batch: FrameBatch) -> None:
        """Send the names of a scene, at the first frame of a batch."""
        names = batch.scene.names
        column = rr.Points3D.columns(labels=list(names)).partition([len(names)])
        self._recording.send_columns(PATH, batch.times_at([0]), column)

    def send_places(self, batch: FrameBatch, moved: NDArray[np.bool_], height: float) -> None:
        """
        Send the places of the names, if a body has moved.

        :param moved: (n,) bool: whether each body has
        :param height: z of the names [m]
        """
        count = len(moved)
        if not moved.any():
            return
        chosen = batch.sampled(max(_PERIOD, sampling_period(count)))
        places = np.full((len(chosen), count, 3), height, dtype=np.float32)
        for row, index in enumerate(chosen):
            places[row, :, :2] = batch.frames[index].snapshot.centers
        values = columns.column(columns.POSITIONS, places.reshape(-1, 3), [count] * len(chosen))
        self._recording.send_columns(PATH, batch.times_at(chosen), [values])
