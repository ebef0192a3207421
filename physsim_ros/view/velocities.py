# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Velocities of bodies as arrows: the way of the next fifth of a second."""

from __future__ import annotations

import numpy as np
from physsim_ros.view.arrows import arrow_columns, sampling_period
from physsim_ros.view.frame_batch import FrameBatch
import rerun as rr

PATH = 'world/velocities'
# Time by which a velocity is multiplied [s].
_AHEAD = 0.2
# Shortest period at which they are sent [frames].
_PERIOD = 10
COLOR = (44, 120, 60)


def send_velocities(recording: rr.RecordingStream, batch: FrameBatch, height: float) -> None:
    """
    Send the velocities of movable bodies.

    :param height: z of the arrows [m]
    """
    movable = np.flatnonzero([not body.anchored for body in batch.scene.bodies])
    if not len(movable):
        return
    chosen = batch.sampled(max(_PERIOD, sampling_period(len(movable))))
    snapshots = [batch.frames[index].snapshot for index in chosen]
    origins = np.concatenate([each.centers[movable] for each in snapshots])
    ways = _AHEAD * np.concatenate([each.twists[movable, :2] for each in snapshots])
    recording.send_columns(
        PATH,
        batch.times_at(chosen),
        arrow_columns(origins, ways, height, [len(movable)] * len(chosen)),
    )
