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
The geometry of bodies in Rerun: flat rectangles, discs and triangles in body frames.

Law: geometry changes only with the scene; positions follow from the poses by array operations.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats, Singles
from physsim_ros.model.colors import Color
from physsim_ros.model.scene import Body, Scene
from physsim_ros.model.settings import Bounds
from physsim_ros.model.shapes import Box, Capsule, Circle, Compound, Convex, Disc, Piece, Polygon
from physsim_ros.model.transform import Point

# A flat rectangle or disc, or a corner of a triangle: x, y [m], yaw [rad] in the body frame; half
# extents [m], 0 of a corner; red, green, blue, alpha, each 0 .. 1.
Element = tuple[float, float, float, float, float, float, float, float, float]
# The elements of one body: (k, 9) float32 of each kind.
Elements = dict[str, Singles]

# Kinds of elements: rectangles, discs, and triangles. Translucent triangles are a kind of their
# own, since opacity is that of a whole mesh.
RECTANGLES = ('boxes', 'marks', 'outlines')
TRIANGLES = ('polygons', 'ghosts')
# Entities of the kinds, for free and for anchored bodies: the latter seldom move.
PLACES = ('world', 'world/anchored')
# Half the thickness of a body, and the depth over which later bodies lie above earlier ones
# [units]: enough for the renderer's depth buffer, too little to be seen from the side.
THICK, DEPTH = 0.01, 0.02
# Half the width of lines [units].
FINE = 0.025
# Factor on the opacity of a sensor.
TRANSLUCENT = 0.4
DARK, LIGHT = (0.08, 0.08, 0.1, 1.0), (1.0, 1.0, 1.0, 1.0)
# Factor of Rerun's shading of a solid seen from above, in linear light (its lighting.wgsl: 0.2 and
# half of a light from (1, 3, 5)). Meshes without normals are not shaded.
LIT = 0.2 + 0.5 * 5 / math.sqrt(35)


class Tracks(NamedTuple):
    """
    Poses of n bodies in f frames: position [m], and cosine and sine of yaw and of half of it.

    Each is (f, n) float32.
    """

    x: Singles
    y: Singles
    cos: Singles
    sin: Singles
    half_cos: Singles
    half_sin: Singles

    @classmethod
    def of(cls, poses: Floats) -> Tracks:
        """Return the tracks of poses, (f, n, 3) float64: x, y [m], yaw [rad]."""
        x, y, half = np.moveaxis(poses, 2, 0)
        cos, sin = np.cos(half / 2), np.sin(half / 2)
        each = (x, y, cos**2 - sin**2, 2 * sin * cos, cos, sin)
        return cls(*(values.astype(np.float32) for values in each))


@dataclass(frozen=True, slots=True)
class Table:
    """
    The elements of one entity.

    :param kind: of RECTANGLES or TRIANGLES, or discs
    :param rows: (k,) intp: rows of their bodies
    :param local_poses: (k, 3) float32: x, y [m], yaw [rad] in the body frame
    :param sizes: (k, 3) float32: half extents [m]
    :param colors: (k, 4) uint8
    :param depth: (k,) float32: z [m]
    """

    kind: str
    rows: NDArray[np.intp]
    local_poses: Singles
    sizes: Singles
    colors: NDArray[np.uint8]
    depth: Singles

    def centers(self, tracks: Tracks) -> Singles:
        """Return the positions of the elements, (f * k, 3) float32 [m]."""
        centers = np.empty((len(tracks.x), len(self.rows), 3), dtype=np.float32)
        centers[..., 0] = tracks.x[:, self.rows]
        centers[..., 1] = tracks.y[:, self.rows]
        centers[..., 2] = self.depth
        x, y = self.local_poses[:, 0], self.local_poses[:, 1]
        if x.any() or y.any():
            cos, sin = tracks.cos[:, self.rows], tracks.sin[:, self.rows]
            centers[..., 0] += cos * x - sin * y
            centers[..., 1] += sin * x + cos * y
        return centers.reshape(-1, 3)

    def quaternions(self, tracks: Tracks) -> Singles:
        """Return the rotations of the elements, (f * k, 4) float32: quaternions x, y, z, w."""
        cos, sin = tracks.half_cos[:, self.rows], tracks.half_sin[:, self.rows]
        rotations = np.zeros((*cos.shape, 4), dtype=np.float32)
        if self.local_poses[:, 2].any():
            own_cos, own_sin = (
                np.cos(self.local_poses[:, 2] / 2),
                np.sin(self.local_poses[:, 2] / 2),
            )
            cos, sin = cos * own_cos - sin * own_sin, sin * own_cos + cos * own_sin
        rotations[..., 2], rotations[..., 3] = sin, cos
        return rotations.reshape(-1, 4)


