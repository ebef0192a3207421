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
The picture of the world in Rerun: its entities, their geometry, and the blueprint.

Law: what changes only with the scene is sent when the scene changes, and again now and then; what
moves is sent for many frames at once, one entity for each kind of thing.

Everything is a thin solid seen from straight above, by a camera that is the origin of a
two-dimensional view: that gives filled shapes, y up, and pan and zoom alone.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.core.settings import Bounds
from physsim_ros.core.shapes import (
    Box,
    Capsule,
    Circle,
    Color,
    Compound,
    Convex,
    Disc,
    Piece,
    Point,
    Polygon,
)
from physsim_ros.core.snapshot import Answer, Body, Floats, Frame, Scene
import rerun as rr
import rerun.blueprint as rrb

Singles = NDArray[np.float32]
Times = list[rr.TimeColumn]
# A flat rectangle or disc on a body: x, y [m], yaw [rad] in the body's frame; half extents [m];
# red, green, blue, alpha, each 0 .. 1. The corner of a triangle has no extent.
Thing = tuple[float, float, float, float, float, float, float, float, float]

# A server that has reached its memory limit drops old rows, so geometry is repeated [frames].
REPEAT = 300
# The picture's own pixels. The camera stands where 50 of them are one unit, whatever the size of
# the world, so that neither they nor the bounds of the view ever change.
WIDTH, HEIGHT, PIXELS = 1600, 1000, 50
DISTANCE = 20.0
# Half the thickness of a body, and the depth over which later bodies lie above earlier ones
# [units]: enough for the renderer's depth buffer, too little to be seen from the side.
THICK, DEPTH = 0.01, 0.02
# What is shown before there is anything: left, bottom, right, top [m].
NOWHERE = (-10.0, 0.0, 10.0, 12.0)
MARGIN = 0.08
# How far back the plots go: ten seconds at 60 Hz [frames].
PLOTTED = 600
# Half the width of lines, and of walls [units].
FINE, BOLD = 0.025, 0.1
TRANSLUCENT = 0.4
# What Rerun's light leaves of a solid seen from above, in linear light (its lighting.wgsl: 0.2
# and half of a light from (1, 3, 5)). Meshes without normals are not shaded.
LIT = 0.2 + 0.5 * 5 / math.sqrt(35)
DARK, LIGHT = (0.08, 0.08, 0.1, 1.0), (1.0, 1.0, 1.0, 1.0)
PAPER = (250, 250, 247)
WALL = (0.35, 0.37, 0.4, 1.0)
CONTACT = (214, 39, 40)
TIME = (84, 162, 75)
ENERGIES = {'kinetic': (245, 133, 24), 'potential': (76, 120, 168), 'total': (150, 150, 150)}
# Kinds of things: rectangles; and triangles, apart where they are translucent, as only a whole
# mesh can be.
RECTANGLES = ('boxes', 'marks', 'anchors', 'outlines')
TRIANGLES = ('polygons', 'ghosts')


@dataclass(frozen=True, slots=True)
class Table:
    """
    All things of one kind in a scene.

    :param rows: (k,) the bodies they lie on
    :param spots: (k, 3) float32: x, y [m], yaw [rad] in the body's frame
    :param sizes: (k, 3) float32: half extents [m]
    :param colors: (k, 4) uint8
    :param depth: (k,) float32: z [m]
    """

    rows: NDArray[np.intp]
    spots: Singles
    sizes: Singles
    colors: NDArray[np.uint8]
    depth: Singles

    def centers(self, poses: Floats) -> Singles:
        """Return (f * k, 3) float32: where they are for (f, n, 3) poses of the bodies."""
        poses = poses[:, self.rows]
        centers = np.empty(poses.shape, dtype=np.float32)
        centers[..., :2] = poses[..., :2]
        centers[..., 2] = self.depth
        x, y = self.spots[:, 0], self.spots[:, 1]
        if x.any() or y.any():
            cos, sin = np.cos(poses[..., 2]), np.sin(poses[..., 2])
            centers[..., 0] += cos * x - sin * y
            centers[..., 1] += sin * x + cos * y
        return centers.reshape(-1, 3)

    def quaternions(self, poses: Floats) -> Singles:
        """Return (f * k, 4) float32: how they are turned for (f, n, 3) poses of the bodies."""
        half = (poses[:, self.rows, 2] + self.spots[:, 2]) / 2
        turns = np.zeros((*half.shape, 4), dtype=np.float32)
        turns[..., 2], turns[..., 3] = np.sin(half), np.cos(half)
        return turns.reshape(-1, 4)


