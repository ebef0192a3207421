# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Forces and velocities: arrows over the bodies.

A contact is an arrow at its point, the force on a body, as long as the force is great. Of two
dynamic bodies that is the force on the later spawned one. A velocity is the displacement in the
next fifth of a second. Of applied forces, the arrow of the greatest one has the length of the
legend's arrow.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np
from physsim_ros.appearance import nice_number
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Contacts
from physsim_ros.model.transform import norms, rotated_each
from physsim_ros.view.frame_batch import Change, FrameBatch, sampling_period
from physsim_ros.view.legend import CONTACT_COLOR, CUT, Legend, LENGTH
from physsim_ros.view.scenery import ARROWS
import rerun as rr

CONTACTS, VELOCITIES, FORCES = 'world/contacts', 'world/velocities', 'world/forces'
_VELOCITY_COLOR, _FORCE_COLOR = (44, 120, 60), (74, 106, 0)
# Duration of contacts of which the median of the greatest forces is shown in full [s], so that an
# impact does not change the scale.
_FITTED = 0.5
# Share of the force of the legend below which that median has a legend of its own.
_SMALL = 0.35
# Time by which a velocity is multiplied, and the shortest period of sending it [s].
_AHEAD, _VELOCITY_PERIOD = 0.2, 1 / 6
_NONE: Floats = np.empty((0, 2))


class ContactArrows:
    """
    Sends the contacts of frames, and the legend of their forces and of those of joints.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._legend = Legend(recording)
        # The force of the legend [N]; 0 before the first contact.
        self._force = 0.0
        # Time [ns] and greatest force [N] of the last frames with contacts, `_FITTED` long.
        self._greatest: deque[tuple[int, float]] = deque()
        _log_style(recording, CONTACTS, CONTACT_COLOR)
        # Whether the last row that was sent has arrows.
        self._shown = False

    def send(self, batch: FrameBatch, change: Change) -> None:
        """Send the contacts of a batch: an empty row after the last contact, then none."""
        most = max(
            0 if each.contacts is None else len(each.contacts.pairs) for each in batch.frames
        )
        chosen = batch.sampled(sampling_period(most)) if self._shown or most else []
        rows = [_contact_forces(batch, index) for index in chosen]
        forces = [each for _, each in rows]
        rescaled = self._fit(batch.recorded[chosen].tolist(), forces)
        if change.resends_scene or rescaled:
            self._legend.send(batch, self._force)
        if not rows:
            return
        origins = [points for points, _ in rows]
        lengths = [len(each) for each in origins]
        self._shown = lengths[-1] > 0
        vectors = np.concatenate(forces) / (self._force or 1.0)
        vectors /= np.maximum(1.0, np.hypot(*vectors.T) / CUT)[:, None]
        vectors *= LENGTH * change.unit
        height = ARROWS * change.unit
        arrows = _arrow_columns(np.concatenate(origins), vectors, height, lengths)
        self._recording.send_columns(CONTACTS, batch.times_at(chosen), arrows)

    def _fit(self, times: list[int], forces: list[Floats]) -> bool:
        """
        Fit the force of the legend to those of most frames; return whether it is new.

        :param times: of frames [ns]
        :param forces: of contacts in each
        """
        for time, each in zip(times, forces, strict=True):
            if len(each):
                self._greatest.append((time, float(np.hypot(*each.T).max())))
                while self._greatest[0][0] <= time - _FITTED * 1e9:
                    self._greatest.popleft()
        most = float(np.median([force for _, force in self._greatest] or [0.0]))
        if most == 0.0 or _SMALL * self._force <= most <= self._force:
            return False
        self._force = nice_number(most)
        return True


def _contact_forces(batch: FrameBatch, index: int) -> tuple[Floats, Floats]:
    """Return points [m] and forces [N] of the contacts of a frame, (m, 2) float64 each."""
    contacts = batch.frames[index].contacts
    if contacts is None or not len(contacts.pairs):
        return _NONE, _NONE
    seconds = batch.elapsed[index] * 1e-9
    return contacts.points, contact_impulses(contacts, batch.scene) / seconds


def contact_impulses(contacts: Contacts, scene: Scene) -> Floats:
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

    def send(self, batch: FrameBatch, change: Change) -> None:
        """Send the velocities of a batch."""
        moving = np.flatnonzero([not body.anchored for body in batch.scene.bodies])
        if not len(moving):
            return
        chosen = batch.sampled(max(_VELOCITY_PERIOD, sampling_period(len(moving))))
        snapshots = [batch.frames[index].snapshot for index in chosen]
        origins = np.concatenate([each.centers[moving] for each in snapshots])
        vectors = _AHEAD * np.concatenate([each.twists[moving, :2] for each in snapshots])
        lengths = [len(moving)] * len(chosen)
        arrows = _arrow_columns(origins, vectors, ARROWS * change.unit, lengths)
        self._recording.send_columns(VELOCITIES, batch.times_at(chosen), arrows)


class AppliedArrows:
    """
    Sends the applied forces of bodies that forces move.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._shown = False
        _log_style(recording, FORCES, _FORCE_COLOR)

    def send(self, batch: FrameBatch, change: Change) -> None:
        """Send the forces of a batch: an empty row after the last one."""
        found = [
            (row, each, body.shape.form.centroid)
            for row, body in enumerate(batch.scene.bodies)
            for each in body.forces
            if body.dynamic
        ]
        chosen = batch.sampled(sampling_period(len(found))) if found or self._shown else []
        if not chosen:
            return
        poses = batch.poses[chosen][:, [row for row, *_ in found]]
        points = [centroid if each.at is None else each.at for _, each, centroid in found]
        forces = np.array([each.force for _, each, _ in found]).reshape(-1, 2)
        turning = np.array([each.axes == 'body' for _, each, _ in found], np.float64)
        origins = poses[..., :2] + rotated_each(np.array(points).reshape(-1, 2), poses[..., 2])
        vectors = rotated_each(forces, poses[..., 2] * turning)
        vectors *= LENGTH * change.unit / max(norms(forces).max(initial=0.0), 1e-9)
        lengths = [len(found)] * len(chosen)
        arrows = _arrow_columns(
            origins.reshape(-1, 2), vectors.reshape(-1, 2), ARROWS * change.unit, lengths
        )
        self._recording.send_columns(FORCES, batch.times_at(chosen), arrows)
        self._shown = bool(found)


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
    spatial = np.zeros((len(vectors), 3), dtype=np.float32)
    spatial[:, :2] = vectors
    return rr.Arrows3D.columns(origins=places, vectors=spatial).partition(lengths)


def _log_style(recording: rr.RecordingStream, path: str, color: tuple[int, int, int]) -> None:
    style = rr.Arrows3D.from_fields(radii=rr.Radius.ui_points(1.2), colors=[color])
    recording.log(path, style, static=True)
