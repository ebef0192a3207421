# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Pictures of world files as SVG: bounds, bodies and joints as they are at the beginning.

Law: a picture has nothing of the file but numbers.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
import math
from pathlib import Path
from typing import Any

import numpy as np
from physsim_ros.appearance import JointGlyphs
from physsim_ros.files import load_world
from physsim_ros.model.checkpoint import BodyState, WorldState
from physsim_ros.model.scene import Scene
from physsim_ros.model.transform import local_to_world, Point
from physsim_ros.sketchpad.server.scene_codec import shape_entry

# Greatest number of bodies and of joints in a picture.
MOST_DRAWN = 2000
# Width to height, and width of a picture [pixels].
_RATIO, _PIXELS = 9 / 5, 240
# Share of the size that stays free on each side.
_MARGIN = 0.04
# Share of its colour that an outline keeps.
_DARKER = 0.6
# Opacity of a sensor.
_SHEER = 0.4
# Half the size of the smallest symbol of a joint [pixels].
_LEAST = 2.0
_INK = '#55585f'


@lru_cache(maxsize=128)
def svg_of_world(path: Path, changed: int) -> str:  # noqa: ARG001 - a key
    """
    Return the picture of a world file.

    :param path: of the file
    :param changed: time of its last change [ns since 1970]
    :raises PhysSimError: it is no world file
    """
    state = load_world(path)
    left, low, right, high = _extent(state)
    width, height = right - left, high - low
    pixel = width / _PIXELS
    size = f'width="{_PIXELS}" height="{_PIXELS / _RATIO:.0f}"'
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size}',
        f' viewBox="{_texts(left, -high, width, height)}">',
        f'<g transform="scale(1 -1)" stroke-width="{_texts(pixel)}" stroke-linejoin="round">',
        *_bounds(state),
        *(line for body in state.bodies[:MOST_DRAWN] for line in _body(body, pixel)),
        *_joints(state, pixel),
        '</g></svg>',
    ]
    return ''.join(parts)


def _texts(*numbers: float) -> str:
    return ' '.join(f'{number:.5g}' for number in numbers)


def _extent(state: WorldState) -> tuple[float, float, float, float]:
    """Return the part of the world that is shown: what its lesson shows, bounds, or bodies [m]."""
    lesson, bounds = state.lesson, state.settings.bounds
    box = (lesson.view if lesson else None) or bounds
    if not box:
        box = _extent_of_bodies(state.bodies)
    left, low, right, high = box
    height = max(high - low, (right - left) / _RATIO) * (1.0 + 2.0 * _MARGIN)
    width, x, y = height * _RATIO, (left + right) / 2, (low + high) / 2
    return x - width / 2, y - height / 2, x + width / 2, y + height / 2


def _extent_of_bodies(bodies: Sequence[BodyState]) -> tuple[float, float, float, float]:
    forms = [(each.body.shape.form, each.pose) for each in bodies]
    discs = [(*local_to_world(form.centroid, pose), form.outer) for form, pose in forms]
    x, y, reach = np.array(discs or [(0.0, 0.0, 1.0)]).T
    return (x - reach).min(), (y - reach).min(), (x + reach).max(), (y + reach).max()


def _bounds(state: WorldState) -> Iterator[str]:
    if state.settings.bounds:
        left, low, right, high = state.settings.bounds
        yield f'<path d="M{_texts(left, low)}H{_texts(right)}V{_texts(high)}H{_texts(left)}Z"'
        yield f' fill="none" stroke="{_INK}"/>'


def _body(state: BodyState, pixel: float) -> Iterator[str]:
    """Yield the elements of a body."""
    x, y, yaw = state.pose
    red, green, blue = (255 * channel for channel in state.body.color[:3])
    fill = f'rgb({red:.0f},{green:.0f},{blue:.0f})'
    line = f'rgb({_DARKER * red:.0f},{_DARKER * green:.0f},{_DARKER * blue:.0f})'
    opacity = _SHEER if state.body.sensor else 1
    yield f'<g transform="translate({_texts(x, y)}) rotate({_texts(math.degrees(yaw))})"'
    yield f' fill="{fill}" stroke="{line}" opacity="{opacity}">'
    yield from _shape(shape_entry(state.body.shape), fill, pixel)
    yield '</g>'


def _shape(shape: dict[str, Any], fill: str, pixel: float) -> Iterator[str]:
    """Yield the elements of a shape, as `shape_entry` has it."""
    match shape['kind']:
        case 'disc':
            x, y = shape.get('center', (0.0, 0.0))
            yield f'<circle cx="{_texts(x)}" cy="{_texts(y)}" r="{_texts(shape["radius"])}"/>'
        case 'polygon':
            yield f'<path d="M{"L".join(_texts(*each) for each in shape["outline"])}Z"/>'
        case 'chain':
            yield _line(shape['points'], max(shape['thickness'], 2 * pixel), fill)
        case 'pieces':
            # Lines between them would be seen.
            yield '<g stroke="none">'
            for piece in shape['pieces']:
                yield from _shape(piece, fill, pixel)
            yield '</g>'


def _line(points: Iterable[Point], width: float, color: str) -> str:
    path = 'L'.join(_texts(*each) for each in points)
    stroke = f'stroke="{color}" stroke-width="{_texts(width)}" stroke-linecap="round"'
    return f'<path d="M{path}" fill="none" {stroke}/>'


def _joints(state: WorldState, pixel: float) -> Iterator[str]:
    """Yield the elements of the joints."""
    bodies = tuple(each.body for each in state.bodies)
    scene = Scene(bodies=bodies, settings=state.settings, joints=state.joints[:MOST_DRAWN])
    glyphs = JointGlyphs(scene, least=_LEAST * pixel)
    poses = np.array([each.pose for each in state.bodies], np.float64).reshape(-1, 3)
    for strip in np.split(glyphs.corners(poses), np.cumsum(glyphs.lengths)[:-1]):
        yield _line(strip.tolist(), pixel, _INK)