class Layout:
    """
    What a scene is drawn with: all of the picture that stays while the world steps.

    :param scene: the bodies
    :param unit: the length that lines are measured in [m]
    :param before: the layout before this one; bodies that it knows are not sketched anew
    """

    def __init__(self, scene: Scene, unit: float, before: Layout | None = None) -> None:
        self.scene = scene
        self.unit = unit
        known = before.sketches if before is not None and before.unit == unit else {}
        # By identity; the body is kept beside its sketch, so that its id stays its own.
        self.sketches = {
            id(body): known.get(id(body)) or (body, _sketch(body, unit)) for body in scene.bodies
        }
        self.tables = {kind: self._table(kind) for kind in (*RECTANGLES, *TRIANGLES, 'discs')}

    def extent(self, poses: Floats) -> Bounds:
        """Return left, bottom, right, top [m] of all bodies at (n, 3) poses; at least one body."""
        low, high = np.full(2, np.inf), np.full(2, -np.inf)
        for kind in ('boxes', 'discs', *TRIANGLES):
            table = self.tables[kind]
            reach = table.sizes[:, :2]
            if kind == 'boxes':
                yaw = poses[table.rows, 2] + table.spots[:, 2]
                cos, sin = np.abs(np.cos(yaw))[:, None], np.abs(np.sin(yaw))[:, None]
                reach = cos * reach + sin * reach[:, ::-1]
            centers = table.centers(poses[None])[:, :2]
            low = np.minimum(low, (centers - reach).min(axis=0, initial=np.inf))
            high = np.maximum(high, (centers + reach).max(axis=0, initial=-np.inf))
        (left, bottom), (right, top) = low.tolist(), high.tolist()
        return left, bottom, right, top

    def _table(self, kind: str) -> Table:
        parts = [self.sketches[id(body)][1].get(kind, _NONE) for body in self.scene.bodies]
        rows = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
        things = np.concatenate([_NONE, *parts])
        spacing = DEPTH * self.unit / max(1, len(parts))
        thick = THICK * self.unit
        depth = rows * spacing
        colors = _shown(things[:, 5:], shaded=kind not in TRIANGLES)
        if kind in TRIANGLES:
            depth += thick
        elif kind not in {'boxes', 'discs'}:
            # Above their own body, below the next one.
            thick += spacing / 2
        sizes = np.column_stack((things[:, 3:5], np.full(len(things), thick, dtype=np.float32)))
        return Table(rows, things[:, :3], sizes, colors, depth.astype(np.float32))


def _shown(colors: Singles, *, shaded: bool) -> NDArray[np.uint8]:
    """
    Return (k, 4) uint8: what to send so that solids and meshes are seen in the colours asked for.

    Where a colour is brighter than the light on solids allows, its hue is kept.
    """
    # https://www.w3.org/TR/css-color-4/#color-conversion-code: sRGB to linear light and back.
    brightest = 1.055 * LIT ** (1 / 2.4) - 0.055
    peak = colors[:, :3].max(axis=1, keepdims=True, initial=brightest)
    shown = np.column_stack((colors[:, :3] * (brightest / peak), colors[:, 3]))
    if shaded:
        level = shown[:, :3]
        light = np.where(level <= 0.04045, level / 12.92, ((level + 0.055) / 1.055) ** 2.4) / LIT
        shown[:, :3] = np.where(
            light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055
        )
    return np.rint(np.clip(shown, 0.0, 1.0) * 255).astype(np.uint8)


_NONE: Singles = np.empty((0, 9), dtype=np.float32)
_NO_POINTS: Floats = np.empty((0, 2))


