# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Drawings: JSON with strokes of a pen, in the order in which they are drawn.

`{"about": "...", "strokes": [{"name": "rod", "points": [[8, 7.98], [10.6, 3.4]]}, ...]}`

Laws: each point of a drawing is a sample of its stroke. A drawing is read, or refused as
`BadDrawing`, whatever it holds.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from physsim_ros.files.regular_file import read_file
from physsim_ros.files.resources import files_by_name, is_plain, shipped
from physsim_ros.model.arrays import Floats
from physsim_ros.model.checks import FARTHEST
from physsim_ros.model.errors import Refusal
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.model.texts import abbreviated, nearest_name

# Greatest size of a drawing file [bytes]: 200 times that of the largest shipped one.
_MOST_BYTES = 2**20
# Greatest number of strokes of a drawing [1]: the largest shipped one has 14.
MOST_STROKES = 1_000


class BadDrawing(Refusal):
    """A drawing file that cannot be read, or whose content is no drawing."""

    code = 'bad_drawing'


def drawings() -> tuple[str, ...]:
    """Return the plain names of the shipped drawings."""
    return tuple(files_by_name(shipped('drawings'), '.json'))


def load_drawing(drawing: str) -> list[tuple[str, Floats]]:
    """
    Return the strokes of a drawing in order, each with its name.

    :param drawing: path of a JSON file, or the plain name of a shipped drawing
    :return: name, '' if it has none, and (n, 3) float64: x, y [m], time [s], which is 0
    :raises BadDrawing: the file cannot be read, or its content is no drawing
    """
    plain = is_plain(drawing)
    path = shipped('drawings') / f'{drawing}.json' if plain else Path(drawing)
    try:
        content = json.loads(read_file(path, _MOST_BYTES))
    except (OSError, ValueError, RecursionError) as error:
        near = nearest_name(drawing, drawings()) if plain else ''
        template = 'cannot read {file}: {reason}{near}'
        raise BadDrawing(template, file=path, reason=str(error), near=near) from error
    strokes = content.get('strokes') if isinstance(content, dict) else None
    if not isinstance(strokes, list) or not 1 <= len(strokes) <= MOST_STROKES:
        template = '{field} must be a list of 1 to {most} strokes'
        raise BadDrawing(template, field='strokes', most=MOST_STROKES)
    return [_stroke(entry, f'strokes[{number}]') for number, entry in enumerate(strokes)]


def _stroke(entry: Any, field: str) -> tuple[str, Floats]:
    if not isinstance(entry, dict):
        raise BadDrawing('{field} must be a mapping with points', field=field)
    name, points = entry.get('name', ''), entry.get('points')
    if not isinstance(name, str):
        raise BadDrawing('{field} must be text', field=f'{field}.name')
    if not isinstance(points, list) or not 2 <= len(points) <= MOST_SAMPLES:
        template = '{field} must be a list of 2 to {most} points'
        raise BadDrawing(template, field=f'{field}.points', most=MOST_SAMPLES)
    for number, point in enumerate(points):
        if not _is_point(point):
            each = f'{field}.points[{number}]'
            raise BadDrawing(
                '{field} must be [x, y], each within {most:g} m', field=each, most=FARTHEST
            )
    return abbreviated(name), np.array([(x, y, 0.0) for x, y in points], dtype=np.float64)


def _is_point(point: Any) -> bool:
    # NaN is not less than anything, and a boolean is no number here.
    return (
        isinstance(point, list)
        and len(point) == 2
        and all(type(number) in {int, float} and abs(number) <= FARTHEST for number in point)
    )
