# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The grid under the world: lines at whole numbers of metres, and their coordinates."""

from __future__ import annotations

import math

from physsim_ros.appearance import nice_number
from physsim_ros.model.settings import Bounds
from physsim_ros.view.blueprint import WIDTH
from physsim_ros.view.camera import PIXELS
import rerun as rr

LINES, LABELS = 'world/grid', 'world/grid/metres'
# Least distance of two lines [units].
_LEAST = 0.8
# Lines from one labelled line to the next.
_LABELLED = 5
# Half the width and height of the grid [units]: twice what the camera shows, in narrow views too.
_ACROSS, _UP = 32.0, 26.0
_FAINT, _CLEAR = (228, 229, 224), (203, 205, 200)
# Places of the labels in the margin of the camera [units]: of the upper edges of the labels below,
# over the lower edge of the area; of the middles of the labels at the left, from its left edge.
_ABOVE, _ASIDE = 0.85, 0.55
# Half the height of a label, which hangs below its point [units].
_HALF = 0.27


def grid_columns(
    area: Bounds, unit: float
) -> tuple[list[rr.ComponentColumn], list[rr.ComponentColumn]]:
    """
    Return the lines, below all bodies, and the labels, as columns of one row.

    :param area: that the camera shows: left, bottom, right, top [m]
    :param unit: length of a unit of the view [m]
    """
    left, bottom, right, top = area
    spacing = nice_number(_LEAST * unit)
    x, y = (left + right) / 2, (bottom + top) / 2
    columns = _multiples(x - _ACROSS * unit, x + _ACROSS * unit, spacing)
    rows = _multiples(y - _UP * unit, y + _UP * unit, spacing)
    (x1, x2), (y1, y2) = ((each[0] * spacing, each[-1] * spacing) for each in (columns, rows))
    z = -0.1 * unit
    lines = [((n * spacing, y1, z), (n * spacing, y2, z)) for n in columns]
    lines += [((x1, n * spacing, z), (x2, n * spacing, z)) for n in rows]
    numbers = (*columns, *rows)
    strips = rr.LineStrips3D.columns(
        strips=lines,
        colors=[_FAINT if number % _LABELLED else _CLEAR for number in numbers],
        # Negative radii are ui points.
        radii=[-0.5 if number else -1.0 for number in numbers],
    )
    # The right edge of the view, where the area is narrower than it.
    edge = x + WIDTH / PIXELS / 2 * unit
    labelled = [
        ((n * spacing, bottom + _ABOVE * unit, z), n)
        for n in columns
        if n % _LABELLED == 0 and left + _ASIDE * unit < n * spacing < edge - _ASIDE * unit
    ]
    labelled += [
        ((left + _ASIDE * unit, n * spacing + _HALF * unit, z), n)
        for n in rows
        if n % _LABELLED == 0 and bottom + unit < n * spacing < top - unit
    ]
    points = rr.Points3D.columns(
        positions=[point for point, _ in labelled],
        labels=[f'{number * spacing:g} m' for _, number in labelled],
    )
    return list(strips.partition([len(lines)])), list(points.partition([len(labelled)]))


def _multiples(low: float, high: float, spacing: float) -> range:
    return range(math.floor(low / spacing), math.ceil(high / spacing) + 1)
