# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Contacts as arrows: the force on a body, at the point of contact, as long as the force is great.

Of two movable bodies the arrow is that of the later spawned one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.appearance import nice_number
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Contacts
from physsim_ros.view.arrows import arrow_columns, sampling_period
from physsim_ros.view.frame_batch import FrameBatch
import rerun as rr

PATH = 'world/contacts'
COLOR = (214, 39, 40)
# Greatest length of an arrow, in lengths of that of the scale; the legend tells its force.
LONGEST = 3.0
# Bounds of the length of the arrow of one weight [units].
_SHORT, _LONG = 0.15, 1.0
# Standard gravity [m/s²], for the scale in worlds without one.
_GRAVITY = 9.81
# Time in which the impulses of the first frame act [ns]: a period of 60 Hz, the default rate.
_FIRST_PERIOD = 16_666_667
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
    movable = np.flatnonzero(scene.inertia[:, 0] > 0)
    if not len(movable):
        return ForceScale(1.0, unit)
    weight = float(np.median(scene.inertia[movable, 0]))
    weight *= float(np.hypot(*scene.settings.gravity)) or _GRAVITY
    size = float(np.median([scene.bodies[row].shape.form.outer for row in movable]))
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
        self._scale = ForceScale(1.0, 1.0)
        # Whether the last row that was sent has arrows, and the time of the frame before [ns].
        self._shown = False
        self._stamp: int | None = None

    def change_scale(self, scale: ForceScale) -> None:
        """Draw arrows by another scale from now on."""
        self._scale = scale

    def send(self, batch: FrameBatch, *, height: float) -> None:
        """
        Send the contacts of a batch.

        :param height: z of the arrows [m]
        """
        most = max(
            0 if each.contacts is None else len(each.contacts.pairs) for each in batch.frames
        )
        # An empty row after the last contact, then none.
        if not self._shown and not most:
            self._stamp = batch.frames[-1].snapshot.stamp
            return
        chosen = batch.sampled(sampling_period(most))
        arrows = [self._arrows(batch, index) for index in chosen]
        origins, vectors = zip(*arrows, strict=True)
        lengths = [len(each) for each in origins]
        self._shown, self._stamp = lengths[-1] > 0, batch.frames[-1].snapshot.stamp
        self._recording.send_columns(
            PATH,
            batch.times_at(chosen),
            arrow_columns(np.concatenate(origins), np.concatenate(vectors), height, lengths),
        )

    def _arrows(self, batch: FrameBatch, index: int) -> tuple[Floats, Floats]:
        """Return points and vectors of the contacts of a frame, (m, 2) float64 each [m]."""
        frame = batch.frames[index]
        if frame.contacts is None or not len(frame.contacts.pairs):
            return _NONE, _NONE
        before = batch.frames[index - 1].snapshot.stamp if index else self._stamp
        period = 0 if before is None else abs(frame.snapshot.stamp - before)
        forces = contact_forces(frame.contacts, batch.scene) / ((period or _FIRST_PERIOD) * 1e-9)
        scale = self._scale
        vectors = forces * (scale.length / scale.force)
        lengths = np.hypot(vectors[:, 0], vectors[:, 1])[:, None]
        vectors *= np.minimum(1.0, LONGEST * scale.length / np.maximum(lengths, 1e-12))
        return frame.contacts.points, vectors


def contact_forces(contacts: Contacts, scene: Scene) -> Floats:
    """Return the impulses on the movable body of each pair, (m, 2) float64 [N s]."""
    movable = np.append(scene.inertia[:, 0] > 0, False)
    signs = np.where(movable[contacts.pairs[:, 1]], 1.0, -1.0)
    return contacts.impulses * signs[:, None]