class BodyGeometry:
    """
    The geometry of the bodies of one scene.

    :param scene: with the bodies
    :param unit: length of a unit of the view [m]
    :param before: the geometry of the scene before; elements of the same bodies are taken from it

    :ivar tables: path of an entity -> its elements, at least one
    """

    def __init__(self, scene: Scene, unit: float, before: BodyGeometry | None = None) -> None:
        self.scene = scene
        self.unit = unit
        known = before.known_elements if before is not None and before.unit == unit else {}
        # By identity; the reference to the body keeps its id from being reused.
        self.known_elements: dict[int, tuple[Body, Elements]] = {}
        parts: defaultdict[tuple[str, str], list[tuple[int, Singles]]] = defaultdict(list)
        for row, body in enumerate(scene.bodies):
            key = id(body)
            _, elements = self.known_elements[key] = known.get(key) or (
                body,
                _elements_of(body, unit),
            )
            place = PLACES[body.anchored]
            for kind, part in elements.items():
                parts[place, kind].append((row, part))
        spacing = DEPTH * unit / max(1, len(scene.bodies))
        self.tables = {
            f'{place}/{kind}': _table(kind, each, thick=THICK * unit, spacing=spacing)
            for (place, kind), each in parts.items()
        }

    def extent(self, tracks: Tracks) -> Bounds:
        """Return left, bottom, right, top [m] of all bodies in a frame; at least one body."""
        low, high = [], []
        for table in self.tables.values():
            reach = table.sizes[:, :2]
            if table.kind in RECTANGLES:
                _, _, sin, cos = table.quaternions(tracks).T[..., None]
                reach = np.abs(cos**2 - sin**2) * reach + np.abs(2 * sin * cos) * reach[:, ::-1]
            centers = table.centers(tracks)[:, :2]
            low.append(centers - reach)
            high.append(centers + reach)
        left, bottom = np.concatenate(low).min(axis=0).tolist()
        right, top = np.concatenate(high).max(axis=0).tolist()
        return left, bottom, right, top


def _table(kind: str, parts: list[tuple[int, Singles]], *, thick: float, spacing: float) -> Table:
    bodies, arrays = zip(*parts, strict=True)
    rows = np.repeat(bodies, [len(each) for each in arrays])
    elements = np.concatenate(arrays)
    depth = rows * spacing
    if kind in TRIANGLES:
        depth += thick
    elif kind in {'marks', 'outlines'}:
        # Above their body, below the next one.
        thick += spacing / 2
    return Table(
        kind=kind,
        rows=rows,
        local_poses=elements[:, :3],
        sizes=np.insert(elements[:, 3:5], 2, thick, axis=1),
        colors=sent_colors(elements[:, 5:], shaded=kind not in TRIANGLES),
        depth=depth.astype(np.float32),
    )


