# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A picture of a world, where neither Rerun nor a browser is: bodies as filled shapes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats
from physsim_ros.model.shapes import Capsule, Circle, Convex
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import rotated_each
from PIL import Image, ImageDraw

# Light grey, as the page has it; and the edge of a body.
_PAPER, _EDGE = (246, 247, 249), (46, 52, 64)
# Drawn at so many times the size, and scaled down: Pillow draws no smooth edges.
_FINE = 2
# Around what is shown, as a share of its width [1]; greatest height by width [1].
_MARGIN, _TALLEST = 0.04, 4.0


def picture_of(
    snapshot: Snapshot, width: int, *, area: tuple[float, float, float, float] | None = None
) -> NDArray[np.uint8]:
    """
    Return a picture, (height, width, 3) uint8.

    :param snapshot: of the world
    :param width: of the picture [pixels]
    :param area: left, bottom, right, top of what is shown [m]; None is the bounds of the world, or
        all bodies where it has none
    """
    left, bottom, right, top = area or _area_of(snapshot)
    scale = width / (right - left)
    height = max(1, round(min((top - bottom) * scale, _TALLEST * width)))
    image = Image.new('RGB', (width * _FINE, height * _FINE), _PAPER)
    draw = ImageDraw.Draw(image)
    fine = scale * _FINE
    corner = np.array((left, top))
    turned = np.array((fine, -fine))
    for body, (x, y, yaw) in zip(snapshot.scene.bodies, snapshot.poses.tolist(), strict=True):
        color = tuple(round(255 * part) for part in body.color[:3])
        origin = np.array((x, y))

        def placed(points: object, origin: Floats = origin, yaw: float = yaw) -> Floats:
            """Return points of the body in the picture, (k, 2) float64 [pixels]."""
            world = rotated_each(np.array(points, np.float64).reshape(-1, 2), yaw) + origin
            pixels: Floats = (world - corner) * turned
            return pixels

        for piece in body.shape.form.pieces:
            match piece:
                case Circle(center, radius):
                    ((px, py),) = placed(center)
                    r = radius * fine
                    draw.ellipse((px - r, py - r, px + r, py + r), fill=color, outline=_EDGE)
                    rim = px + r * math.cos(yaw), py - r * math.sin(yaw)
                    draw.line((px, py, *rim), fill=_EDGE, width=_FINE)
                case Convex(vertices):
                    draw.polygon([*map(tuple, placed(vertices).tolist())], color, _EDGE)
                case Capsule(start, end, radius):
                    ends = [*map(tuple, placed((start, end)).tolist())]
                    r = max(radius * fine, 0.5)
                    draw.line(ends, fill=color, width=max(1, round(2.0 * r)))
                    for px, py in ends:
                        draw.ellipse((px - r, py - r, px + r, py + r), fill=color)
    return np.asarray(image.resize((width, height), Image.Resampling.BOX))


def _area_of(snapshot: Snapshot) -> tuple[float, float, float, float]:
    """Return left, bottom, right, top of the bounds, or of all bodies, with a margin [m]."""
    if snapshot.scene.settings.bounds is not None:
        left, bottom, right, top = snapshot.scene.settings.bounds
    elif snapshot.scene.bodies:
        extents = np.array([[body.shape.form.outer] for body in snapshot.scene.bodies])
        (left, bottom), (right, top) = (
            (snapshot.centers - extents).min(axis=0).tolist(),
            (snapshot.centers + extents).max(axis=0).tolist(),
        )
    else:
        left, bottom, right, top = -1.0, -1.0, 1.0, 1.0
    margin = _MARGIN * (right - left)
    return left - margin, bottom - margin, right + margin, top + margin