def _sketch(body: Body, unit: float) -> dict[str, Singles]:
    """Return what a body is drawn with: (k, 9) float32 of each kind, see Thing."""
    shape, form = body.shape, body.shape.form
    ghost = body.sensor or body.color[3] < 1
    red, green, blue, alpha = body.color
    color = (red, green, blue, alpha * (TRANSLUCENT if body.sensor else 1.0))
    ink = DARK if ghost or 0.3 * red + 0.6 * green + 0.1 * blue > 0.35 else LIGHT
    fine = FINE * unit
    things: defaultdict[str, list[Thing]] = defaultdict(list)
    for piece in form.pieces:
        match piece:
            case Circle((x, y), radius):
                things['discs'].append((x, y, 0.0, radius, radius, *color))
            case Capsule(start, end, radius):
                things['boxes'].append(_bar(start, end, radius, color))
                things['discs'] += ((*at, 0.0, radius, radius, *color) for at in (start, end))
            case Convex(corners) if isinstance(shape, Box | Compound):
                (left, bottom), _, (right, top), _ = corners
                middle = ((left + right) / 2, (bottom + top) / 2)
                size = ((right - left) / 2, (top - bottom) / 2)
                things['boxes'].append((*middle, 0.0, *size, *color))
            case Convex(corners):
                things['ghosts' if ghost else 'polygons'] += (
                    (*corner, 0.0, 0.0, 0.0, *color)
                    for second, third in pairwise(corners[1:])
                    for corner in (corners[0], second, third)
                )
    if isinstance(shape, Disc) and not body.anchored:
        width = min(fine, 0.1 * shape.radius)
        things['marks'].append(_bar((0.0, 0.0), (0.9 * shape.radius, 0.0), width, ink))
    if body.anchored:
        x, y = min(map(_middle, form.pieces), key=lambda at: math.dist(at, form.centroid))
        arm = min(max(0.4 * form.inner, 0.08 * unit), 0.2 * unit)
        for rise in (arm, -arm):
            ends = (x - arm, y - rise), (x + arm, y + rise)
            things['anchors'].append(_bar(*ends, 1.2 * fine, ink))
    if body.sensor or body.kinematic:
        ink = (red, green, blue, 1.0) if body.sensor else ink
        things['outlines'] += (
            _bar(start, end, fine, ink, overlap=fine)
            for outline in _outlines(body)
            for start, end in pairwise((*outline, outline[0]))
        )
    return {kind: np.array(each, dtype=np.float32) for kind, each in things.items()}


def _bar(start: Point, end: Point, half: float, color: Color, *, overlap: float = 0.0) -> Thing:
    """Return the rectangle along a line, so much wider to each side and longer at each end."""
    (x, y), length = _middle(Capsule(start, end, half)), math.dist(start, end)
    yaw = math.atan2(end[1] - start[1], end[0] - start[0])
    return (x, y, yaw, length / 2 + overlap, half, *color)


def _middle(piece: Piece) -> Point:
    match piece:
        case Circle(center, _):
            return center
        case Capsule((x1, y1), (x2, y2), _):
            return (x1 + x2) / 2, (y1 + y2) / 2
        case Convex(corners):
            x, y = zip(*corners, strict=True)
            return math.fsum(x) / len(x), math.fsum(y) / len(y)


