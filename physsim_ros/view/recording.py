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
The recording of frames: the entities of the world, the plots and the log, as columns in Rerun.

Law: components that change only with the scene are sent when it changes, and every `REPEAT`
frames; positions are sent for many frames at once, in one entity for each kind of geometry.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats, Singles
from physsim_ros.model.preview import NO_PREVIEW
from physsim_ros.model.settings import Bounds
from physsim_ros.model.snapshot import Answer, Frame, Snapshot
from physsim_ros.model.transform import Point
from physsim_ros.view.blueprint import blueprint
from physsim_ros.view.body_geometry import (
    BodyGeometry,
    DEPTH,
    PLACES,
    RECTANGLES,
    sent_colors,
    Table,
    THICK,
    Tracks,
    TRANSLUCENT,
    TRIANGLES,
)
from physsim_ros.view.camera import Camera, pinhole
from physsim_ros.view.joint_geometry import JointGeometry
from physsim_ros.view.joint_geometry import PATH as JOINTS
from physsim_ros.view.run_state_track import RunStateTrack
import rerun as rr

Times = list[rr.TimeColumn]
# A component: its descriptor, and the batch class of its values.
Slot = tuple[rr.ComponentDescriptor, Callable[[Any], Any]]

# Period of sending geometry again [frames]: a server at its memory limit drops old rows.
REPEAT = 300
# Half the thickness of the walls [units].
WALL_HALF = 0.1
# Duration of the preview of a stroke [frames].
LINGER = 180
# Period of the plots of energies [frames].
SAMPLE = 6
WALL = (0.35, 0.37, 0.4, 1.0)
CONTACT = (214, 39, 40)
PREVIEW = (230, 51, 128)
FACTOR = (84, 162, 75)
ENERGIES = {'kinetic': (245, 133, 24), 'potential': (76, 120, 168), 'total': (150, 150, 150)}

_NO_POINTS: Floats = np.empty((0, 2))


