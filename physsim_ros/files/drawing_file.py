# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Drawing files: strokes from SVG, as editors write it, and from JSON.

Laws: the strokes are the lines that a browser shows, one for each subpath, in the order of the
file. Corners are samples; between them a pen of constant speed is sampled.
"""

from __future__ import annotations

from dataclasses import dataclass
import json
import math
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import ParseError

import numpy as np
from numpy.typing import NDArray
from physsim_ros.files.resources import files_by_name, is_plain, shipped
from physsim_ros.model.arrays import Floats
from physsim_ros.model.checks import FARTHEST
from physsim_ros.model.errors import PhysSimError
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.model.texts import nearest_name

# Metres for each user unit of SVG: a page of 1600 by 1000 is a world of 16 m by 10 m.
SVG_SCALE = 0.01
# Change of direction above which a point is a corner, not part of a curve [rad].
_CORNER = 0.2
# Least number of samples of a stroke: people draw small figures more slowly.
_FEWEST = 30
# Greatest duration of a stroke [s]: four months.
_LONGEST = 1e7
# Suffixes of drawings.
_SUFFIXES = ('.svg', '.json')


class BadDrawing(PhysSimError):
    """A drawing that cannot be read."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Pace:
    """
    Speed and sample rate of the pen.

    :param speed: along the stroke [m/s]
    :param rate: of samples [Hz]
    """

    speed: float = 4.0
    rate: float = 100.0


def drawings() -> dict[str, Path]:
    """Return the shipped drawings by their plain names."""
    return files_by_name(shipped('drawings'), *_SUFFIXES)


def find_drawing(name: str) -> Path:
    """
    Return the file of a path, or of the plain name of a shipped drawing.

    :raises BadDrawing: there is none
    """
    paths = [Path(name)]
    looked = [str(Path(name).absolute().parent)]
    if is_plain(name):
        paths += [shipped('drawings') / f'{name}{suffix}' for suffix in _SUFFIXES]
        looked.append(str(shipped('drawings')))
    for path in paths:
        if path.is_file():
            return path
    raise BadDrawing(
        f'there is no drawing {name!r} in {" and ".join(looked)}'
        f'{nearest_name(Path(name).stem, drawings())}'
    )


def load_drawing(
    path: Path, *, scale: float | None = None, pace: Pace | None = None
) -> list[Floats]:
    """
    Return the strokes of a drawing.

    :param path: of an SVG file, whose origin is the page's lower left corner, y up; or of JSON, a
        list of strokes, each a list of [x, y] or of [x, y, t], y up
    :param scale: metres for each unit of the file; None is 0.01 for SVG and 1 for JSON
    :param pace: of the pen, for strokes without times
    :return: (n, 3) float64 each: x, y [m] and time from the first sample [s]
    :raises BadDrawing: it cannot be read, or contains no stroke
    """
    try:
        if path.suffix == '.json':
            lines = _from_json(json.loads(path.read_text(encoding='utf-8')))
            unit = 1.0
        else:
            # svgelements is a twentieth of the imports of a node, which draws no file.
            from physsim_ros.files.svg_lines import svg_lines  # noqa: PLC0415

            lines = svg_lines(path)
            unit = SVG_SCALE
    except (OSError, ValueError, ParseError) as error:
        raise BadDrawing(f'cannot read {path}: {error}') from error
    except RecursionError as error:
        raise BadDrawing(f'cannot read {path}: it is nested too deeply, or in itself') from error
    factor = unit if scale is None else scale
    # Infinite coordinates are refused below.
    with np.errstate(over='ignore'):
        sampled = [_sampled(line, factor, pace or Pace()) for line in lines if len(line)]
    strokes = [stroke for stroke in sampled if len(stroke)]
    if not strokes:
        raise BadDrawing(f'{path} contains no stroke')
    if not all((np.abs(stroke[:, 2]) <= _LONGEST).all() for stroke in strokes):
        raise BadDrawing(f'a stroke takes longer than {_LONGEST:g} s')
    return strokes


def _from_json(content: Any) -> list[Floats]:
    """Return (n, 2) or (n, 3) float64 of each stroke: x, y, and time [s] if the file has it."""
    if isinstance(content, dict):
        content = content.get('strokes')
    if not isinstance(content, list):
        raise BadDrawing('the file must contain a list of strokes')
    lines = []
    for number, entry in enumerate(content):
        try:
            line = np.array(entry, dtype=np.float64)
        except (OverflowError, TypeError, ValueError) as error:
            raise BadDrawing(f'stroke {number} is not a list of points') from error
        if line.ndim != 2 or line.shape[1] not in (2, 3) or not np.isfinite(line).all():
            raise BadDrawing(f'stroke {number} must be a list of [x, y] or of [x, y, t]')
        if (line[:, :2] == line[0, :2]).all():
            raise BadDrawing(f'stroke {number} is a single point')
        lines.append(line)
    return lines


def _sampled(line: Floats, scale: float, pace: Pace) -> Floats:
    """Return the samples of the pen along a line: (n, 3) float64: x, y [m], time [s]."""
    points = line[:, :2] * scale
    if not (np.abs(points) <= FARTHEST).all():
        raise BadDrawing(f'a stroke reaches further than {FARTHEST:g} m')
    if line.shape[1] == 3:
        return np.column_stack((points, line[:, 2] - line[0, 2]))
    steps = np.hypot(*np.diff(points, axis=0).T)
    kept = np.concatenate(((True,), steps > 0.0))
    points, steps = points[kept], steps[steps > 0.0]
    if len(points) < 2:
        return np.empty((0, 3))
    reached = np.concatenate(((0.0,), np.cumsum(steps)))
    length = float(reached[-1])
    # Evenly spaced samples and corners together are less than MOST_SAMPLES.
    count = math.ceil(min(length / pace.speed * pace.rate, MOST_SAMPLES // 2))
    count = max(count, _FEWEST)
    corners = reached[_is_corner(points)][: MOST_SAMPLES // 3]
    along = np.union1d(np.linspace(0.0, length, count + 1), corners)
    x = np.interp(along, reached, points[:, 0])
    y = np.interp(along, reached, points[:, 1])
    return np.column_stack((x, y, along / pace.speed))


def _is_corner(points: Floats) -> NDArray[np.bool_]:
    """Return (n,) bool: whether each point of a line is a corner."""
    steps = np.diff(points, axis=0)
    headings = np.arctan2(steps[:, 1], steps[:, 0])
    turns = np.abs((np.diff(headings) + math.pi) % math.tau - math.pi)
    return np.concatenate(((False,), turns > _CORNER, (False,)))
