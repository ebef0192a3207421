# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
Contacts as arrows: the force on a body, at the point of contact, as long as the force is great.

Of two movable bodies the arrow is that of the later spawned one.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Contacts
from physsim_ros.view.arrows import arrow_columns, nice_number, sampling_period
from physsim_ros.view.frame_batch import FrameBatch
import rerun as rr

PATH = 'world/contacts'
COLOR = (214, 39, 40)
# Greatest length of an arrow [units].
_LONGEST = 3.0
# Standard gravity [m/s²], for the scale in worlds without one.
_GRAVITY = 9.81
_NONE: Floats = np.empty((0, 2))


def force_scale(scene: Scene) -> float:
    """Return the force whose arrow has a length of one unit: some weight of a body or two [N]."""
    masses = scene.inertia[:, 0]
    masses = masses[masses > 0]
    gravity = float(np.hypot(*scene.settings.gravity)) or _GRAVITY
    return nice_number(float(np.median(masses)) * gravity) if len(masses) else 1.0


class ContactArrows:
    """
    Sends the contacts of frames.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        # Whether the last row that was sent has arrows, and the time of the frame before [ns].
        self._shown = False
        self._stamp: int | None = None

    def send(self, batch: FrameBatch, *, unit: float, height: float) -> None:
        """
        Send the contacts of a batch.

        :param unit: length of a unit of the view [m]
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
        arrows = [self._arrows(batch, index, unit) for index in chosen]
        origins, vectors = zip(*arrows, strict=True)
        lengths = [len(each) for each in origins]
        self._shown, self._stamp = lengths[-1] > 0, batch.frames[-1].snapshot.stamp
        self._recording.send_columns(
            PATH,
            batch.times_at(chosen),
            arrow_columns(np.concatenate(origins), np.concatenate(vectors), height, lengths),
        )

    def _arrows(self, batch: FrameBatch, index: int, unit: float) -> tuple[Floats, Floats]:
        """Return points and vectors of the contacts of a frame, (m, 2) float64 each [m]."""
        frame = batch.frames[index]
        if frame.contacts is None or not len(frame.contacts.pairs):
            return _NONE, _NONE
        before = batch.frames[index - 1].snapshot.stamp if index else self._stamp
        period = 0 if before is None else abs(frame.snapshot.stamp - before)
        forces = contact_forces(frame.contacts, batch.scene) / ((period or 16_666_667) * 1e-9)
        vectors = forces * (unit / force_scale(batch.scene))
        lengths = np.hypot(vectors[:, 0], vectors[:, 1])[:, None]
        vectors *= np.minimum(1.0, _LONGEST * unit / np.maximum(lengths, 1e-12))
        return frame.contacts.points, vectors


def contact_forces(contacts: Contacts, scene: Scene) -> Floats:
    """Return the impulses on the movable body of each pair, (m, 2) float64 [N s]."""
    movable = np.append(scene.inertia[:, 0] > 0, False)
    signs = np.where(movable[contacts.pairs[:, 1]], 1.0, -1.0)
    return contacts.impulses * signs[:, None]