def sent_colors(colors: Singles, *, shaded: bool) -> NDArray[np.uint8]:
    """
    Return the colours to send, so that Rerun displays the given ones despite its shading.

    A colour that is too bright for a shaded solid is darkened; its hue stays.

    :param colors: (k, 4) float32: red, green, blue, alpha, each 0 .. 1
    :param shaded: whether Rerun shades the geometry
    :return: (k, 4) uint8
    """
    # https://www.w3.org/TR/css-color-4/#color-conversion-code: sRGB to linear light and back.
    brightest = 1.055 * LIT ** (1 / 2.4) - 0.055
    peak = colors[:, :3].max(axis=1, keepdims=True, initial=brightest)
    seen = np.column_stack((colors[:, :3] * (brightest / peak), colors[:, 3]))
    if shaded:
        level = seen[:, :3]
        light = np.where(level <= 0.04045, level / 12.92, ((level + 0.055) / 1.055) ** 2.4) / LIT
        seen[:, :3] = np.where(
            light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055
        )
    levels: NDArray[np.uint8] = np.rint(np.clip(seen, 0.0, 1.0) * 255).astype(np.uint8)
    return levels


def _elements_of(body: Body, unit: float) -> Elements:
    """Return the elements of a body."""
    shape, form = body.shape, body.shape.form
    ghost = body.sensor or body.color[3] < 1
    red, green, blue, alpha = body.color
    color = (red, green, blue, alpha * (TRANSLUCENT if body.sensor else 1.0))
    ink = DARK if ghost or 0.3 * red + 0.6 * green + 0.1 * blue > 0.35 else LIGHT
    fine = FINE * unit
    elements: defaultdict[str, list[Element]] = defaultdict(list)
    for piece in form.pieces:
        match piece:
            case Circle((x, y), radius):
                elements['discs'].append((x, y, 0.0, radius, radius, *color))
            case Capsule(start, end, radius):
                elements['boxes'].append(_bar(start, end, radius, color))
                elements['discs'] += ((*at, 0.0, radius, radius, *color) for at in (start, end))
            case Convex(corners) if isinstance(shape, Box | Compound):
                (left, bottom), _, (right, top), _ = corners
                middle = ((left + right) / 2, (bottom + top) / 2)
                size = ((right - left) / 2, (top - bottom) / 2)
                elements['boxes'].append((*middle, 0.0, *size, *color))
            case Convex(corners):
                elements['ghosts' if ghost else 'polygons'] += (
                    (*corner, 0.0, 0.0, 0.0, *color)
                    for second, third in pairwise(corners[1:])
                    for corner in (corners[0], second, third)
                )
    if isinstance(shape, Disc) and not body.anchored:
        width = min(fine, 0.1 * shape.radius)
        elements['marks'].append(_bar((0.0, 0.0), (0.9 * shape.radius, 0.0), width, ink))
    if body.anchored:
        x, y = min(map(_middle, form.pieces), key=lambda at: math.dist(at, form.centroid))
        arm = min(max(0.4 * form.inner, 0.08 * unit), 0.2 * unit)
        for rise in (arm, -arm):
            ends = (x - arm, y - rise), (x + arm, y + rise)
            elements['marks'].append(_bar(*ends, 1.2 * fine, ink))
    if body.sensor or body.kinematic:
        ink = (red, green, blue, 1.0) if body.sensor else ink
        elements['outlines'] += (
            _bar(start, end, fine, ink, overlap=fine)
            for outline in _outlines(body)
            for start, end in pairwise((*outline, outline[0]))
        )
    return {kind: np.array(each, dtype=np.float32) for kind, each in elements.items()}


def _bar(start: Point, end: Point, half: float, color: Color, *, overlap: float = 0.0) -> Element:
    """Return the rectangle along a line, of a half width, longer at each end by `overlap` [m]."""
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
            # 48 sides look round up to a radius of three units.
            angles = np.linspace(0.0, 2 * np.pi, 48, endpoint=False).tolist()
            yield [(x + radius * math.cos(each), y + radius * math.sin(each)) for each in angles]