class FrameRecorder:
    """
    Logs frames to a recording stream.

    :param recording: stream to log to, a new one: blueprint and styles are sent at once
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        # Number of frames so far: the timeline `frame`, which never goes back.
        self._count = 0
        self._due = 0
        self._last: Frame | None = None
        self._bodies: BodyGeometry | None = None
        self._joints: JointGeometry | None = None
        self._camera = Camera()
        self._touching = False
        # Hands in the last frame.
        self._hands = 0
        # The preview in the recording; that of the last frame, and the frame in which it began.
        self._preview = self._current = NO_PREVIEW
        self._current_since = 0
        # Entities with geometry, and the poses of the bodies that were sent last.
        self._filled: set[str] = set()
        self._poses: Floats = np.empty((0, 3))
        self._run_states = RunStateTrack(recording)
        recording.send_blueprint(blueprint())
        self._send_styles()

    def draw(self, frames: Sequence[Frame], *, real_time_factor: float) -> None:
        """
        Log frames, except those that are equal to the one before.

        :param frames: in order; their arrays are not changed any more
        :param real_time_factor: simulation seconds a second, at the last of them
        """
        fresh = []
        for frame in frames:
            if self._is_new(frame):
                fresh.append(frame)
                self._last = frame
        for _, run in groupby(fresh, key=lambda frame: id(frame.snapshot.scene)):
            self._draw_run(list(run))
        if fresh:
            factor = rr.Scalars.columns(scalars=[real_time_factor])
            times = _times([fresh[-1].snapshot], [self._count - 1])
            self._recording.send_columns('real_time_factor', times, factor)

    def _is_new(self, frame: Frame) -> bool:
        if self._last is None or frame.moved or frame.answers or frame.speed != self._last.speed:
            return True
        before, now = self._last.snapshot, frame.snapshot
        if frame.preview != self._last.preview:
            return True
        if now.grips != before.grips:
            return True
        return now.scene is not before.scene or not np.array_equal(now.poses, before.poses)

    def _draw_run(self, frames: Sequence[Frame]) -> None:
        """Log frames of one scene."""
        snapshots = [frame.snapshot for frame in frames]
        scene = snapshots[0].scene
        poses = np.stack([each.poses for each in snapshots])
        tracks = Tracks.of(poses)
        numbers = range(self._count, self._count + len(frames))
        times = _times(snapshots, numbers)
        bodies = self._bodies
        if bodies is None or scene is not bodies.scene:
            bodies = BodyGeometry(scene, self._camera.unit, bodies)
            self._aim_camera(bodies, Tracks.of(poses[:1]), snapshots[0].ends)
            if bodies.unit != self._camera.unit:
                bodies = BodyGeometry(scene, self._camera.unit)
            self._bodies, self._due = bodies, self._count
            above = 2 * (THICK + DEPTH) * bodies.unit
            self._joints = JointGeometry(scene, bodies.unit, above) if scene.joints else None
        if self._count >= self._due:
            self._due = self._count + REPEAT
            self._send_geometry(bodies, _times(snapshots[:1], numbers[:1]))
            moved = np.ones(len(scene.bodies), dtype=bool)
        else:
            moved = (poses != self._poses).any(axis=(0, 2))
        self._poses = poses[-1]
        for path, table in bodies.tables.items():
            if moved[table.rows].any():
                self._send_tracks(path, table, tracks, times)
        if self._joints is not None and self._joints.has_moved(moved):
            columns = self._joints.columns(poses, [each.forces for each in snapshots])
            self._recording.send_columns(JOINTS, times, columns)
        self._send_energy(frames, numbers)
        self._send_contacts(frames, times)
        self._send_hands(snapshots, times)
        self._send_previews(frames, numbers)
        self._send_events(frames, numbers)
        self._run_states.draw(frames, numbers)
        self._count += len(frames)

    def _aim_camera(self, bodies: BodyGeometry, tracks: Tracks, ends: Floats) -> None:
        bounds = bodies.scene.settings.bounds
        if bounds is not None:
            self._camera.show_bounds(bounds)
        elif bodies.scene.bodies:
            self._camera.show_bodies(bodies.extent(tracks), ends)

    def _send_styles(self) -> None:
        """Log the constant components as static, which a server never drops."""
        wall = sent_colors(np.array([WALL], dtype=np.float32), shaded=True)
        faint = (255, 255, 255, round(255 * TRANSLUCENT))
        styles: dict[str, rr.AsComponents] = {
            'world/camera': pinhole(),
            'world/walls': rr.Boxes3D.from_fields(fill_mode='solid', colors=wall),
            'world/contacts': rr.Points3D.from_fields(
                radii=rr.Radius.ui_points(2.0), colors=[CONTACT]
            ),
            'world/hands': rr.LineStrips3D.from_fields(
                radii=rr.Radius.ui_points(1.0), colors=[PREVIEW]
            ),
            'world/preview/lines': rr.LineStrips3D.from_fields(
                radii=rr.Radius.ui_points(1.5), colors=[PREVIEW]
            ),
            'world/preview/points': rr.Points3D.from_fields(
                radii=rr.Radius.ui_points(3.0), colors=[PREVIEW], show_labels=True
            ),
            'energy': rr.SeriesLines(names=list(ENERGIES), colors=list(ENERGIES.values())),
            'real_time_factor': rr.SeriesLines(names='real-time factor', colors=[FACTOR]),
        }
        for place in PLACES:
            for kind in RECTANGLES:
                styles[f'{place}/{kind}'] = rr.Boxes3D.from_fields(fill_mode='solid')
            styles[f'{place}/discs'] = rr.Cylinders3D.from_fields(fill_mode='solid')
            styles[f'{place}/ghosts'] = rr.Mesh3D.from_fields(albedo_factor=faint)
        for path, style in styles.items():
            self._recording.log(path, style, static=True)

    def _send_geometry(self, bodies: BodyGeometry, times: Times) -> None:
        """Send the components that change only with the scene; clear entities without geometry."""
        for path, table in bodies.tables.items():
            if table.kind in RECTANGLES:
                columns = rr.Boxes3D.columns(half_sizes=table.sizes, colors=table.colors)
            elif table.kind in TRIANGLES:
                columns = rr.Mesh3D.columns(vertex_colors=table.colors)
            else:
                columns = rr.Cylinders3D.columns(
                    radii=table.sizes[:, 0], lengths=2 * table.sizes[:, 2], colors=table.colors
                )
            self._recording.send_columns(path, times, columns.partition([len(table.rows)]))
        gone = self._filled - bodies.tables.keys() - ({JOINTS} if bodies.scene.joints else set())
        for path in gone:
            self._recording.send_columns(path, times, rr.Clear.columns(is_recursive=[False]))
        self._filled = set(bodies.tables) | ({JOINTS} if bodies.scene.joints else set())
        centers, sizes = _walls(bodies.scene.settings.bounds, bodies.unit)
        walls = rr.Boxes3D.columns(centers=centers, half_sizes=sizes).partition([len(centers)])
        self._recording.send_columns('world/walls', times, walls)
        self._recording.send_columns('world/camera', times, self._camera.transform())

    def _send_tracks(self, path: str, table: Table, tracks: Tracks, times: Times) -> None:
        lengths = [len(table.rows)] * len(tracks.x)
        centers = table.centers(tracks)
        if table.kind in RECTANGLES:
            rotations = table.quaternions(tracks)
            columns = [
                _column(_BOX_CENTERS, centers, lengths),
                _column(_BOX_ROTATIONS, rotations, lengths),
            ]
        else:
            slot = _CORNERS if table.kind in TRIANGLES else _DISC_CENTERS
            columns = [_column(slot, centers, lengths)]
        self._recording.send_columns(path, times, columns)

    def _send_energy(self, frames: Sequence[Frame], numbers: Sequence[int]) -> None:
        """Send the energies of every `SAMPLE`-th frame and of the last one."""
        last = numbers[-1]
        chosen = {
            number: frame.snapshot
            for number, frame in zip(numbers, frames, strict=True)
            if number % SAMPLE == 0 or number == last
        }
        kinetic = np.array([each.kinetic_energy for each in chosen.values()])
        potential = np.array(
            [each.potential_energy + each.elastic_energy for each in chosen.values()]
        )
        energies = np.column_stack((kinetic, potential, kinetic + potential)).ravel()
        column = _column(_SCALARS, energies, [len(ENERGIES)] * len(chosen))
        times = _times(list(chosen.values()), list(chosen))
        self._recording.send_columns('energy', times, [column])

    def _send_contacts(self, frames: Sequence[Frame], times: Times) -> None:
        points = [_NO_POINTS if each.contacts is None else each.contacts.points for each in frames]
        lengths = [len(each) for each in points]
        # An empty row after the last contact, then none.
        if not self._touching and not any(lengths):
            return
        self._touching = lengths[-1] > 0
        height = np.full((sum(lengths), 1), 2 * (THICK + DEPTH) * self._camera.unit)
        positions = np.hstack((np.concatenate(points), height)).astype(np.float32)
        columns = rr.Points3D.columns(positions=positions).partition(lengths)
        self._recording.send_columns('world/contacts', times, columns)

    def _send_hands(self, snapshots: Sequence[Snapshot], times: Times) -> None:
        """Send the lines from grabbed bodies to their hands, and an empty row after the last."""
        lengths = [len(each.grips) for each in snapshots]
        if not self._hands and not any(lengths):
            return
        self._hands = lengths[-1]
        lines = [self._raised(line) for each in snapshots for line in each.grip_lines.tolist()]
        strips = rr.LineStrips3D.columns(strips=lines).partition(lengths)
        self._recording.send_columns('world/hands', times, strips)

    def _send_previews(self, frames: Sequence[Frame], numbers: Sequence[int]) -> None:
        """Send previews that have changed, end after `LINGER` frames, or are due again."""
        for frame, number in zip(frames, numbers, strict=True):
            preview = frame.preview
            if preview != self._current:
                self._current, self._current_since = preview, number
            if not preview.points and number - self._current_since >= LINGER:
                preview = NO_PREVIEW
            if preview == self._preview and (preview == NO_PREVIEW or number % REPEAT):
                continue
            self._preview = preview
            times = _times([frame.snapshot], [number])
            lines = [self._raised(line) for line in preview.lines]
            strips = rr.LineStrips3D.columns(strips=lines).partition([len(lines)])
            self._recording.send_columns('world/preview/lines', times, strips)
            # The label has a point of its own.
            points = self._raised([*preview.points, *([preview.top] if preview.label else [])])
            labels = ['' for _ in preview.points] + [preview.label] * bool(preview.label)
            dots = rr.Points3D.columns(positions=points, labels=labels).partition([len(points)])
            self._recording.send_columns('world/preview/points', times, dots)

    def _raised(self, points: Sequence[Point]) -> Singles:
        """Return points of the plane raised above all bodies, (n, 3) float32 [m]."""
        height = 3 * (THICK + DEPTH) * self._camera.unit
        return np.array([(x, y, height) for x, y in points], dtype=np.float32).reshape(-1, 3)

    def _send_events(self, frames: Sequence[Frame], numbers: Sequence[int]) -> None:
        rows = [
            (frame.snapshot, number, answer)
            for frame, number in zip(frames, numbers, strict=True)
            for answer in frame.answers
        ]
        if rows:
            columns = rr.TextLog.columns(
                text=[_line(answer) for _, _, answer in rows],
                level=['ERROR' if answer.code else 'INFO' for _, _, answer in rows],
            )
            times = _times([each for each, _, _ in rows], [number for _, number, _ in rows])
            self._recording.send_columns('events', times, columns)


def _column(slot: Slot, values: NDArray[Any], lengths: list[int]) -> rr.ComponentColumn:
    """Return values as a column of rows of so many values; `Archetype.columns` is half as fast."""
    descriptor, batch = slot
    return rr.ComponentColumn(descriptor, batch(values), lengths=lengths)


def _slots(columns: rr.ComponentColumnList, *batches: Callable[[Any], Any]) -> list[Slot]:
    return [(column.descriptor, batch) for column, batch in zip(columns, batches, strict=True)]


_BOX_CENTERS, _BOX_ROTATIONS = _slots(
    rr.Boxes3D.columns(centers=[(0, 0, 0)], quaternions=[(0, 0, 0, 1)]),
    rr.components.Translation3DBatch,
    rr.components.RotationQuatBatch,
)
(_DISC_CENTERS,) = _slots(
    rr.Cylinders3D.columns(centers=[(0, 0, 0)]), rr.components.Translation3DBatch
)
(_CORNERS,) = _slots(
    rr.Mesh3D.columns(vertex_positions=[(0, 0, 0)]), rr.components.Position3DBatch
)
(_SCALARS,) = _slots(rr.Scalars.columns(scalars=[0.0]), rr.components.ScalarBatch)


def _times(snapshots: Sequence[Snapshot], numbers: Sequence[int]) -> Times:
    stamps = np.array([each.stamp for each in snapshots], dtype='timedelta64[ns]')
    return [
        rr.TimeColumn('frame', sequence=numbers),
        rr.TimeColumn('step', sequence=[each.step for each in snapshots]),
        rr.TimeColumn('sim_time', duration=stamps),
    ]


def _line(answer: Answer) -> str:
    words = (answer.topic, answer.subject, answer.message, answer.code and f'[{answer.code}]')
    return '  '.join(filter(None, words))


def _walls(bounds: Bounds | None, unit: float) -> tuple[Singles, Singles]:
    """Return centres and half extents, (4, 3) float32 [m], of bars just outside the bounds."""
    if bounds is None:
        return np.empty((0, 3), dtype=np.float32), np.empty((0, 3), dtype=np.float32)
    left, bottom, right, top = bounds
    half, thick = WALL_HALF * unit, THICK * unit
    x, y = (left + right) / 2, (bottom + top) / 2
    across, up = (right - left) / 2 + 2 * half, (top - bottom) / 2
    centers = [
        (x, bottom - half, 0),
        (x, top + half, 0),
        (left - half, y, 0),
        (right + half, y, 0),
    ]
    sizes = [(across, half, thick)] * 2 + [(half, up, thick)] * 2
    return np.array(centers, dtype=np.float32), np.array(sizes, dtype=np.float32)
