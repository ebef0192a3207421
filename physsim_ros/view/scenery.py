# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The scenery: camera, walls, and the grid with its coordinates; colours and layers of the picture.

The camera is a pinhole straight above. Bodies are thin solids, and the camera is the origin of a
two-dimensional view: that gives filled shapes, y up, and pan and zoom without rotation.
"""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.appearance import nice_number
from physsim_ros.model.arrays import Floats, Singles
from physsim_ros.model.settings import Bounds
from physsim_ros.model.shapes import piece_box
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.view.frame_batch import Times
import rerun as rr

CAMERA, WALLS = 'world/camera', 'world/walls'
_GRID, _METRES = 'world/grid', 'world/grid/metres'
PAPER = (250, 250, 247)
# Rerun (0.41) draws words on a plate that is light grey in its light theme and a middle grey in
# its dark one.
_INK = (16, 20, 30)
_WALL, _FAINT, _CLEAR = (89, 94, 102), (228, 229, 224), (203, 205, 200)
_POINT = rr.Radius.ui_points(0.0)
# Points of which only the labels are seen, in the world and in the image of the camera.
LABELS = rr.Points3D.from_fields(colors=[_INK], radii=_POINT, show_labels=True)
IMAGE_LABELS = rr.Points2D.from_fields(colors=[_INK], radii=_POINT, show_labels=True)

# Size of the view of the world [pixels]: of the shape that it has in a window of 16 : 10.
WIDTH, HEIGHT = 1280, 760
# Length of a unit of the view in the image [pixels], for worlds of any size.
PIXELS = 50
# Distance of the camera from the plane [units].
_DISTANCE = 20.0
# Depth over which later bodies lie above earlier ones [units]: enough for the renderer's depth
# buffer, too little for a difference in perspective.
DEPTH = 0.02
# Heights above the plane, over all bodies [units].
JOINTS, ARROWS, PREVIEW, TEXTS = (DEPTH + each for each in (0.01, 0.02, 0.03, 0.04))

# Area before there are bodies: left, bottom, right, top [m].
_EMPTY = (-10.0, 0.0, 10.0, 12.0)
# Margin around bounds or bodies [units]: it has the coordinates of the grid at the left and below,
# and the legend above.
_MARGIN = 1.2
# Room for bodies to move where there are no bounds, and distance from the area at which a body
# moves the camera, in shares of the longer side of their area.
_ROOM, _TOLERANCE = 0.05, 0.5
# Thickness of the walls [units].
_THICK = 0.2

# Least distance of two lines of the grid [units].
_LEAST = 0.8
# Half the width and height of the grid [units]: twice what the camera shows, in narrow views too.
_ACROSS, _UP = 32.0, 26.0
# Places of the labels in the margin of the camera [units]: of the upper edges of the labels below,
# over the lower edge of the area; of the middles of the labels at the left, from its left edge.
_ABOVE, _ASIDE = 0.85, 0.55
# Half the height of a label, which hangs below its point [units].
_HALF = 0.27


class Scenery:
    """
    Aims the camera, and sends what is seen around the bodies.

    The camera moves only when the bounds change or a body leaves the widened area, since a view
    that jumps is hard to follow.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        # Left, bottom, right, top of the bounds or of the bodies [m].
        self._content: Bounds = _EMPTY
        self._aimed = False
        recording.log(
            CAMERA,
            rr.Pinhole(
                focal_length=PIXELS * _DISTANCE,
                width=WIDTH,
                height=HEIGHT,
                camera_xyz=rr.ViewCoordinates.RDF,
            ),
            static=True,
        )
        recording.log(WALLS, rr.Mesh3D.from_fields(albedo_factor=_WALL), static=True)
        recording.log(_METRES, LABELS, static=True)

    @property
    def unit(self) -> float:
        """Length that is drawn as 50 pixels [m]: about 1 m for a world of 20 m."""
        left, bottom, right, top = self._content
        across, up = WIDTH / PIXELS - 2 * _MARGIN, HEIGHT / PIXELS - 2 * _MARGIN
        return max((right - left) / across, (top - bottom) / up)

    def aim(self, snapshot: Snapshot) -> None:
        """Aim at the bounds of a world, or at its bodies and joints if one lies far outside."""
        scene = snapshot.scene
        if scene.settings.bounds is not None:
            self._content, self._aimed = scene.settings.bounds, True
        elif scene.bodies:
            near = _widened(self._content, _TOLERANCE * _longer_side(self._content))
            reach = scene.outer_radii[:, None]
            around = (snapshot.centers - reach, snapshot.centers + reach, *snapshot.ends)
            if not self._aimed or not _contains(near, np.concatenate(around)):
                extent = _extent(snapshot)
                self._content = _widened(extent, _ROOM * _longer_side(extent))
                self._aimed = True

    def send(self, bounds: Bounds | None, times: Times) -> None:
        """
        Send camera, walls and grid.

        :param bounds: of the world: left, bottom, right, top [m]
        :param times: of one frame
        """
        left, bottom, right, top = self._content
        eye = ((left + right) / 2, (bottom + top) / 2, _DISTANCE * self.unit)
        # Straight down: the x axis of the image is that of the world, its y axis is reversed.
        aim = rr.Transform3D.columns(translation=[eye], mat3x3=[np.diag((1.0, -1.0, -1.0))])
        self._recording.send_columns(CAMERA, times, aim)
        corners = _wall_corners(bounds, self.unit)
        walls = rr.Mesh3D.columns(vertex_positions=corners).partition([len(corners)])
        self._recording.send_columns(WALLS, times, walls)
        area = _widened(self._content, _MARGIN * self.unit)
        for path, columns in zip((_GRID, _METRES), _grid_columns(area, self.unit), strict=True):
            self._recording.send_columns(path, times, columns)


