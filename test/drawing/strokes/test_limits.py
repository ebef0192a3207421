# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Limits of readings: a stroke a little below a limit has another meaning than one above it.

Every number by which strokes are read has such strokes, or a limit of an earlier stage, is in the
table of evidence, or is named here as one between which readings do not differ.
"""

from collections.abc import Callable, Sequence
from functools import partial
import itertools
import math

import numpy as np
from physsim_ros.drawing import (
    DrawingSession,
    DrawingSettings,
    Reading,
    SceneQuery,
    submit_reading,
)
from physsim_ros.drawing.geometry import path_length, unit_vector
from physsim_ros.drawing.strokes.choice import group_confidence
from physsim_ros.drawing.strokes.features import features_of
from physsim_ros.drawing.strokes.forms import classification_of
from physsim_ros.drawing.strokes.joining import joined_arrow
from physsim_ros.drawing.strokes.plain_forms import fits_of
from physsim_ros.drawing.strokes.signs.arrow import ARROW
from physsim_ros.drawing.strokes.signs.swings import SCRIBBLE
from physsim_ros.drawing.strokes.signs.x import CROSS, of_lines
from physsim_ros.drawing.strokes.stages import POLYGON, Sign
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Refusal
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import ChangeBody, Delete, Join, Spawn
from physsim_ros.model.shapes import Box, Chain, Disc, Polygon
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
import pytest

from .ways import ANGLE, circle, cross, scribble, square, Way
from ..constants import another_number, constants, FOLDER
from ..single_stroke import interpret_stroke
from ...building import spawning

SHARE = np.linspace(0.0, 1.0, 60)
PLATE = [spawning('a/0', Box(width=1.0, height=1.0))]
# Sides of a square of the area of a plank [m].
SIDE = math.sqrt(2.0)
OVERLAPPING, BESIDE = (
    [spawning(f'a/{n}', Box(width=2.0, height=1.0), (apart * n, 0.0, 0.0)) for n in range(2)]
    for apart in (1.4, 2.1)
)
APART = [spawning(f'a/{n}', Disc(radius=0.3), (4.0 * n, 0.0, 0.0)) for n in range(2)]
WHEEL = [
    spawning('wheel/0', Disc(radius=0.5), (2.0, -0.5, 0.0), anchored=True),
    *(spawning(f'a/{n}', Disc(radius=0.3), (4.0 * n, -0.84, 0.0)) for n in range(2)),
]
# A disc that turns about an axle, which the background holds.
TURNING = [
    spawning('a/0', Disc(radius=0.3)),
    Join(name='axle/0', kind=JointKind.AXLE, points=((0.0, 0.0),), a='a/0', b=WORLD),
]
ON_FLOOR = [
    spawning('floor/0', Box(width=20.0, height=2.0), (0.0, -1.0, 0.0)),
    spawning('a/0', Box(width=1.0, height=1.0), (0.0, 0.5, 0.0)),
]


STANDING = [spawning('a/0', Disc(radius=0.5))]
NEAR = [spawning(f'a/{n}', Box(width=1.0, height=1.0), (2.0 * n, 0.0, 0.0)) for n in range(2)]
LOOSE = [spawning(f'a/{n}', Disc(radius=0.3), (2.0 * n, 0.0, 0.0)) for n in range(2)]
ROUND = 2.0 * math.pi * SHARE


def bow(straightness: float) -> Floats:
    """Return an arc from (0, 0) to (4, 0) whose chord is a share of its length."""
    halves = np.linspace(0.01, 1.5, 500)
    half = float(np.interp(-straightness, -np.sin(halves) / halves, halves))
    angle, radius = half * (2.0 * SHARE - 1.0), 2.0 / math.sin(half)
    height = radius * (np.cos(angle) - math.cos(half))
    return np.column_stack((2.0 + radius * np.sin(angle), -height))


def over_wheel(bend: float) -> Way:
    """Return a rope from x = 0 to x = 4 that is bent by an angle at (2, 0) [rad]."""
    low = -2.0 * math.tan(bend / 2)
    return [(0.0, low), (2.0, 0.0), (4.0, low)]


def looped(radius: float) -> Floats:
    """Return a line of 4 m with a round loop in its middle [m]."""
    loop = radius * np.column_stack((np.sin(ROUND), 1.0 - np.cos(ROUND)))[1:-1]
    lines = (np.column_stack((SHARE * 2.0 - start, 0.0 * SHARE)) for start in (2.0, 0.0))
    return np.vstack((next(lines), loop, next(lines)))


def spiral(shrinking: float) -> Floats:
    """Return two rounds of a circle, the radius of which shrinks by a share."""
    rounds = np.column_stack((np.cos(2.0 * ROUND), np.sin(2.0 * ROUND)))
    return rounds * (1.0 - shrinking * SHARE)[:, None]


def bean(dent: float) -> Floats:
    """Return an oval with a dent, in shares of its radius."""
    radius = 1.0 - dent * np.exp(-(((ROUND - math.pi) / 0.5) ** 2))
    return np.column_stack((1.3 * radius * np.cos(ROUND), radius * np.sin(ROUND)))


def squircle(power: float) -> Floats:
    """Return a curve between a circle (1) and a square (0), of powers of cosine and sine."""
    x, y = (np.sign(each) * np.abs(each) ** power for each in (np.cos(ROUND), np.sin(ROUND)))
    return np.column_stack((x, y))


def teeth(count: float, half: float, start: float = 0.0, end: float = 2.0) -> Way:
    """Return a zigzag along the axis x, of lines to and fro across it."""
    step, last = (end - start) / count, int(count)
    return [(start + step * n, half * (-1) ** n if 0 < n < last else 0.0) for n in range(last + 1)]


def down(angle: float, depth: float, radius: float = 0.5) -> Way:
    """Return a line that ends within a disc, at its lower side."""
    x, y = math.sin(angle), -math.cos(angle)
    return [(6.0 * radius * x, 6.0 * radius * y), ((radius - depth) * x, (radius - depth) * y)]


WHEEL_TOP = spawning('a/1', Disc(radius=0.5))


class Corners(list[tuple[float, float]]):
    """The samples of a stroke that a program sends by its corners alone."""


def ring(count: int, width: float = 1.0, height: float = 1.0) -> tuple[tuple[float, float], ...]:
    """Return points on an ellipse."""
    angles = [2.0 * math.pi * n / count for n in range(count)]
    return tuple((width * math.cos(each), height * math.sin(each)) for each in angles)


def gear(depth: float) -> Floats:
    """Return a gear of eight teeth, as deep as a share of the radius of its root."""
    return np.array([*ring(16), (1.0, 0.0)]) * (1.0 + depth * (np.arange(17) % 2))[:, None]


def bowed(corners: Sequence[tuple[float, float]], bow: float) -> Floats:
    """Return a closed polyline about the origin whose sides are bowed outwards by a share."""
    points = np.array((*corners, corners[0]))
    sides = [a + SHARE[:, None] * (b - a) for a, b in itertools.pairwise(points)]
    return np.vstack([side * (1.0 + 4.0 * bow * SHARE * (1.0 - SHARE))[:, None] for side in sides])


def bowed_plank(bow: float) -> Floats:
    """Return a plank of 5.3 m by 0.2 m that is bowed as a whole by a height [m]."""
    corners = np.array([(0.0, 0.0), (5.3, 0.0), (5.3, 0.2), (0.0, 0.2), (0.0, 0.0)])
    plank = np.vstack([a + SHARE[:-1, None] * (b - a) for a, b in itertools.pairwise(corners)])
    x = np.append(plank[:, 0], 0.0)
    return np.column_stack((x, np.append(plank[:, 1], 0.0) + bow * x * (5.3 - x) / 7.0))


def narrow_loop(width: float) -> Floats:
    """Return a line of 4 m with a loop of a half width, as high as 1 m, in its middle [m]."""
    loop = np.column_stack((width * np.sin(ROUND), 0.5 * (1.0 - np.cos(ROUND))))[1:-1]
    first, last = (np.column_stack((2.0 * SHARE - start, 0.0 * SHARE)) for start in (2.0, 0.0))
    return np.vstack((first, loop, last))


def resting(radius: float) -> Corners:
    """Return a line of 3 m on which the pen rests, and jitters by a radius [m]."""
    line = [(n / 20, 0.0) for n in range(60)]
    rest = [(radius * math.cos(2.4 * n), radius * math.sin(2.4 * n)) for n in range(200)]
    return Corners([*line[:30], *((1.5 + x, y) for x, y in rest), *line[31:]])


def roofs(height: float) -> Way:
    """Return a square with a roof on two opposite sides, of a height [m]."""
    return [(0, 0), (2, -height), (4, 0), (4, 2), (2, 2 + height), (0, 2), (0, 0)]


def bent_late(aside: float) -> Floats:
    """Return an arrow whose shaft of 3 m bends after 60 % of its length, by a distance [m]."""
    shaft = np.column_stack((3.0 * SHARE, aside * np.maximum(SHARE - 0.6, 0.0) ** 2 / 0.16))
    return with_barbs(shaft, 0.7, 0.6, (1.0, -1.0), 15)


def one_barb(angle: float) -> Floats:
    """Return an arc of four radians about the origin, with one barb at an angle [rad]."""
    turn = np.linspace(-1.0, 3.0, 60)
    return with_barbs(np.column_stack((np.cos(turn), np.sin(turn))), 0.4, angle, (1.0,), 12)


def with_barbs(
    shaft: Floats, length: float, angle: float, sides: Sequence[float], count: int
) -> Floats:
    """Return a shaft and its barbs, of a length [m], an angle [rad] and a number of samples."""
    (x, y), tip = shaft[-1] - shaft[-4], shaft[-1]
    ends = [tip - length * unit_vector(math.atan2(y, x) + side * angle) for side in sides]
    barbs = [np.linspace(a, b, count) for end in ends for a, b in ((tip, end), (end, tip))]
    return np.vstack((shaft, *barbs[:-1]))


def bumped(share: float) -> Way:
    """Return an arrow with a bump as high as its barbs in its shaft of 3 m, at a share of that."""
    x, y = 3.0 - 0.6 * math.cos(0.6), 0.6 * math.sin(0.6)
    bump = [(3.0 * share - 0.12, 0.0), (3.0 * share, 0.5), (3.0 * share + 0.12, 0.0)]
    return [(0.0, 0.0), *bump, (3.0, 0.0), (x, y), (3.0, 0.0), (x, -y)]


def aside(shift: float) -> list[Way]:
    """Return the sides of a square of 0.6 m, two of them moved outwards by a share of it."""
    out = 0.6 * shift
    return [
        [(0.0, 0.0), (0.6, 0.0)],
        [(0.6 + out, 0.0), (0.6 + out, 0.6)],
        [(0.6, 0.6), (0.0, 0.6)],
        [(-out, 0.6), (-out, 0.0)],
    ]


def loose(length: float, count: int = 7) -> Way:
    """Return a number of lines to and fro, 1.2 m high, along the axis x [m]."""
    return [(length * (n / count - 0.5), 1.2 * (n % 2 - 0.5)) for n in range(count + 1)]


def arrow(bow: float = 0.0, barb: float = 0.9, shaft: float = 3.0) -> list[Way | Floats]:
    """Return a shaft that is bowed by a height, and a head of barbs of a length [m]."""
    along = np.column_stack((shaft * SHARE, 4.0 * bow * SHARE * (1.0 - SHARE)))
    x, y = barb * math.cos(0.6), barb * math.sin(0.6)
    return [along, [(shaft - x, y), (shaft, 0.0), (shaft - x, -y)]]


# The constants of a limit; bodies, maybe of a measure, a stroke of the measure, values of it on
# either side of the limit, the readings.
LIMITS: dict[
    str,
    tuple[
        str,
        Sequence[Spawn | Join] | Callable[[float], Sequence[Spawn]],
        Callable[[float], Way | Floats],
        tuple[float, float],
        tuple[str, str],
    ],
] = {
    'diameter of an axle on one body': (
        'closed_shapes._LARGEST closed_shapes._SMALL',
        PLATE, lambda it: circle(0.0, 0.0, it / 2), (0.45, 0.55), ('axle world', 'disc'),
    ),
    'diameter of an axle on two bodies': (
        'closed_shapes._LARGEST_ON_TWO',
        OVERLAPPING, lambda it: circle(0.7, 0.0, it * SIDE / 2), (0.67, 0.83),
        ('axle', 'disc'),
    ),
    'side of a weld over a gap': (
        '',
        BESIDE, lambda it: square(1.05, 0.0, it * SIDE / 2), (0.45, 0.55),
        ('pin', 'rectangle'),
    ),
    'straightness of a line between bodies': (
        'open_lines._STRAIGHT',
        APART, bow, (0.9, 0.98), ('rope', 'rod'),
    ),
    'bend of a rope on a wheel': (
        'bodies_under._BEND',
        WHEEL, over_wheel,
        (math.radians(41), math.radians(50)), ('rope', 'rope wheel/0'),
    ),
    'share of a scribble on a body that it covers': (
        'bodies_under._COVERING',
        ON_FLOOR, lambda it: scribble(0.0, 0.6 - 1.2 * it, 1.3, 1.2), (0.27, 0.33),
        ('deletion a/0', 'deletion floor/0 a/0'),
    ),
    'distance of the crossing of an x from a thin body': (
        'x._INNER',
        [spawning('a/0', Box(width=4.0, height=0.05))], lambda it: cross(0.0, it, 0.8),
        (0.41, 0.44), ('anchor', ''),
    ),
    'distance of the tail of an arrow from a body': (
        '',
        PLATE, lambda it: [(0.5 + it, 0), (3, 0), (2.5, 0.3), (3, 0), (2.5, -0.3)],
        (0.13, 0.17), ('velocity', 'gravity'),
    ),
    'aspect of a circle': (
        'plain_forms._CIRCULAR',
        [], lambda it: np.column_stack((np.cos(ANGLE), it * np.sin(ANGLE))),
        (0.53, 0.63), ('polygon', 'disc'),
    ),
    'corners of an axle': (
        '',
        [spawning('a/0', Box(width=6.0, height=4.0))],
        lambda it: np.array(
            [(0.3 * math.cos(a), 0.3 * math.sin(a)) for a in np.linspace(0.4, 6.7, int(it) + 1)]
        ).tolist(),
        (4, 5), ('rectangle', 'axle world'),
    ),
    'overhang of an axle over a second body': (
        'axles._ACROSS',
        [spawning(f'a/{n}', Box(width=3.0, height=3.0), (3.0 * n, 0.0, 0.0)) for n in range(2)],
        lambda it: circle(1.5 - it, 0.0, 0.3), (0.219, 0.223), ('axle', 'axle world'),
    ),
    'gap of a circle': (
        'plain_forms._OPEN',
        [], lambda it: np.column_stack((np.cos(ROUND * it), np.sin(ROUND * it))),
        (0.8, 0.85), ('wall', 'disc'),
    ),
    'gap in a side of a square': (
        'plain_forms._OPEN',
        [], lambda it: [(it, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (0.0, 0.0)],
        (1.1, 1.4), ('rectangle', 'wall'),
    ),
    'gap in a side of a square that is neither closed nor open': (
        'evidence._SOFT',
        [], lambda it: [(it, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (0.0, 0.0)],
        (1.234, 1.238), ('', 'wall'),
    ),
    'shrinking of a circle that is drawn twice': (
        '', [], spiral, (0.345, 0.352), ('disc', ''),
    ),
    'shrinking of a spiral that has an outer boundary': (
        'outer_boundary._LEAST_LENGTH', [], spiral, (0.8749, 0.8838), ('', 'polygon'),
    ),
    'radius of a loop of a line': (
        'plain_forms._LOOP', [], looped, (0.1142, 0.1158), ('wall', '')),
    'dent of a bean': (
        '', [], bean, (0.7, 0.75), ('disc', 'polygon')),
    'roundness of a square': (
        '', [], squircle, (0.56, 0.61),
        ('rectangle', 'disc'),
    ),
    'slant of a trapezoid': (
        '',
        [], lambda it: [(0.0, 0.0), (2.0, 0.0), (2.0 - it, 1.0), (it, 1.0), (0.0, 0.0)],
        (0.38, 0.43), ('rectangle', 'polygon'),
    ),
    'swings of a scribble': (
        'swings._FEWEST_OF_SCRIBBLE',
        PLATE,
        lambda it: [(1.3 * (n / it - 0.5), 1.2 * (n % 2 - 0.5)) for n in range(int(it) + 1)],
        (5, 6), ('wall', 'deletion a/0'),
    ),
    'lines of a zigzag between bodies': (
        'features.FEWEST_SWINGS',
        APART, lambda it: teeth(it, 0.3, end=4.0), (3, 4), ('rope', 'spring'),
    ),
    'height of swings between bodies': (
        '',
        LOOSE, lambda it: [(n / 10, it * (n % 2 - 0.5)) for n in range(21)], (0.5, 1.0),
        ('spring', 'deletion a/0 a/1'),
    ),
    'length of a spring on its bodies': (
        'swings._ON_ENDS',
        NEAR, lambda it: teeth(12, 0.3, -it, 2.0 + it), (0.2, 0.4), ('spring', 'wall'),
    ),
    'depth of the end of a post in a ball': (
        'bodies_under._SHALLOW',
        STANDING, lambda it: down(0.0, it), (0.14, 0.19), ('wall', 'rod world'),
    ),
    'slope of a post under a ball': (
        'bodies_under.SLOPE',
        STANDING, lambda it: down(math.radians(it), 0.05), (40, 50), ('wall', 'rod world'),
    ),
    'height of round teeth between bodies': (
        'features.TREMOR',
        APART, lambda it: np.column_stack((4.0 * SHARE, 2.0 * it * np.sin(6.0 * ROUND))),
        (0.07, 0.09), ('rod', 'spring'),
    ),
    'size of a scribble across a thin body and on another': (
        'bodies_under._AS_LARGE',
        [
            spawning('a/0', Box(width=2.0, height=0.12)),
            spawning('a/1', Box(width=0.3, height=0.3), (0.0, 0.3, 0.0)),
        ],
        lambda it: scribble(0.0, 0.15, it, 0.8 * it),
        (0.9, 1.2), ('deletion a/1', 'deletion a/0 a/1'),
    ),
    'slope of a line down to beside the upper side of a body': (
        '',
        PLATE,
        lambda it: [(3.0 * math.tan(math.radians(it)), 3.6), (0.0, 0.6)],
        (40, 50), ('rod world', 'wall'),
    ),
    'height of a roof': (
        '',
        [], lambda it: [(0, 0), (2, 0), (2, 1), (1, 1.0 + it), (0, 1), (0, 0)],
        (0.25, 0.45), ('rectangle', 'polygon'),
    ),
    'overhang of a line on a body': (
        '',
        [spawning('a/0', Box(width=4.0, height=3.0))], lambda it: [(-1.5, 0.0), (2.0 + it, 0.5)],
        (0.1, 0.25), ('hatching', 'rod world'),
    ),
    'gap between a wheel and the body that carries it': (
        'axles._CARRIED',
        lambda it: [spawning('a/0', Box(width=3.0, height=0.6), (0.0, 0.3 + it, 0.0)), WHEEL_TOP],
        lambda _: circle(0.0, 0.0, 0.15), (0.44, 0.455), ('axle', 'axle world'),
    ),
    'aspect of a wheel under the body that carries it': (
        'axles._ROUND',
        lambda it: [spawning('a/0', Box(width=3.0, height=0.6), (0.0, 0.6, 0.0)),
                    spawning('a/1', Polygon(outline=ring(12, 0.5, 0.5 * it)))],
        lambda _: circle(0.0, 0.0, 0.12), (0.77, 0.8), ('axle world', 'axle'),
    ),
    'times that a scribble enters a plank': (
        'bodies_under._LEAST_ENTRIES', [spawning('a/0', Box(width=6.0, height=0.1))],
        lambda it: [(n / 10 - 0.6, 0.1 if n % 2 == 0 else 1.2 if n > 2 * it else -0.3)
                    for n in range(13)],
        (1, 2), ('', 'deletion a/0'),
    ),
    'overhang of a line beyond both sides of a body': (
        'bodies_under._INSIDE', [spawning('a/0', Box(width=4.0, height=3.0))],
        lambda it: [(-2.0 - it, 0.0), (2.0 + it, 0.2)], (0.09, 0.125), ('hatching', 'wall'),
    ),
    'corners of an axle, askew': (
        'closed_shapes._LEAST_CORNERS', [spawning('a/0', Box(width=6.0, height=4.0))],
        lambda it: [(0.3 * x, 0.3 * y) for x, y in (*ring(5), (1.0, 0.0))] if it > 4 else
        [(0.0, 0.35), (0.2, 0.0), (0.0, -0.4), (-0.2, 0.0), (0.0, 0.35)],
        (4, 5), ('polygon', 'axle world'),
    ),
    'depth of the teeth of a gear': ('', [], gear, (0.065, 0.08), ('disc', 'polygon')),
    'roundness of a plank': (
        '', [], lambda it: squircle(it) * (1.0, 0.2), (0.6, 0.65), ('rectangle', 'polygon'),
    ),
    'bow of a plank': ('', [], bowed_plank, (0.2, 0.25), ('rectangle', 'polygon')),
    'bow of the sides of a square': (
        '', [], lambda it: bowed(ring(4), it), (0.21, 0.23),
        ('rectangle', 'disc'),
    ),
    'gap in a side of a plank': (
        'plain_forms._RELATED', [],
        lambda it: [(it, 1.0), (1.0, 1.0), (1.0, 0.0), (-1.0, 0.0), (-1.0, 1.0), (-it, 1.0)],
        (0.5165, 0.553), ('rectangle', 'wall'),
    ),
    'width of a loop of a line': (
        'plain_forms._NARROW', [], narrow_loop, (0.0943, 0.0986), ('wall', ''),
    ),
    'height of two roofs on opposite sides': (
        '', [], roofs, (0.5, 0.6), ('rectangle', 'polygon'),
    ),
    'bend of the last part of the shaft of an arrow': (
        'arrow._SHAFT arrow._NECK', [], bent_late, (0.5875, 0.5887), ('gravity', ''),
    ),
    'distance of a bump in a shaft from its tail': (
        'arrow._HEAD', [], bumped, (0.134, 0.14), ('gravity', 'wall'),
    ),
    'angle of the only barb of a round arrow': (
        'round_arrow._STRIDE round_arrow._TURN', TURNING, one_barb, (1.103, 1.119), ('', 'wall'),
    ),
    'length of a zigzag of five lines': (
        'plain_forms._SWINGING choice._UNEXPLAINED', [], partial(loose, count=5),
        (0.706, 0.7165), ('', 'wall'),
    ),
    'angle of a rhomb': (
        '', [],
        lambda it: [(0, 0), (2, 0), (2 + 2 * math.cos(it), 2 * math.sin(it)),
                    (2 * math.cos(it), 2 * math.sin(it)), (0, 0)],
        (1.18, 1.21), ('polygon', 'rectangle'),
    ),
    'angle of a parallelogram': (
        '', [],
        lambda it: [(0, 0), (1.5, 0), (1.5 + 1.2 * math.cos(it), 1.2 * math.sin(it)),
                    (1.2 * math.cos(it), 1.2 * math.sin(it)), (0, 0)],
        (1.16, 1.19), ('polygon', 'rectangle'),
    ),
    'gap that a scribble bridges between two bodies': (
        'swings._MIDDLE_ON_ENDS',
        lambda it: [spawning(f'a/{n}', Box(width=1.0, height=1.0), ((1.0 + it) * n, 0.0, 0.0))
                    for n in range(2)],
        lambda it: scribble(0.5 + it / 2, 0.0, 1.6, 0.9), (0.6867, 0.7015), ('', 'spring'),
    ),
    'overlap of the ends of a square': (
        'stroke._OVERLAP', [],
        lambda it: [(-it, -0.15), (0, 0), (2, 0), (2, 2), (0, 2), (0, 0)], (1.2, 1.32),
        ('rectangle', 'wall'),
    ),
    'sides of a polygon that is sent by its corners': (
        'samples._GENTLE', [], lambda it: Corners([*ring(int(it)), (1.0, 0.0)]), (6, 7),
        ('polygon', 'disc'),
    ),
    'length of a loose scribble that is no deletion any more': (
        'features._FAR_APART', [spawning('a/0', Box(width=6.0, height=4.0))], loose,
        (1.8137, 1.828), ('deletion a/0', ''),
    ),
    'length of a loose scribble that is a zigzag': (
        'features._FAR_APART', [spawning('a/0', Box(width=6.0, height=4.0))], loose,
        (1.8775, 1.8925), ('', 'hatching'),
    ),
    'length of a scribble that is no deletion any more': (
        'features._WIDE_TOOTH swings._CLOSEST choice._SURE',
        [spawning('a/0', Box(width=6.0, height=4.0))],
        partial(loose, count=9), (2.1245, 2.1415), ('deletion a/0', ''),
    ),
    'length of a scribble that is a zigzag': (
        'features._WIDE_TOOTH swings._CLOSEST', [spawning('a/0', Box(width=6.0, height=4.0))],
        partial(loose, count=9), (2.376, 2.395), ('', 'hatching'),
    ),
    'length of a scribble over nothing': (
        'stages.MISPLACED choice._GROUP_SLOPE', [], partial(loose, count=9), (2.267, 2.286),
        ('', 'wall'),
    ),
    'shift of a square that is drawn twice': (
        'stroke.AGAIN', [],
        lambda it: [(x + it * n / 4, y + it * n / 4)
                    for n, (x, y) in enumerate(2 * [(0, 0), (2, 0), (2, 2), (0, 2)] + [(0, 0)])],
        (0.2177, 0.2221), ('rectangle', ''),
    ),
    'jitter of a pen that rests': (
        'samples.GRAIN', [], resting, (0.0148, 0.0156), ('wall', ''),
    ),
}  # fmt: skip


# The constants of a limit; a stroke of a measure, values of that on either side of the limit, and
# numbers of corners of the wall or polygon that it becomes.
BENDS: dict[
    str,
    tuple[str, Callable[[float], Way | Floats], tuple[float, float], tuple[int, int]],
] = {
    'length of an end that is bent': (
        'corner_detection._CORNER_COST stroke.HOOK',
        lambda it: [(0.0, 0.0), (2.0, 0.0), (2.0 + 0.7 * it, 0.7 * it)], (0.2257, 0.2357), (4, 3),
    ),
    'length of a short end that is bent': (
        'corner_detection._CORNER_COST',
        lambda it: [(0.0, 0.0), (2.0, 0.0), (2.0 + 0.7 * it, 0.7 * it)], (0.199, 0.208), (2, 4),
    ),
    'length that is retraced': (
        'corner_detection._LEAST_CHORD',
        lambda it: [(0.0, 0.0), (2.0, 0.0), (2.0 - it, 0.06), (4.0 - it, 0.12)], (0.692, 0.7075),
        (2, 4),
    ),
    'bow of a line': (
        'fitting.WOBBLE', lambda it: arrow(it)[0],
        (0.095, 0.099), (2, 5),
    ),
    'height of a spike in a line': (
        'samples._JUMP',
        lambda it: Corners([(0.2 * n, 0.0) for n in range(8)] + [(1.5, 0.5)]
                           + [(1.6 + 0.2 * n, 0.0) for n in range(8)] + [(3.0 + it, 0.0)]),
        (0.251, 0.258), (2, 5),
    ),
    'number of samples with a spike among them': (
        'samples._CLICKS',
        lambda it: Corners([(3.0 * n / (it - 1), 2.5 * (n == it // 2)) for n in range(int(it))]),
        (11, 12), (5, 2),
    ),
    'aspect of an oval': (
        'plain_forms._OVAL_SIDES', lambda it: np.column_stack((np.cos(ANGLE), it * np.sin(ANGLE))),
        (0.5, 0.53), (48, 48),
    ),
}  # fmt: skip

# The constants of a limit; bodies, strokes of a measure and their pause [s], values of the measure
# on either side of the limit, and the readings of the last stroke.
FIGURES: dict[
    str,
    tuple[
        str,
        Sequence[Spawn],
        Callable[[float], tuple[Sequence[Way | Floats], float]],
        tuple[float, float],
        tuple[str, str],
    ],
] = {
    'lines of a polygon': (
        'grouping.MOST_STROKES', [],
        lambda it: ([*itertools.pairwise([*ring(int(it)), (1.0, 0.0)])], 0.4), (8, 9),
        ('polygon', 'wall'),
    ),
    'pause within an x on a body': (
        'grouping.SLOWLY', [spawning('a/0', Box(width=6.0, height=4.0))],
        lambda it: ([[(-1, -0.9), (1.1, 0.8)], [(-0.8, 1), (0.7, -0.9)]], it), (9.9, 10.1),
        ('anchor', 'hatching'),
    ),
    'length of a line through a circle': (
        'figure.ON_SOLID', [],
        lambda it: ([circle(0.0, 0.0, 1.0), [(-it, 0.0), (it, 0.05)]], 0.4), (3.19, 3.32),
        ('mark', 'wall'),
    ),
    'length of barbs by that of the shaft': (
        'joining._LONGEST', [], lambda it: (arrow(barb=it, shaft=1.0), 0.4), (1.086, 1.13),
        ('gravity', 'polygon'),
    ),
    'distance of two chevrons within each other': (
        'joining._NEAR', [],
        lambda it: ([[(-1, 2), (0, 0), (1, 2)], [(-1, 2 + it), (0, it), (1, 2 + it)]], 0.4),
        (0.135, 0.15), ('polygon', 'wall'),
    ),
    'height of the tip of a wider chevron within another': (
        'joining._BACK', [],
        lambda it: ([[(-1, 1.7), (0, 0), (1, 1.7)], [(-0.8, 1.7), (0, it), (0.8, 1.7)]], 0.4),
        (0.95, 1.15), ('wall', 'polygon'),
    ),
    'depth of the back of a closed head': (
        'joining._OFF joining._STRAIGHT', [],
        lambda it: ([[(0, 0), (3, 0)],
                     [(2.4, 0.4), (3, 0), (2.4, -0.4), (2.4 - it, 0), (2.4, 0.4)]], 0.4),
        (0.1443, 0.1502), ('gravity', 'polygon'),
    ),
    'bow of a line of an x': (
        'x._STRAIGHT', [spawning('a/0', Box(width=6.0, height=4.0))],
        lambda it: ([[(-1, -1), (1, 1)], np.column_stack(
            (2 * SHARE - 1 + 4 * it * SHARE * (1 - SHARE),
             1 - 2 * SHARE + 4 * it * SHARE * (1 - SHARE)))], 0.4), (0.469, 0.489),
        ('anchor', 'velocity'),
    ),
    'gap between a shaft and its head': (
        'joining._BEYOND', [], lambda it: ([arrow(shaft=3.0 - it)[0], arrow()[1]], 0.4),
        (0.692, 0.7023), ('gravity', 'wall'),
    ),
    'distance of two sides of a square from the ends of the others': (
        'joining._TOUCHING', [], lambda it: (aside(it), 0.4), (0.3349, 0.3397),
        ('rectangle', 'wall'),
    ),
}  # fmt: skip


def hooked(angle: float) -> float:
    """Return the length that is read of a line of 2 m with a hook of 0.15 m at its start [m]."""
    hook = (-0.15 * math.cos(angle), 0.15 * math.sin(angle))
    return round(resample_stroke(sampled([hook, (0.0, 0.0), (2.0, 0.0)])).length, 1)


def rounds_of_square(rounds: float) -> float:
    """Return the length of the outline of a square of 2 m that is drawn some times round [m]."""
    corners = np.array([(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (0.0, 0.0)])
    at = 4.0 * rounds * np.linspace(0.0, 1.0, 200) % 4.0
    path = np.column_stack([np.interp(at, range(5), axis) for axis in corners.T])
    outline = resample_stroke(path).outline
    return round(path_length(np.vstack((outline, outline[:1]))), 1)


def candidates_of(sign: Sign, way: Way | Floats) -> int:
    """Return the number of candidates of a sign in a stroke."""
    return len(list(sign.candidates(features_of(resample_stroke(sampled(way))))))


def returning(chord: float) -> int:
    """Return the number of arrows in one whose last barb ends at a distance from its tail [m]."""
    return candidates_of(ARROW, [(0, 0), (1, 0), (0.4, 0.3), (1, 0), (chord, -0.01)])


def spread_of(length: float) -> int:
    """Return the number of scribbles in eight lines to and fro, along a length [m]."""
    return candidates_of(SCRIBBLE, loose(length, 8))


def is_arrow(strokes: Sequence[Way | Floats]) -> bool:
    """Return whether strokes are joined as an arrow."""
    return joined_arrow([resample_stroke(sampled(each)).points for each in strokes]) is not None


def wide_head(angle: float) -> bool:
    """Return whether a shaft and two barbs with an angle between them are an arrow."""
    x, y = 3.0 - math.cos(angle / 2), math.sin(angle / 2)
    return is_arrow([[(0, 0), (3, 0)], [(x, y), (3, 0), (x, -y)]])


def far_head(gap: float) -> bool:
    """Return whether a shaft of 1 m and a head before it, after a gap [m], are an arrow."""
    x = 1.0 + gap
    return is_arrow([[(0, 0), (1, 0)], [(x - 0.5, 0.4), (x, 0), (x - 0.5, -0.4)]])


def are_x(angle: float) -> bool:
    """Return whether two lines with an angle between them are an x."""
    x, y = math.cos(angle), math.sin(angle)
    lines = [(-1, 0), (1, 0)], [(-x, -y), (x, y)]
    return of_lines([resample_stroke(sampled(each)).points for each in lines]) is not None


def are_crossed(beyond: float) -> bool:
    """Return whether two lines are an x, one of them ending so far beyond the other."""
    lines = [(-1.5, 0), (beyond, 0)], [(0, 1), (0, -1)]
    return of_lines([resample_stroke(sampled(each)).points for each in lines]) is not None


def uneven_head(share: float) -> bool:
    """Return whether a shaft and two barbs are an arrow, one of them a share of the other."""
    return is_arrow([[(0, 0), (3, 0)], [(2.2, 0.5), (3, 0), (3.0 - 0.8 * share, -0.5 * share)]])


def short_head(share: float) -> bool:
    """Return whether a shaft and a wide triangle, its base drawn by a share, are an arrow."""
    head = [(2.7, 0.55), (3, 0), (2.7, -0.55), (2.7, 1.1 * share - 0.55)]
    return is_arrow([[(0, 0), (2.7, 0)], head])


def long_head(share: float) -> bool:
    """Return whether a shaft and a triangle, its base drawn by a share, are an arrow."""
    head = [(2.4, 0.4 - 0.8 * share), (2.4, 0.4), (3, 0), (2.4, -0.4)]
    return is_arrow([[(0, 0), (2.4, 0)], head])


def rod(slope: float) -> tuple[str, str, bool]:
    """Return the guesses of a line between two bodies, and whether the first is rather sure."""
    world = World()
    for body in APART:
        world.apply(body)
    first, *others = read(world, [(0.0, 0.0), (4.0, 4.0 * slope)]).guesses
    return first.meaning, ' '.join(each.meaning for each in others), first.confidence > 0.9


def heavier(lines: float) -> float:
    """Return by which factor lines to and fro on a body make it heavier."""
    world = World()
    world.apply(spawning('a/0', Box(width=6.0, height=4.0)))
    (change,) = read(world, loose(4.0, int(lines))).requests
    assert isinstance(change, ChangeBody)
    body = world.scene.bodies[0]
    return round((change.properties.density or 0.0) / body.density, 6)


def bends_beyond(distance: float) -> bool:
    """Return whether the first line of an x bends, which turns beyond the crossing [m]."""
    way = [(-0.1, 0.1), (distance, -distance), (distance, distance), (-1.0, -1.0)]
    (candidate,) = CROSS.candidates(features_of(resample_stroke(sampled(way))))
    return candidate.measures['bent'] > 1e-3


def swings_with_spike(height: float) -> int:
    """Return the number of swings of nine teeth, one of them higher than the others [m]."""
    teeth = [(0.2 * n - 1.0, (0.5 if n != 4 else 0.5 + height) * (-1) ** n) for n in range(10)]
    return features_of(resample_stroke(sampled(teeth))).swings.count


def corners_of(way: Way | Floats) -> float:
    """Return the number of corners of an outline."""
    return fits_of(resample_stroke(sampled(way)).outline).measures['corners']


def is_triangle(bow: float) -> bool:
    """Return whether a triangle whose sides are bowed outwards by a share has three corners."""
    best = classification_of(resample_stroke(sampled(bowed(ring(3), bow)))).forms[0]
    return best.name == POLYGON and len(best.points) == 3


def guesses(diameter: float) -> str:
    """Return the meanings that a circle on a square of 1 m may have."""
    world = World()
    for body in PLATE:
        world.apply(body)
    return ' '.join(each.meaning for each in read(world, circle(0.0, 0.0, diameter / 2)).guesses)


# The constants of a limit of an earlier stage; a function of a measure, values of that on either
# side of the limit, the results.
STAGES: dict[
    str, tuple[str, Callable[[float], object], tuple[float, float], tuple[object, object]]
] = {
    'angle of a hook that is no part of a line': (
        'stroke.SHARP', hooked, (1.1, 1.3), (2.1, 2.0),
    ),
    'rounds of a square': ('stroke.ROUNDS', rounds_of_square, (0.95, 1.5), (8.0, 8.0)),
    'distance of the last barb of an arrow from its tail': (
        'arrow._LEAST_CHORD', returning, (0.15, 0.16), (0, 2),
    ),
    'length of a scribble of eight lines': ('swings._FARTHEST', spread_of, (2.4, 2.6), (1, 0)),
    'angle between the barbs of a head': (
        'joining._WIDEST', wide_head, (2.27, 2.33), (True, False),
    ),
    'gap before the head, of a shaft': ('joining._NECK', far_head, (0.345, 0.355), (True, False)),
    'length of the lesser barb by that of the other': (
        'joining._BALANCE', uneven_head, (0.34, 0.36), (False, True),
    ),
    'share of the base of a short closed head that is drawn': (
        'joining._ROUND', short_head, (0.3, 0.45), (False, True),
    ),
    'share of the base of a long closed head that is drawn': (
        'joining._ROUND', long_head, (0.5, 1.0), (True, True),
    ),
    'diameter of a circle that is an axle for certain': (
        'evidence.LEAST', guesses, (0.265, 0.2692), ('axle', 'axle disc'),
    ),
    'weight of a group that is read': (
        'choice._GROUP_BIAS choice._DOUBT',
        lambda it: group_confidence(it, 1.0) >= 0.6, (0.614, 0.619), (False, True),
    ),
    'slope of a rod, instead of which a wall is offered': (
        'stages.BETWEEN', rod, (0.0, 0.1), (('rod', 'wall', True), ('rod', 'wall', True)),
    ),
    'length of the lines of an x beyond its crossing': (
        'x._BEYOND', bends_beyond, (0.08, 0.09), (True, False),
    ),
    'angle of the lines of an x': (
        'geometry.LEAST_SINE', are_x, (0.295, 0.31), (False, True),
    ),
    'length of a line beyond the other one of an x': (
        'x._BEYOND_OF_TWO', are_crossed, (0.26, 0.29), (False, True),
    ),
    'depth of the teeth of a gear whose corners are eight': (
        'corner_detection._WOBBLE_CLOSED', lambda it: corners_of(gear(it)), (0.23, 0.245), (8, 4),
    ),
    'bow of the sides of a triangle': (
        'plain_forms._SIDED', is_triangle, (0.45, 0.5), (True, False),
    ),
    'height of two flat roofs': (
        'corner_detection._CORNER_TURN', lambda it: corners_of(roofs(it)), (0.35, 0.43), (4, 6),
    ),
    'bow of a plank whose corners are four': (
        'resampled._WIDE', lambda it: corners_of(bowed_plank(it)), (0.067, 0.075), (4, 3),
    ),
    'lines of hatching': ('open_lines._HEAVIER', heavier, (1, 2), (1.25, 1.5625)),
    'height of one tooth above the others': (
        'features._FRINGE', swings_with_spike, (0.875, 1.5), (5, 4),
    ),
}  # fmt: skip


# Numbers of points between which readings do not differ, and what words and work are limited to.
RESOLUTION = {
    'samples._FEWEST_SAMPLES', 'fitting._ROUNDS', 'arrow._ALONG', 'corner_detection._ALONG',
    'corner_detection._PARABOLA',
    'resampled.COUNT', 'resampled.ARM', 'resampled._FEW', 'resampled._SMOOTHING', 'stroke._FINER',
    'stroke._FINELY', 'joining._BETWEEN', 'open_lines._CUBICS', 'features._ANGLES',
    'features._STRIDE', 'features._SEGMENTS', 'features._PAIRS', 'features._MERGED',
    'stages.MOST_GUESSES', 'grouping.MOST_TIME',
}  # fmt: skip
CONSTANTS = constants([*(FOLDER / 'strokes').rglob('*.py'), FOLDER / 'geometry.py'])


def rows_of(constant: str) -> list[str]:
    """Return the names of the rows of a constant."""
    rows = {**LIMITS, **BENDS, **FIGURES, **STAGES}
    return [name for name, (needed, *_) in rows.items() if constant in needed.split()]


DECIDED = sorted(
    {
        name
        for rows in (LIMITS, BENDS, FIGURES, STAGES)
        for needed, *_ in rows.values()
        for name in needed.split()
    }
)


def test_every_number_has_a_stroke_on_either_side_or_is_named() -> None:
    assert CONSTANTS.keys() == {*DECIDED} | RESOLUTION
    assert not {*DECIDED} & RESOLUTION


@pytest.mark.slow
@pytest.mark.parametrize('factor', [1.3, 1 / 1.3])
@pytest.mark.parametrize('constant', DECIDED)
def test_another_number_moves_a_limit(constant: str, factor: float) -> None:
    with another_number(__name__, CONSTANTS[constant], factor) as tables:
        assert not all(tables.holds(name) for name in rows_of(constant))


def holds(name: str) -> bool:
    """Return whether the readings on either side of a limit are those of its row."""
    try:
        if name in LIMITS:
            test_a_meaning_ends_at_its_limit(*LIMITS[name][1:])
        elif name in BENDS:
            test_a_bend_ends_at_its_limit(*BENDS[name][1:])
        elif name in STAGES:
            test_a_stage_ends_at_its_limit(*STAGES[name][1:])
        else:
            test_a_figure_ends_at_its_limit(*FIGURES[name][1:])
    except (AssertionError, Refusal):
        return False
    return True


@pytest.mark.parametrize(
    ('bodies', 'way', 'values', 'readings'), [each[1:] for each in LIMITS.values()], ids=LIMITS
)
def test_a_meaning_ends_at_its_limit(
    bodies: Sequence[Spawn | Join] | Callable[[float], Sequence[Spawn]],
    way: Callable[[float], Way | Floats],
    values: tuple[float, float],
    readings: tuple[str, str],
) -> None:
    for value, expected in zip(values, readings, strict=True):
        world = World()
        for body in bodies(value) if callable(bodies) else bodies:
            world.apply(body)

        assert meaning_of(world, way(value)) == expected


@pytest.mark.parametrize(
    ('way', 'values', 'counts'), [each[1:] for each in BENDS.values()], ids=BENDS
)
def test_a_bend_ends_at_its_limit(
    way: Callable[[float], Way | Floats], values: tuple[float, float], counts: tuple[int, int]
) -> None:
    for value, expected in zip(values, counts, strict=True):
        (request,) = read(World(), way(value)).requests

        assert isinstance(request, Spawn)
        match request.shape:
            case Chain(points=points) | Polygon(outline=points):
                assert len(points) == expected


@pytest.mark.parametrize(
    ('bodies', 'figure', 'values', 'readings'),
    [each[1:] for each in FIGURES.values()],
    ids=FIGURES,
)
def test_a_figure_ends_at_its_limit(
    bodies: Sequence[Spawn],
    figure: Callable[[float], tuple[Sequence[Way | Floats], float]],
    values: tuple[float, float],
    readings: tuple[str, str],
) -> None:
    for value, expected in zip(values, readings, strict=True):
        strokes, pause = figure(value)

        assert last_meaning(bodies, strokes, pause) == expected


@pytest.mark.parametrize(
    ('result', 'values', 'results'), [each[1:] for each in STAGES.values()], ids=STAGES
)
def test_a_stage_ends_at_its_limit(
    result: Callable[[float], object],
    values: tuple[float, float],
    results: tuple[object, object],
) -> None:
    assert tuple(map(result, values)) == results


def meaning_of(world: World, way: Way | Floats) -> str:
    """Return the meaning of a stroke with the bodies that it concerns; '' where it is refused."""
    try:
        reading = read(world, way)
    except Refusal:
        return ''
    words = [reading.meaning]
    for each in reading.requests:
        words += [each.name] if isinstance(each, Delete) else []
        words += (each.properties.over or ()) if isinstance(each, Join) else ()
        words += [WORLD] if isinstance(each, Join) and each.b == WORLD else []
    return ' '.join(words)


def read(world: World, way: Way | Floats) -> Reading:
    return interpret_stroke(sampled(way), SceneQuery(world.snapshot()), DrawingSettings())


def last_meaning(bodies: Sequence[Spawn], strokes: Sequence[Way | Floats], pause: float) -> str:
    """Return the meaning of the last of strokes of 0.6 s, with pauses between them [s]."""
    simulation, session = Simulation(speed=0.0), DrawingSession(DrawingSettings())
    for body in bodies:
        simulation.requests.submit(body, topic='')
    reading: Reading | None = None
    for number, stroke in enumerate(strokes):
        frame = simulation.apply_requests() or simulation.advance_frame()
        points = sampled(stroke)
        samples = np.column_stack((points, np.linspace(0.0, 0.6, len(points))))
        began = number * (0.6 + pause)
        reading = session.stroke(samples, '', frame.snapshot, began=began)
        submit_reading(simulation, session, reading)
    return reading.meaning if reading is not None else ''


def sampled(way: Way | Floats) -> Floats:
    """Return samples of a stroke, (n, 2) float64: all of straight sides, or its corners alone."""
    points = np.array(way, dtype=np.float64)
    if isinstance(way, Corners) or len(points) >= 40:
        return points
    sides = [np.linspace(a, b, 25, endpoint=False) for a, b in itertools.pairwise(points)]
    return np.vstack((*sides, points[-1:]))
