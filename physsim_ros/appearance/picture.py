# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A picture of a world, where neither Rerun nor a browser is: bodies as filled shapes."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from physsim_ros.model.arrays import Floats
from physsim_ros.model.colors import Color
from physsim_ros.model.shapes import Capsule, Circle, Convex, Piece
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import ORIGIN, Point, Pose, rotated_each

# Light grey, as the page has it; and the edge of a body.
_PAPER, _EDGE = (246, 247, 249), (46, 52, 64)
# Factor by which a picture is drawn larger, then scaled down: Pillow draws no smooth edges.
_FINE = 2
# Width of a line, and half the width of a cross, in the finished picture [pixels].
_LINE, _CROSS = 2, 5
# Around what is shown, as a share of its width [1]; greatest height by width [1].
_MARGIN, _TALLEST = 0.04, 4.0


def picture_of(
    snapshot: Snapshot,
    width: int,
    *,
    lines: Iterable[tuple[Floats, Color]] = (),
    crosses: Iterable[tuple[Floats, Color]] = (),
) -> NDArray[np.uint8]:
    """
    Return a picture of the bounds of a world, or of all its bodies where it has none.

    :param snapshot: of the world
    :param width: of the picture [pixels]
    :param lines: (k, 2) float64: points of each [m], and its colour
    :param crosses: (2,) float64: place of each [m], and its colour
    :return: (height, width, 3) uint8
    """
    left, bottom, right, top = _area_of(snapshot)
    scale = width / max(right - left, (top - bottom) / _TALLEST)
    height = max(1, round((top - bottom) * scale))
    # A tall world is in the middle.
    corner = (left + right - width / scale) / 2.0, top
    pen = _Pen(width, height, corner, scale)
    for body, (x, y, yaw) in zip(snapshot.scene.bodies, snapshot.poses.tolist(), strict=True):
        for piece in body.shape.form.pieces:
            pen.piece(piece, body.color, (x, y, yaw))
    for points, color in lines:
        pen.line(points, color)
    for place, color in crosses:
        pen.cross(place, color)
    return np.asarray(pen.image.resize((width, height), pen.box))


class _Pen:
    """
    Draws in an image, at places in the world.

    :param width: of the finished picture [pixels]
    :param height: of the same
    :param corner: x, y of its upper left corner [m]
    :param scale: of the finished picture [pixels/m]

    :ivar image: at `_FINE` times the size
    :ivar box: Pillow's name of the filter that scales it down
    """

    def __init__(self, width: int, height: int, corner: Point, scale: float) -> None:
        from PIL import Image, ImageDraw  # noqa: PLC0415 - few programs draw pictures

        self.box = Image.Resampling.BOX
        self.image = Image.new('RGB', (width * _FINE, height * _FINE), _PAPER)
        # Colours are mixed with what is there by their opacity.
        self._draw = ImageDraw.Draw(self.image, 'RGBA')
        self._corner = np.array(corner)
        self._scale = scale * _FINE

    def piece(self, piece: Piece, color: Color, pose: Pose) -> None:
        """Draw a piece of a body, whose colour and pose [m, rad] are given."""
        fill, turned = _rgba(color), partial(self._placed, pose=pose)
        match piece:
            case Circle(center, radius):
                ((x, y),) = turned((center,))
                r = radius * self._scale
                self._draw.ellipse((x - r, y - r, x + r, y + r), fill, _EDGE)
                rim = x + r * math.cos(pose[2]), y - r * math.sin(pose[2])
                self._draw.line((x, y, *rim), _EDGE, _FINE)
            case Convex(vertices):
                self._draw.polygon(turned(vertices), fill, _EDGE)
            case Capsule(start, end, radius):
                r = max(radius * self._scale, 0.5)
                self._draw.line(turned((start, end)), fill, max(1, round(2.0 * r)))
                for x, y in turned((start, end)):
                    self._draw.ellipse((x - r, y - r, x + r, y + r), fill)

    def line(self, points: Floats, color: Color) -> None:
        """Draw a line through points, (k, 2) float64 [m]."""
        self._draw.line(self._placed(points), _rgba(color), _LINE * _FINE, 'curve')

    def cross(self, place: Floats, color: Color) -> None:
        """Draw a cross at a place, (2,) float64 [m]."""
        ((x, y),), arm = self._placed(place), _CROSS * _FINE
        for side in (arm, -arm):
            self._draw.line((x - arm, y - side, x + arm, y + side), _rgba(color), _LINE * _FINE)

    def _placed(self, points: ArrayLike, pose: Pose = ORIGIN) -> list[tuple[float, float]]:
        """Return points of a body as those of the image [pixels]."""
        world = rotated_each(np.array(points, np.float64).reshape(-1, 2), pose[2]) + pose[:2]
        pixels = (world - self._corner) * (self._scale, -self._scale)
        return [(x, y) for x, y in pixels.tolist()]


def _rgba(color: Color) -> tuple[int, int, int, int]:
    red, green, blue, alpha = (round(255 * part) for part in color)
    return red, green, blue, alpha


def _area_of(snapshot: Snapshot) -> tuple[float, float, float, float]:
    """Return left, bottom, right, top of the bounds, or of all bodies, with a margin [m]."""
    if snapshot.scene.settings.bounds is not None:
        left, bottom, right, top = snapshot.scene.settings.bounds
    elif snapshot.scene.bodies:
        extents = snapshot.scene.outer_radii[:, None]
        (left, bottom), (right, top) = (
            (snapshot.centers - extents).min(axis=0).tolist(),
            (snapshot.centers + extents).max(axis=0).tolist(),
        )
    else:
        left, bottom, right, top = -1.0, -1.0, 1.0, 1.0
    margin = _MARGIN * (right - left)
    return left - margin, bottom - margin, right + margin, top + margin
