# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Work-precision diagrams: the error of each engine over its cost, at all of its rates.

Both axes are logarithmic (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I,
section II.10): the lower left is best. There is a panel for each scene.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import math
from typing import NamedTuple
from xml.etree import ElementTree as ET

# Size of a panel, of the space around its axes, and number of panels in a row [pixels].
WIDTH, HEIGHT, MARGIN, COLUMNS = 300, 220, 36, 3
# Least error that is told apart, as a share of the one allowed.
SHOWN = 1e-4
# Of the engines, in their order (Okabe and Ito, colours that all people tell apart).
COLOURS = '#0072b2', '#d55e00', '#009e73', '#cc79a7'


class Point(NamedTuple):
    """
    A run of an engine.

    :ivar cost: processor time for a second of simulation [ms]
    :ivar error: of the scene, in its own unit
    """

    cost: float
    error: float


class Panel(NamedTuple):
    """
    A scene.

    :ivar title: of it
    :ivar allowed: greatest error
    :ivar curves: the runs of each engine, by its name
    """

    title: str
    allowed: float
    curves: Mapping[str, Sequence[Point]]


class _Axis:
    """
    A logarithmic axis over whole decades.

    :param values: that it has room for
    :param begin: where its lower end is [pixels]
    :param end: where its upper end is [pixels]
    """

    def __init__(self, values: Sequence[float], begin: float, end: float) -> None:
        self._low = math.floor(math.log10(min(values)))
        self._high = max(self._low + 1, math.ceil(math.log10(max(values))))
        self._begin, self._end = begin, end

    def place(self, value: float) -> float:
        """Return where a value is [pixels]; one that is too small is at the lower end."""
        decades = math.log10(max(value, 10.0**self._low)) - self._low
        share = decades / (self._high - self._low)
        return self._begin + share * (self._end - self._begin)

    @property
    def decades(self) -> list[float]:
        """Return the powers of ten on the axis."""
        return [10.0**power for power in range(self._low, self._high + 1)]


def picture(panels: Sequence[Panel]) -> str:
    """Return the diagrams of some scenes, an SVG."""
    rows = -(-len(panels) // COLUMNS)
    width, height = COLUMNS * WIDTH, rows * HEIGHT + MARGIN
    svg = ET.Element(
        'svg',
        {'xmlns': 'http://www.w3.org/2000/svg', 'viewBox': f'0 0 {width} {height}'},
        width=str(width),
        height=str(height),
    )
    svg.set('font-family', 'sans-serif')
    svg.set('font-size', '10')
    ET.SubElement(svg, 'rect', width='100%', height='100%', fill='white')
    for number, panel in enumerate(panels):
        row, column = divmod(number, COLUMNS)
        corner = f'translate({column * WIDTH} {row * HEIGHT})'
        _draw(ET.SubElement(svg, 'g', transform=corner), panel)
    names = list(panels[0].curves) if panels else []
    for number, name in enumerate(names):
        x, y = MARGIN + 110 * number, height - MARGIN / 2
        ET.SubElement(svg, 'circle', cx=f'{x}', cy=f'{y - 3}', r='3', fill=_colour(number))
        _write(svg, name, x + 8, y)
    told = 'error (m, or a share) over processor time for a simulated second [ms]; dashed: allowed'
    _write(svg, told, MARGIN + 110 * len(names), height - MARGIN / 2)
    return ET.tostring(svg, encoding='unicode')


def _draw(group: ET.Element, panel: Panel) -> None:
    """Draw a panel."""
    curves = {
        name: [each for each in points if math.isfinite(each.error)]
        for name, points in panel.curves.items()
    }
    points = [each for curve in curves.values() for each in curve]
    # Smaller errors, of rounding too, are drawn on the lower edge.
    least = panel.allowed * SHOWN
    errors = [max(each.error, least) for each in points] + [panel.allowed]
    x = _Axis([each.cost for each in points] or [1.0], MARGIN, WIDTH - 10)
    y = _Axis(errors, HEIGHT - MARGIN, MARGIN)
    _write(group, panel.title, MARGIN, MARGIN - 8)
    for value in x.decades:
        _line(group, (x.place(value), MARGIN), (x.place(value), HEIGHT - MARGIN), '#ddd')
        _write(group, f'{value:g}', x.place(value) - 6, HEIGHT - MARGIN + 12)
    for value in y.decades:
        _line(group, (MARGIN, y.place(value)), (WIDTH - 10, y.place(value)), '#ddd')
        _write(group, f'{value:.0e}', 2, y.place(value) + 3)
    limit = y.place(panel.allowed)
    _line(group, (MARGIN, limit), (WIDTH - 10, limit), '#666').set('stroke-dasharray', '4 3')
    for number, curve in enumerate(curves.values()):
        places = [(x.place(each.cost), y.place(each.error)) for each in curve]
        path = ' '.join(f'{across:.1f},{up:.1f}' for across, up in places)
        colour = _colour(number)
        ET.SubElement(group, 'polyline', points=path, fill='none', stroke=colour)
        for across, up in places:
            dot = {'cx': f'{across:.1f}', 'cy': f'{up:.1f}', 'r': '2.5', 'fill': colour}
            ET.SubElement(group, 'circle', dot)


def _colour(number: int) -> str:
    return COLOURS[number % len(COLOURS)]


def _write(group: ET.Element, text: str, x: float, y: float) -> None:
    ET.SubElement(group, 'text', x=f'{x:.1f}', y=f'{y:.1f}').text = text


def _line(
    group: ET.Element, begin: tuple[float, float], end: tuple[float, float], colour: str
) -> ET.Element:
    ends = dict(
        zip(('x1', 'y1', 'x2', 'y2'), (f'{each:.1f}' for each in begin + end), strict=True)
    )
    return ET.SubElement(group, 'line', ends, stroke=colour)