def _outlines(body: Body) -> Iterator[Sequence[Point]]:
    """Yield the closed outlines of a body; a chain has none."""
    if isinstance(body.shape, Polygon):
        yield body.shape.outline
        return
    for piece in body.shape.form.pieces:
        if isinstance(piece, Convex):
            yield piece.vertices
        elif isinstance(piece, Circle):
            (x, y), radius = piece.center, piece.radius
            # As many sides as still look round at a radius of three units.
            angles = np.linspace(0.0, 2 * np.pi, 48, endpoint=False).tolist()
            yield [(x + radius * math.cos(each), y + radius * math.sin(each)) for each in angles]


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
        self._layout: Layout | None = None
        self._area = NOWHERE
        self._framed = False
        self._touching = False
        self._anchored: Floats | None = None
        recording.send_blueprint(blueprint())
        self._send_styles()

    def draw(self, frames: Sequence[Frame], real_time_factors: Sequence[float]) -> None:
        """
        Draw frames, one after the other; those that show nothing new are left out.

        :param frames: in order of time, their arrays never written again
        :param real_time_factors: simulated seconds a second, for each
        """
        fresh = []
        for frame, factor in zip(frames, real_time_factors, strict=True):
            if self._is_new(frame):
                fresh.append((frame, factor))
                self._last = frame
        for _, run in groupby(fresh, key=lambda each: id(each[0].snapshot.scene)):
            self._draw_run(*zip(*run, strict=True))

    def _is_new(self, frame: Frame) -> bool:
        if self._last is None or frame.moved or frame.answers:
            return True
        before, now = self._last.snapshot, frame.snapshot
        return now.scene is not before.scene or not np.array_equal(now.poses, before.poses)

    def _draw_run(self, frames: Sequence[Frame], factors: Sequence[float]) -> None:
        """Draw frames of one scene."""
        scene = frames[0].snapshot.scene
        poses = np.stack([frame.snapshot.poses for frame in frames])
        numbers = range(self._count, self._count + len(frames))
        times = _times(frames, numbers)
        if self._layout is None or scene is not self._layout.scene:
            self._layout = Layout(scene, _unit(self._area), self._layout)
            self._look_at(self._layout, poses[0])
            if self._layout.unit != _unit(self._area):
                self._layout = Layout(scene, _unit(self._area))
            self._due = self._count
        if self._count >= self._due:
            self._due = self._count + REPEAT
            self._anchored = None
            self._send_geometry(self._layout, _times(frames[:1], numbers[:1]))
        for kind, table in self._layout.tables.items():
            if len(table.rows) and (kind != 'anchors' or self._have_moved(poses[:, table.rows])):
                self._send_motion(kind, table, poses, times)
        self._send_plots(frames, factors, times)
        self._send_contacts(frames, times)
        self._send_events(frames, numbers)
        self._count += len(frames)

    def _have_moved(self, anchored: Floats) -> bool:
        """Tell whether what is anchored has been put elsewhere since it was drawn."""
        before, self._anchored = self._anchored, anchored[-1]
        return before is None or bool((anchored != before).any())

    def _look_at(self, layout: Layout, poses: Floats) -> None:
        """Choose what is seen: seldom anew, as a picture that jumps is hard to read."""
        bounds = layout.scene.settings.bounds
        if bounds is not None:
            self._area, self._framed = _widened(bounds, MARGIN / 2), True
        elif layout.scene.bodies:
            left, bottom, right, top = extent = layout.extent(poses)
            near = _widened(self._area, 0.5)
            inside = left >= near[0] and bottom >= near[1] and right <= near[2] and top <= near[3]
            if not self._framed or not inside:
                self._area, self._framed = _widened(extent, MARGIN), True

    def _send_styles(self) -> None:
        """Send once what never changes; static rows are never dropped."""
        styles: dict[str, rr.AsComponents] = {
            'world/camera': rr.Pinhole(
                focal_length=PIXELS * DISTANCE,
                width=WIDTH,
                height=HEIGHT,
                camera_xyz=rr.ViewCoordinates.RDF,
            ),
            'world/walls': rr.Boxes3D.from_fields(
                fill_mode='solid', colors=_shown(np.array([WALL], dtype=np.float32), shaded=True)
            ),
            'world/discs': rr.Cylinders3D.from_fields(fill_mode='solid'),
            'world/ghosts': rr.Mesh3D.from_fields(albedo_factor=(255, 255, 255, 100)),
            'world/contacts': rr.Points3D.from_fields(
                radii=rr.Radius.ui_points(2.0), colors=[CONTACT]
            ),
            'energy': rr.SeriesLines(names=list(ENERGIES), colors=list(ENERGIES.values())),
            'real_time_factor': rr.SeriesLines(names='real-time factor', colors=[TIME]),
        }
        for kind in RECTANGLES:
            styles[f'world/{kind}'] = rr.Boxes3D.from_fields(fill_mode='solid')
        for path, style in styles.items():
            self._recording.log(path, style, static=True)

    def _send_geometry(self, layout: Layout, times: Times) -> None:
        """Send what stays while the world steps, and nothing where there is none any more."""
        for kind, table in layout.tables.items():
            if kind in RECTANGLES:
                columns = rr.Boxes3D.columns(half_sizes=table.sizes, colors=table.colors)
            elif kind in TRIANGLES:
                columns = rr.Mesh3D.columns(vertex_colors=table.colors)
            else:
                columns = rr.Cylinders3D.columns(
                    radii=table.sizes[:, 0], lengths=2 * table.sizes[:, 2], colors=table.colors
                )
            self._send(kind, times, columns, [len(table.rows)])
            if not len(table.rows):
                self._send_motion(kind, table, np.empty((1, 0, 3)), times)
        centers, sizes = _walls(layout.scene.settings.bounds, layout.unit)
        walls = rr.Boxes3D.columns(centers=centers, half_sizes=sizes)
        self._send('walls', times, walls, [len(centers)])
        left, bottom, right, top = self._area
        eye = ((left + right) / 2, (bottom + top) / 2, DISTANCE * layout.unit)
        # Straight down: the image's x is the world's, its y the world's turned over.
        camera = rr.Transform3D.columns(translation=[eye], mat3x3=[np.diag((1.0, -1.0, -1.0))])
        self._send('camera', times, camera, [1])

    def _send_motion(self, kind: str, table: Table, poses: Floats, times: Times) -> None:
        centers = table.centers(poses)
        if kind in RECTANGLES:
            columns = rr.Boxes3D.columns(centers=centers, quaternions=table.quaternions(poses))
        elif kind in TRIANGLES:
            columns = rr.Mesh3D.columns(vertex_positions=centers)
        else:
            columns = rr.Cylinders3D.columns(centers=centers)
        self._send(kind, times, columns, [len(table.rows)] * len(poses))

    def _send_plots(self, frames: Sequence[Frame], factors: Sequence[float], times: Times) -> None:
        kinetic = np.array([frame.snapshot.kinetic_energy for frame in frames])
        potential = np.array([frame.snapshot.potential_energy for frame in frames])
        energies = np.column_stack((kinetic, potential, kinetic + potential)).ravel()
        columns = rr.Scalars.columns(scalars=energies).partition([3] * len(frames))
        self._recording.send_columns('energy', times, columns)
        self._recording.send_columns(
            'real_time_factor', times, rr.Scalars.columns(scalars=factors)
        )

    def _send_contacts(self, frames: Sequence[Frame], times: Times) -> None:
        points = [_NO_POINTS if each.contacts is None else each.contacts.points for each in frames]
        lengths = [len(each) for each in points]
        # Empty once more after the last contact, then no more.
        if not self._touching and not any(lengths):
            return
        self._touching = lengths[-1] > 0
        height = np.full((sum(lengths), 1), 2 * (THICK + DEPTH) * _unit(self._area))
        positions = np.hstack((np.concatenate(points), height)).astype(np.float32)
        self._send('contacts', times, rr.Points3D.columns(positions=positions), lengths)

    def _send_events(self, frames: Sequence[Frame], numbers: Sequence[int]) -> None:
        rows = [
            (frame, number, answer)
            for frame, number in zip(frames, numbers, strict=True)
            for answer in frame.answers
        ]
        if rows:
            columns = rr.TextLog.columns(
                text=[_line(answer) for _, _, answer in rows],
                level=['ERROR' if answer.code else 'INFO' for _, _, answer in rows],
            )
            times = _times([frame for frame, _, _ in rows], [number for _, number, _ in rows])
            self._recording.send_columns('events', times, columns)

    def _send(
        self, kind: str, times: Times, columns: rr.ComponentColumnList, lengths: list[int]
    ) -> None:
        self._recording.send_columns(f'world/{kind}', times, columns.partition(lengths))