def _extent(snapshot: Snapshot) -> Bounds:
    """Return left, bottom, right, top [m] of all bodies and joints."""
    boxes = [
        piece_box(piece, pose)
        for body, pose in zip(snapshot.scene.bodies, snapshot.poses.tolist(), strict=True)
        for piece in body.shape.form.pieces
    ]
    points = np.concatenate((np.array(boxes).reshape(-1, 2), *snapshot.ends))
    (left, bottom), (right, top) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    return left, bottom, right, top


def _contains(area: Bounds, points: Floats) -> bool:
    """Return whether all points, (n, 2) float64, lie in an area."""
    left, bottom, right, top = area
    return bool(((points >= (left, bottom)) & (points <= (right, top))).all())


def _longer_side(area: Bounds) -> float:
    left, bottom, right, top = area
    return max(right - left, top - bottom)


def _widened(area: Bounds, more: float) -> Bounds:
    left, bottom, right, top = area
    return left - more, bottom - more, right + more, top + more


def _wall_corners(bounds: Bounds | None, unit: float) -> Singles:
    """Return the triangles of bars just outside the bounds, (24, 3) float32 [m]."""
    if bounds is None:
        return np.empty((0, 3), dtype=np.float32)
    left, bottom, right, top = bounds
    outer = _widened(bounds, _THICK * unit)
    bars = (
        (outer[0], outer[1], outer[2], bottom),
        (outer[0], top, outer[2], outer[3]),
        (outer[0], bottom, left, top),
        (right, bottom, outer[2], top),
    )
    corners = [
        (x, y, 0.0)
        for x1, y1, x2, y2 in bars
        for x, y in ((x1, y1), (x2, y1), (x2, y2), (x1, y1), (x2, y2), (x1, y2))
    ]
    return np.array(corners, dtype=np.float32)


def _grid_columns(
    area: Bounds, unit: float
) -> tuple[rr.ComponentColumnList, rr.ComponentColumnList]:
    """
    Return the lines at whole numbers of metres, below all bodies, and their coordinates.

    :param area: that the camera shows: left, bottom, right, top [m]
    :param unit: length of a unit of the view [m]
    :return: columns of one row each
    """
    left, bottom, right, top = area
    spacing = nice_number(_LEAST * unit)
    # Lines from one labelled line to the next, at 1, 5 or 10 times a power of ten metres.
    step = 2 if spacing / 10.0 ** math.floor(math.log10(spacing)) > 4.0 else 5
    x, y, z = (left + right) / 2, (bottom + top) / 2, -0.1 * unit
    columns = _multiples(x - _ACROSS * unit, x + _ACROSS * unit, spacing)
    rows = _multiples(y - _UP * unit, y + _UP * unit, spacing)
    (x1, x2), (y1, y2) = ((each[0] * spacing, each[-1] * spacing) for each in (columns, rows))
    lines = [((n * spacing, y1, z), (n * spacing, y2, z)) for n in columns]
    lines += [((x1, n * spacing, z), (x2, n * spacing, z)) for n in rows]
    numbers = (*columns, *rows)
    strips = rr.LineStrips3D.columns(
        strips=lines,
        colors=[_FAINT if number % step else _CLEAR for number in numbers],
        # Negative radii are ui points.
        radii=[-0.5 if number else -1.0 for number in numbers],
    )
    # The right edge of the view, where the area is narrower than it.
    edge = x + WIDTH / PIXELS / 2 * unit
    labelled = [
        ((n * spacing, bottom + _ABOVE * unit, z), n)
        for n in columns
        if n % step == 0 and left + _ASIDE * unit < n * spacing < edge - _ASIDE * unit
    ]
    labelled += [
        ((left + _ASIDE * unit, n * spacing + _HALF * unit, z), n)
        for n in rows
        if n % step == 0 and bottom + unit < n * spacing < top - unit
    ]
    points = rr.Points3D.columns(
        positions=[point for point, _ in labelled],
        labels=[f'{number * spacing:g} m' for _, number in labelled],
    )
    return strips.partition([len(lines)]), points.partition([len(labelled)])


def _multiples(low: float, high: float, spacing: float) -> range:
    return range(math.floor(low / spacing), math.ceil(high / spacing) + 1)
