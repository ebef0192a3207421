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
The picture of the world in Rerun: its entities, its camera, its plots, and how they are laid out.

Law: what changes only with the scene is sent when the scene changes, and again now and then; what
moves is sent for many frames at once, one entity for each kind of thing.

Everything is a thin solid seen from straight above, by a camera that is the origin of a
two-dimensional view: that gives filled shapes, y up, and pan and zoom alone.
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
from physsim_ros.view import run_state_track
from physsim_ros.view.body_geometry import (
    BodyPicture,
    DEPTH,
    PLACES,
    RECTANGLES,
    shown,
    Table,
    THICK,
    Tracks,
    TRANSLUCENT,
    TRIANGLES,
)
from physsim_ros.view.joint_geometry import JointPicture
from physsim_ros.view.joint_geometry import PATH as JOINTS
import rerun as rr
import rerun.blueprint as rrb

Times = list[rr.TimeColumn]
# A component that is sent over and over: its descriptor, and what packs its values.
Slot = tuple[rr.ComponentDescriptor, Callable[[Any], Any]]

# A server that has reached its memory limit drops old rows, so geometry is repeated [frames].
REPEAT = 300
# The picture's own pixels. The camera stands where 50 of them are one unit, whatever the size of
# the world, so that neither they nor the bounds of the view ever change.
WIDTH, HEIGHT, PIXELS = 1600, 1000, 50
DISTANCE = 20.0
# What is shown before there is anything: left, bottom, right, top [m].
NOWHERE = (-10.0, 0.0, 10.0, 12.0)
MARGIN = 0.08
# Half the thickness of the walls [units].
WALL_HALF = 0.1
# How long the reading of a stroke is seen [frames].
LINGER = 180
# How far back the plots go: ten seconds at 60 Hz [frames].
PLOTTED = 600
# Energies are plotted at each so many-th frame.
SAMPLE = 6
PAPER = (250, 250, 247)
WALL = (0.35, 0.37, 0.4, 1.0)
CONTACT = (214, 39, 40)
PREVIEW = (230, 51, 128)
FACTOR = (84, 162, 75)
ENERGIES = {'kinetic': (245, 133, 24), 'potential': (76, 120, 168), 'total': (150, 150, 150)}

_NO_POINTS: Floats = np.empty((0, 2))


