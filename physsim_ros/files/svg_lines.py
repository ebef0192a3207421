# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The lines of an SVG file, one for each subpath, in the order of the file.

Not here: the samples of a pen along them (`drawing_file`).
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from physsim_ros.model.arrays import Floats
from svgelements import Curve, Matrix, Shape, SVG
from svgelements import Path as SvgPath

# Line segments that approximate a Bézier curve or an arc before it is sampled.
_SEGMENTS = 64
# Raised by svgelements 1.9 at malformed elements and attributes, instead of an error of its own.
_SVG_ERRORS = (ArithmeticError, AttributeError, LookupError, TypeError)


def svg_lines(path: Path) -> list[Floats]:
    """
    Return (n, 2) float64 of each subpath: x, y [user units of the page], y up.

    :raises ValueError: the file is no SVG, or an element is malformed
    """
    try:
        page = SVG.parse(str(path))
        if not isinstance(page, SVG):
            raise ValueError('it is not an SVG file')  # noqa: TRY004 - a fault of the file
        return _subpaths(page)
    except _SVG_ERRORS as error:
        raise ValueError('an element is malformed') from error


def _subpaths(page: SVG) -> list[Floats]:
    # svgelements scales user units to pixels where the page has a size; this is the inverse.
    to_units = ~Matrix(page.viewbox_transform)
    left, bottom = 0.0, 0.0
    if page.viewbox is not None:
        left, bottom = page.viewbox.x, page.viewbox.y + page.viewbox.height
    elif 'height' in page.values['attributes']:
        bottom = page.height
    lines = []
    for element in page.elements():
        if isinstance(element, Shape):
            whole = abs(SvgPath(element) * to_units)
            for subpath in whole.as_subpaths():
                points = np.array(list(_vertices(subpath)), dtype=np.float64).reshape(-1, 2)
                lines.append(np.column_stack((points[:, 0] - left, bottom - points[:, 1])))
    return lines


def _vertices(subpath: Iterable[Any]) -> Iterable[tuple[float, float]]:
    """Yield the ends of the segments of a subpath, and points along its curves."""
    for segment in subpath:
        if isinstance(segment, Curve):
            for number in range(1, _SEGMENTS):
                point = segment.point(number / _SEGMENTS)
                yield point.x, point.y
        # A close command without a line has no end.
        if segment.end is not None:
            yield segment.end.x, segment.end.y
