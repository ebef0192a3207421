# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Limits of clicks, chains and the knife, as in `strokes/test_limits.py` those of strokes.

Every number of drawing beside those of strokes has results on either side of it, or is named
here as one between which results do not differ.
"""

from collections.abc import Callable, Sequence
import math

import numpy as np
from physsim_ros.drawing import DrawingSession, DrawingSettings, SceneQuery, Tool
from physsim_ros.drawing.cut_shape import cut_shape
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import ChangeBody, Request, Spawn
from physsim_ros.model.shapes import Box, Compound, Polygon
from physsim_ros.model.transform import Point
from physsim_ros.simulation.world import World
import pytest

from .constants import another_number, constants, FOLDER
from .strokes.ways import circle
from ..building import spawning

ENDS = [spawning(f'a/{n}', Box(width=1.0, height=1.0), (99.0 * n, 0.0, 0.0)) for n in range(2)]
WHEEL = [spawning('a/0', Box(width=1.0, height=1.0))]


def clicked(bodies: Sequence[Spawn], tool: Tool, *points: Point) -> tuple[Request, ...]:
    """Return the requests of clicks in a world of bodies; none where they are refused."""
    world, session = World(), DrawingSession(DrawingSettings(), tool)
    for body in bodies:
        world.apply(body)
    requests: tuple[Request, ...] = ()
    for point in points:
        try:
            requests = session.click(point, '', world.snapshot()).requests
        except Refusal:
            return ()
    return requests


def links(length: float) -> int:
    """Return the number of links of a chain between two points of the background [m]."""
    requests = clicked((), Tool.CHAIN, (0.0, 0.0), (length, 0.0))
    return sum(isinstance(each, Spawn) for each in requests)


def force(length: float) -> float:
    """Return the force of an arrow of a length [N]."""
    (change,) = clicked(ENDS, Tool.FORCE, (0.0, 0.0), (length, 0.0))
    assert isinstance(change, ChangeBody)
    (applied,) = change.properties.forces or ()
    return math.hypot(*applied.force)


def largest_piece(gap: float) -> float:
    """
    Return the largest area after a cut through the first of two squares with a gap [m²].

    The second one is a piece of its own unless it touches the lesser piece of the first.
    """
    squares = Compound(element=Box(width=1.0, height=1.0), centers=((0.0, 0.0), (1.0 + gap, 0.0)))
    return round(cut_shape(squares, (0.3, -2.0), (0.3, 2.0))[0].form.area, 6)


def sliver_of(width: float) -> int:
    """Return the number of pieces of two squares of 0.5 m, one cut at its edge; 0: refused."""
    squares = Compound(element=Box(width=0.5, height=0.5), centers=((0.0, 0.0), (0.5, 0.0)))
    return pieces_of(squares, 0.25 + width)


def squares_of(count: float) -> int:
    """Return the number of pieces of a row of squares that a cut passes beside; 0: refused."""
    centers = tuple((float(each), 0.0) for each in range(int(count)))
    return pieces_of(Compound(element=Box(width=1.0, height=1.0), centers=centers), -5.0)


def teeth_of(count: float) -> int:
    """Return the number of pieces of a comb with all its teeth cut off; 0: refused."""
    teeth = [
        (4.0 * n + x, y)
        for n in range(int(count) - 1)
        for x, y in ((0.0, 0.0), (1.0, 2.0), (2.0, 2.0), (3.0, 0.0))
    ]
    comb = Polygon(outline=(*teeth, (4.0 * count, -1.0), (0.0, -1.0)))
    try:
        return len(cut_shape(comb, (-5.0, 1.0), (4.0 * count + 5.0, 1.0)))
    except Refusal:
        return 0


def pieces_of(shape: Compound, x: float) -> int:
    """Return the number of pieces of a shape that is cut across; 0 where that is refused."""
    try:
        return len(cut_shape(shape, (x, -2.0), (x, 2.0)))
    except Refusal:
        return 0


def next_name(number: float) -> str:
    """Return the name of the next drawn body where there is one of a number."""
    world = World()
    world.apply(spawning(f'drawn/{int(number)}', Box(width=1.0, height=1.0)))
    return SceneQuery(world.snapshot()).next_body()


def mentions_another(diameter: float) -> bool:
    """Return whether the preview of a circle on a square of 1 m mentions another reading."""
    world, session = World(), DrawingSession(DrawingSettings())
    for body in WHEEL:
        world.apply(body)
    points = circle(0.0, 0.0, diameter / 2)
    samples = np.column_stack((points, np.linspace(0.0, 1.0, len(points))))
    session.stroke(samples, '', world.snapshot())
    return ', or ' in session.preview.label


# The constants of a limit; a function of a measure, values of that on either side, the results.
LIMITS: dict[
    str, tuple[str, Callable[[float], object], tuple[float, float], tuple[object, object]]
] = {
    'radius of a disc of two clicks': (
        'click.SLIP',
        lambda it: len(clicked((), Tool.CIRCLE, (0.0, 0.0), (it, 0.0))), (0.0149, 0.0151), (0, 1),
    ),
    'length of a chain of ten links, and of eleven': (
        'chains._SLENDER', links, (3.1, 3.2), (10, 11),
    ),
    'length of a chain of many links': ('chains.MOST_LINKS', links, (29.8, 36.0), (99, 100)),
    'length of the arrow of a force': ('tools._NEWTONS', force, (1.0, 2.0), (10.0, 20.0)),
    'gap between parts that touch': (
        'separating_axes._TOUCHING', largest_piece, (0.0202, 0.0206), (1.2, 1.0),
    ),
    'width of a sliver that is left out': (
        'cut_shape._SLIVERS', sliver_of, (-4.5e-4, -5.5e-4), (2, 0),
    ),
    'corners of the parts of a solid': ('cut_shape.MOST_CORNERS', squares_of, (500, 501), (1, 0)),
    'pieces of a cut': ('cut_shape.MOST_PIECES', teeth_of, (200, 201), (200, 0)),
    'number of a drawn body': (
        'scene_query._NUMBER_LIMIT', next_name, (10**9 - 1, 10**9), (f'drawn/{10**9}', 'drawn/0'),
    ),
    'diameter of a disc that may be an axle': (
        'session._MENTIONED', mentions_another, (0.55, 0.56), (True, False),
    ),
}  # fmt: skip
# Numbers of points between which results do not differ, rounding, work, and looks.
RESOLUTION = {
    'chains._FINE', 'chains._STEEL', 'separating_axes._AT_ONCE', 'cut_shape._CORNERS',
    'cut_outline.ON_LINE', 'cut_shape._ROUNDING', 'knife._SAME_AREA', 'gesture._SIDES',
}  # fmt: skip
# Those of the geometry are tested with the strokes.
CONSTANTS = constants(set(FOLDER.glob('*.py')) - {FOLDER / 'geometry.py'})
DECIDED = sorted({name for needed, *_ in LIMITS.values() for name in needed.split()})


def test_every_number_has_results_on_either_side_or_is_named() -> None:
    assert CONSTANTS.keys() == {*DECIDED} | RESOLUTION
    assert not {*DECIDED} & RESOLUTION


@pytest.mark.parametrize(
    ('result', 'values', 'results'), [each[1:] for each in LIMITS.values()], ids=LIMITS
)
def test_a_result_ends_at_its_limit(
    result: Callable[[float], object],
    values: tuple[float, float],
    results: tuple[object, object],
) -> None:
    assert tuple(map(result, values)) == pytest.approx(results)


@pytest.mark.slow
@pytest.mark.parametrize('factor', [1.3, 1 / 1.3])
@pytest.mark.parametrize('constant', DECIDED)
def test_another_number_moves_a_limit(constant: str, factor: float) -> None:
    with another_number(__name__, CONSTANTS[constant], factor) as tests:
        assert not all(
            tuple(map(result, values)) == pytest.approx(results)
            for needed, result, values, results in tests.LIMITS.values()
            if constant in needed.split()
        )
