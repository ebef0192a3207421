# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Arrows over the bodies: forces of contacts, and velocities.

A contact is an arrow at its point, the force on a body, as long as the force is great. Of two
dynamic bodies that is the force on the later spawned one. A velocity is the way of the next fifth
of a second.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import NamedTuple

import numpy as np
from physsim_ros.appearance import nice_number
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Contacts
from physsim_ros.view.frame_batch import FrameBatch
import rerun as rr

CONTACTS, VELOCITIES = 'world/contacts', 'world/velocities'
CONTACT_COLOR, _VELOCITY_COLOR = (214, 39, 40), (44, 120, 60)
# Greatest mean number of arrows in a frame of each kind: of more, fewer frames have arrows.
_BUDGET = 150
# Greatest length of the arrow of a force, in lengths of that of the scale, as the legend says.
LONGEST = 3.0
# Bounds of the length of the arrow of one weight [units].
_SHORT, _LONG = 0.15, 1.0
# Standard gravity [m/s²], for the scale in worlds without one.
_GRAVITY = 9.81
# Least weight at the scale [N]: that of the lightest body there may be, 1e-9 kg. The weight in a
# gravity of next to nothing has no round number near it.
_LEAST_WEIGHT = 1e-8
# Time in which the impulses of the first frame act [ns]: a period of 60 Hz, the default rate.
_FIRST_PERIOD = 16_666_667
# Time by which a velocity is multiplied [s], and the shortest period of sending it [frames].
_AHEAD, _VELOCITY_PERIOD = 0.2, 10
_NONE: Floats = np.empty((0, 2))


class ForceScale(NamedTuple):
    """
    The scale of the arrows of a scene: that of one weight is about as long as a body.

    :ivar force: a round number [N]
    :ivar length: of the arrow of that force [m]
    """

    force: float
    length: float


def force_scale(scene: Scene, unit: float) -> ForceScale:
    """
    Return the scale of the arrows of a scene.

    :param unit: length of a unit of the view [m]
    """
    dynamic = np.flatnonzero(scene.inertia[:, 0] > 0)
    if not len(dynamic):
        return ForceScale(1.0, unit)
    weight = float(np.median(scene.inertia[dynamic, 0]))
    weight *= float(np.hypot(*scene.settings.gravity)) or _GRAVITY
    weight = max(weight, _LEAST_WEIGHT)
    size = float(np.median([scene.bodies[row].shape.form.outer for row in dynamic]))
    length = min(max(2.0 * size, _SHORT * unit), _LONG * unit)
    force = nice_number(weight)
    return ForceScale(force, length * force / weight)


class ContactArrows:
    """
    Sends the contacts of frames.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        _log_style(recording, CONTACTS, CONTACT_COLOR)
        # Whether the last row that was sent has arrows, and the time of the frame before [ns].
        self._shown = False
        self._stamp: int | None = None

    def send(self, batch: FrameBatch, scale: ForceScale, *, height: float) -> None:
        """
        Send the contacts of a batch.

        :param scale: of the arrows
        :param height: z of them [m]
        """
        most = max(
            0 if each.contacts is None else len(each.contacts.pairs) for each in batch.frames
        )
        # An empty row after the last contact, then none.
        if not self._shown and not most:
            self._stamp = batch.frames[-1].snapshot.stamp
            return
        chosen = batch.sampled(sampling_period(most))
        arrows = [self._arrows(batch, index, scale) for index in chosen]
        origins, vectors = zip(*arrows, strict=True)
        lengths = [len(each) for each in origins]
        self._shown, self._stamp = lengths[-1] > 0, batch.frames[-1].snapshot.stamp
        self._recording.send_columns(
            CONTACTS,
            batch.times_at(chosen),
            _arrow_columns(np.concatenate(origins), np.concatenate(vectors), height, lengths),
        )

    def _arrows(self, batch: FrameBatch, index: int, scale: ForceScale) -> tuple[Floats, Floats]:
        """Return points and vectors of the contacts of a frame, (m, 2) float64 each [m]."""
        frame = batch.frames[index]
        if frame.contacts is None or not len(frame.contacts.pairs):
            return _NONE, _NONE
        before = batch.frames[index - 1].snapshot.stamp if index else self._stamp
        period = 0 if before is None else abs(frame.snapshot.stamp - before)
        forces = contact_forces(frame.contacts, batch.scene) / ((period or _FIRST_PERIOD) * 1e-9)
        vectors = forces * (scale.length / scale.force)
        lengths = np.hypot(vectors[:, 0], vectors[:, 1])[:, None]
        vectors *= np.minimum(1.0, LONGEST * scale.length / np.maximum(lengths, 1e-12))
        return frame.contacts.points, vectors


def contact_forces(contacts: Contacts, scene: Scene) -> Floats:
    """Return the impulses on the dynamic body of each pair, (m, 2) float64 [N s]."""
    dynamic = np.append(scene.inertia[:, 0] > 0, False)
    signs = np.where(dynamic[contacts.pairs[:, 1]], 1.0, -1.0)
    return contacts.impulses * signs[:, None]


class VelocityArrows:
    """
    Sends the velocities of bodies that are not anchored.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        _log_style(recording, VELOCITIES, _VELOCITY_COLOR)

    def send(self, batch: FrameBatch, *, height: float) -> None:
        """
        Send the velocities of a batch.

        :param height: z of the arrows [m]
        """
        moving = np.flatnonzero([not body.anchored for body in batch.scene.bodies])
        if not len(moving):
            return
        chosen = batch.sampled(max(_VELOCITY_PERIOD, sampling_period(len(moving))))
        snapshots = [batch.frames[index].snapshot for index in chosen]
        origins = np.concatenate([each.centers[moving] for each in snapshots])
        ways = _AHEAD * np.concatenate([each.twists[moving, :2] for each in snapshots])
        arrows = _arrow_columns(origins, ways, height, [len(moving)] * len(chosen))
        self._recording.send_columns(VELOCITIES, batch.times_at(chosen), arrows)


def sampling_period(count: int) -> int:
    """Return the period at which arrows are sent [frames], by their number in a frame."""
    return max(1, math.ceil(count / _BUDGET))


def _arrow_columns(
    origins: Floats, vectors: Floats, height: float, lengths: Sequence[int]
) -> rr.ComponentColumnList:
    """
    Return arrows in the plane as columns.

    :param origins: (k, 2) float64: of all rows [m]
    :param vectors: (k, 2) float64 [m]
    :param height: z of the arrows [m]
    :param lengths: number of arrows of each row
    """
    places = np.full((len(origins), 3), height, dtype=np.float32)
    places[:, :2] = origins
    ways = np.zeros((len(vectors), 3), dtype=np.float32)
    ways[:, :2] = vectors
    return rr.Arrows3D.columns(origins=places, vectors=ways).partition(lengths)


def _log_style(recording: rr.RecordingStream, path: str, color: tuple[int, int, int]) -> None:
    style = rr.Arrows3D.from_fields(radii=rr.Radius.ui_points(1.2), colors=[color])
    recording.log(path, style, static=True)