def _times(frames: Sequence[Frame], numbers: Sequence[int]) -> Times:
    snapshots = [frame.snapshot for frame in frames]
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


def _widened(area: Bounds, share: float) -> Bounds:
    left, bottom, right, top = area
    more = share * max(right - left, top - bottom)
    return left - more, bottom - more, right + more, top + more


def _walls(bounds: Bounds | None, unit: float) -> tuple[Singles, Singles]:
    """Return centres and half extents, (4, 3) float32 [m], of bars just outside the bounds."""
    if bounds is None:
        return np.empty((0, 3), dtype=np.float32), np.empty((0, 3), dtype=np.float32)
    left, bottom, right, top = bounds
    bold, thick = BOLD * unit, THICK * unit
    x, y = (left + right) / 2, (bottom + top) / 2
    across, up = (right - left) / 2 + 2 * bold, (top - bottom) / 2
    centers = [
        (x, bottom - bold, 0),
        (x, top + bold, 0),
        (left - bold, y, 0),
        (right + bold, y, 0),
    ]
    sizes = [(across, bold, thick)] * 2 + [(bold, up, thick)] * 2
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
                rrb.TimeSeriesView(origin='energy', name='Energy [J]', time_ranges=recent),
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
                row_shares=[3, 2, 2],
            ),
            column_shares=[3, 1],
        ),
        rrb.BlueprintPanel(state='collapsed'),
        rrb.SelectionPanel(state='collapsed'),
        rrb.TimePanel(state='collapsed', timeline='frame', play_state='following'),
    )