class Picture:
    """
    Draws frames on a recording stream.

    :param recording: where to; blueprint and geometry are sent to it afresh
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        # Frames drawn: the one timeline that never goes back.
        self._count = 0
        self._due = 0
        self._last: Frame | None = None
        self._bodies: BodyPicture | None = None
        self._joints: JointPicture | None = None
        self._area = NOWHERE
        self._framed = False
        self._touching = False
        # What is shown of what is half drawn, what was last asked for, and when.
        self._preview = self._asked = NO_PREVIEW
        self._asked_at = 0
        # Entities that are not empty, and where the bodies were drawn last.
        self._drawn: set[str] = set()
        self._poses: Floats = np.empty((0, 3))
        self._band = run_state_track.Band(recording)
        recording.send_blueprint(blueprint())
        self._send_styles()

    def draw(self, frames: Sequence[Frame], *, real_time_factor: float) -> None:
        """
        Draw frames, one after the other; those that show nothing new are left out.

        :param frames: in order of time, their arrays never written again
        :param real_time_factor: simulated seconds a second, at the last of them
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
        return now.scene is not before.scene or not np.array_equal(now.poses, before.poses)

    def _draw_run(self, frames: Sequence[Frame]) -> None:
        """Draw frames of one scene."""
        snapshots = [frame.snapshot for frame in frames]
        scene = snapshots[0].scene
        poses = np.stack([each.poses for each in snapshots])
        tracks = Tracks.of(poses)
        numbers = range(self._count, self._count + len(frames))
        times = _times(snapshots, numbers)
        bodies = self._bodies
        if bodies is None or scene is not bodies.scene:
            bodies = BodyPicture(scene, _unit(self._area), bodies)
            self._look_at(bodies, Tracks.of(poses[:1]), snapshots[0].ends)
            if bodies.unit != _unit(self._area):
                bodies = BodyPicture(scene, _unit(self._area))
            self._bodies, self._due = bodies, self._count
            above = 2 * (THICK + DEPTH) * bodies.unit
            self._joints = JointPicture(scene, bodies.unit, above) if scene.joints else None
        if self._count >= self._due:
            self._due = self._count + REPEAT
            self._send_geometry(bodies, _times(snapshots[:1], numbers[:1]))
            stirred = np.ones(len(scene.bodies), dtype=bool)
        else:
            stirred = (poses != self._poses).any(axis=(0, 2))
        self._poses = poses[-1]
        for path, table in bodies.tables.items():
            if stirred[table.rows].any():
                self._send_tracks(path, table, tracks, times)
        if self._joints is not None and self._joints.stirs(stirred):
            columns = self._joints.columns(poses, [each.forces for each in snapshots])
            self._recording.send_columns(JOINTS, times, columns)
        self._send_energy(frames, numbers)
        self._send_contacts(frames, times)
        self._send_previews(frames, numbers)
        self._send_events(frames, numbers)
        self._band.draw(frames, numbers)
        self._count += len(frames)

    def _look_at(self, bodies: BodyPicture, tracks: Tracks, ends: Floats) -> None:
        """Choose what is seen: seldom anew, as a picture that jumps is hard to read."""
        bounds = bodies.scene.settings.bounds
        if bounds is not None:
            self._area, self._framed = _widened(bounds, MARGIN / 2), True
        elif bodies.scene.bodies:
            left, bottom, right, top = extent = _around(bodies.extent(tracks), ends)
            near = _widened(self._area, 0.5)
            inside = left >= near[0] and bottom >= near[1] and right <= near[2] and top <= near[3]
            if not self._framed or not inside:
                self._area, self._framed = _widened(extent, MARGIN), True

    def _send_styles(self) -> None:
        """Send once what never changes; static rows are never dropped."""
        wall = shown(np.array([WALL], dtype=np.float32), shaded=True)
        faint = (255, 255, 255, round(255 * TRANSLUCENT))
        styles: dict[str, rr.AsComponents] = {
            'world/camera': rr.Pinhole(
                focal_length=PIXELS * DISTANCE,
                width=WIDTH,
                height=HEIGHT,
                camera_xyz=rr.ViewCoordinates.RDF,
            ),
            'world/walls': rr.Boxes3D.from_fields(fill_mode='solid', colors=wall),
            'world/contacts': rr.Points3D.from_fields(
                radii=rr.Radius.ui_points(2.0), colors=[CONTACT]
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

    def _send_geometry(self, bodies: BodyPicture, times: Times) -> None:
        """Send what stays while the world steps, and nothing where there is none any more."""
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
        gone = self._drawn - bodies.tables.keys() - ({JOINTS} if bodies.scene.joints else set())
        for path in gone:
            self._recording.send_columns(path, times, rr.Clear.columns(is_recursive=[False]))
        self._drawn = set(bodies.tables) | ({JOINTS} if bodies.scene.joints else set())
        centers, sizes = _walls(bodies.scene.settings.bounds, bodies.unit)
        walls = rr.Boxes3D.columns(centers=centers, half_sizes=sizes).partition([len(centers)])
        self._recording.send_columns('world/walls', times, walls)
        left, bottom, right, top = self._area
        eye = ((left + right) / 2, (bottom + top) / 2, DISTANCE * bodies.unit)
        # Straight down: the image's x is the world's, its y the world's turned over.
        camera = rr.Transform3D.columns(translation=[eye], mat3x3=[np.diag((1.0, -1.0, -1.0))])
        self._recording.send_columns('world/camera', times, camera)

    def _send_tracks(self, path: str, table: Table, tracks: Tracks, times: Times) -> None:
        lengths = [len(table.rows)] * len(tracks.x)
        centers = table.centers(tracks)
        if table.kind in RECTANGLES:
            turns = table.quaternions(tracks)
            columns = [
                _column(_BOX_CENTERS, centers, lengths),
                _column(_BOX_TURNS, turns, lengths),
            ]
        else:
            slot = _CORNERS if table.kind in TRIANGLES else _DISC_CENTERS
            columns = [_column(slot, centers, lengths)]
        self._recording.send_columns(path, times, columns)

    def _send_energy(self, frames: Sequence[Frame], numbers: Sequence[int]) -> None:
        """Send now and then, and always the newest: a plot shows no more."""
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
        # Empty once more after the last contact, then no more.
        if not self._touching and not any(lengths):
            return
        self._touching = lengths[-1] > 0
        height = np.full((sum(lengths), 1), 2 * (THICK + DEPTH) * _unit(self._area))
        positions = np.hstack((np.concatenate(points), height)).astype(np.float32)
        columns = rr.Points3D.columns(positions=positions).partition(lengths)
        self._recording.send_columns('world/contacts', times, columns)

    def _send_previews(self, frames: Sequence[Frame], numbers: Sequence[int]) -> None:
        """Send what is half drawn where that has changed, or is to be repeated."""
        for frame, number in zip(frames, numbers, strict=True):
            preview = frame.preview
            if preview != self._asked:
                self._asked, self._asked_at = preview, number
            if not preview.points and number - self._asked_at >= LINGER:
                preview = NO_PREVIEW
            if preview == self._preview and (preview == NO_PREVIEW or number % REPEAT):
                continue
            self._preview = preview
            times = _times([frame.snapshot], [number])
            lines = [self._raised(line) for line in preview.lines]
            strips = rr.LineStrips3D.columns(strips=lines).partition([len(lines)])
            self._recording.send_columns('world/preview/lines', times, strips)
            # The label stands at a point of its own.
            points = self._raised([*preview.points, *([preview.top] if preview.label else [])])
            labels = ['' for _ in preview.points] + [preview.label] * bool(preview.label)
            dots = rr.Points3D.columns(positions=points, labels=labels).partition([len(points)])
            self._recording.send_columns('world/preview/points', times, dots)

    def _raised(self, points: Sequence[Point]) -> Singles:
        """Return points of the plane above all that is in the world, (n, 3) float32 [m]."""
        height = 3 * (THICK + DEPTH) * _unit(self._area)
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
    """Return values as a column, each row so long; `Archetype.columns` takes twice the time."""
    descriptor, batch = slot
    return rr.ComponentColumn(descriptor, batch(values), lengths=lengths)


def _slots(columns: rr.ComponentColumnList, *batches: Callable[[Any], Any]) -> list[Slot]:
    return [(column.descriptor, batch) for column, batch in zip(columns, batches, strict=True)]


_BOX_CENTERS, _BOX_TURNS = _slots(
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


def _unit(area: Bounds) -> float:
    """Return the length that is drawn as 50 pixels [m]: about 1 m for a world of 20 m."""
    left, bottom, right, top = area
    return PIXELS * max((right - left) / WIDTH, (top - bottom) / HEIGHT)


def _around(area: Bounds, ends: Floats) -> Bounds:
    """Return an area with the points of joints, (j, 2, 2), in it."""
    points = ends.reshape(-1, 2)
    left, bottom = np.minimum(points.min(axis=0, initial=np.inf), area[:2]).tolist()
    right, top = np.maximum(points.max(axis=0, initial=-np.inf), area[2:]).tolist()
    return left, bottom, right, top


def _widened(area: Bounds, share: float) -> Bounds:
    left, bottom, right, top = area
    more = share * max(right - left, top - bottom)
    return left - more, bottom - more, right + more, top + more


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


def blueprint() -> rrb.Blueprint:
    """Return how it is laid out: the world large, the plots and what happened beside it."""
    recent = rrb.VisibleTimeRange(
        'frame',
        start=rrb.TimeRangeBoundary.cursor_relative(seq=-PLOTTED),
        end=rrb.TimeRangeBoundary.cursor_relative(),
    )
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Spatial2DView(
                origin='world/camera',
                contents='world/**',
                name='World',
                background=PAPER,
                visual_bounds=rrb.VisualBounds2D(x_range=(0, WIDTH), y_range=(0, HEIGHT)),
            ),
            rrb.Vertical(
                run_state_track.view(),
                rrb.TimeSeriesView(
                    origin='energy',
                    name='Energy [J]',
                    time_ranges=recent,
                    plot_legend=rrb.PlotLegend(corner=rrb.Corner2D.RightTop),
                ),
                rrb.TimeSeriesView(
                    origin='real_time_factor',
                    name='Real-time factor',
                    time_ranges=recent,
                    plot_legend=rrb.PlotLegend(visible=False),
                ),
                rrb.TextLogView(
                    origin='events',
                    name='Events',
                    columns=rrb.TextLogColumns(text_log_columns=['loglevel', 'body']),
                ),
                row_shares=[2, 3, 2, 2],
            ),
            column_shares=[3, 1],
        ),
        rrb.BlueprintPanel(state='collapsed'),
        rrb.SelectionPanel(state='collapsed'),
        rrb.TimePanel(state='collapsed', timeline='frame', play_state='following'),
    )
