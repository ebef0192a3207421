# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Scenes: a figure, the world that it is drawn in, and what it means there.

Everything lies where the hand draws: bodies at the ends of a spring, under an x, under a scribble.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Join, Spawn
from physsim_ros.model.shapes import Box, Disc, Shape
from physsim_ros.simulation.world import World

from . import arrows, figures, strangers
from .faults import Fault, FAULTS
from .figures import Figure
from .hand import Hand
from .hands import drawn, hand
from .outlines import Floats, Random

# Rounds of kinds in which none has a fault, if they cannot have it.
_FRUITLESS = 20
SEEDS = {'tuning': 1, 'report': 2, 'apart': 3, 'strangers': 4}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scene:
    """
    A stroke in a world.

    :param name: of the row in the table
    :param fault: name of the fault, '' for none
    :param figure: what was meant to be drawn
    :param samples: (n, 3) float64: x, y [m], time [s]
    :param view: the world
    :param meaning: of the stroke; None where it has none
    """

    name: str
    fault: str
    figure: Figure
    samples: Floats
    view: SceneQuery
    meaning: str | None


def scenes(count: int, half: str, kinds: Sequence[Kind] | None = None) -> Iterator[Scene]:
    """Yield so many scenes of every kind, or of some, in turn; the same for the same half."""
    for kind in KINDS if kinds is None else kinds:
        rng = np.random.default_rng((SEEDS[half], KINDS.index(kind)))
        for _ in range(count):
            scene = _scene(kind, _PLAIN, '', half, rng)
            assert scene is not None
            yield scene


def faulty_scenes(count: int, half: str, kinds: Sequence[Kind] | None = None) -> Iterator[Scene]:
    """Yield so many scenes with every fault, of the kinds, or some, that can have it in turn."""
    for number, (name, fault) in enumerate(FAULTS.items()):
        rng = np.random.default_rng((SEEDS[half], 1000 + number))
        left, fruitless = count, 0
        while left and fruitless < _FRUITLESS:
            fruitless += 1
            for kind in KINDS if kinds is None else kinds:
                if kind.meaning is None or not left:
                    continue
                scene = _scene(kind, fault, name, half, rng)
                if scene is not None:
                    left, fruitless = left - 1, 0
                    yield scene


def _scene(kind: Kind, fault: Fault, name: str, half: str, rng: Random) -> Scene | None:
    """Return a scene of a kind with a fault, or None where it cannot have that."""
    draw = strangers.arrow if (kind.draw, half) == (arrows.arrow, 'strangers') else kind.draw
    figure = draw(rng)
    wrong = fault.figure(figure, rng)
    if wrong is None:
        return None
    somebody = fault.hand(hand(rng, figure, half), rng)
    world = World()
    for index, (shape, x, y) in enumerate(kind.around(figure, somebody, rng)):
        world.apply(Spawn(name=f'body/{index}', shape=shape, pose=(x, y, 0.0)))
    if kind.axle:
        axle = Join(
            name='axle/0',
            kind=JointKind.AXLE,
            points=(somebody.place,),
            a='body/0',
            b=WORLD,
            properties=JointProperties(),
        )
        world.apply(axle)
    return Scene(
        name=kind.name,
        fault=name,
        figure=figure,
        samples=fault.samples(drawn(wrong, somebody, rng), rng),
        view=SceneQuery(world.snapshot()),
        meaning=kind.meaning,
    )


# A shape and where it lies.
Placed = tuple[Shape, float, float]


def _nothing(_figure: Figure, _somebody: Hand, _rng: Random) -> list[Placed]:
    return []


def _at_ends(figure: Figure, somebody: Hand, rng: Random) -> list[Placed]:
    """Put a body about either end."""
    path = figure.path / np.hypot(*np.ptp(figure.path, axis=0))
    placed: list[Placed] = []
    for end in path[[0, -1]] * somebody.size + somebody.place:
        radius = somebody.size * rng.uniform(0.1, 0.2)
        shape = Disc(radius=radius) if rng.random() < 0.5 else Box(width=2 * radius, height=radius)
        x, y = (end + rng.uniform(-0.3, 0.3, 2) * radius).tolist()
        placed.append((shape, x, y))
    return placed


def _at_start(figure: Figure, somebody: Hand, rng: Random) -> list[Placed]:
    """Put a body about the tail of an arrow, or where the pen is set down."""
    return [_at_ends(figure, somebody, rng)[figure.tail]]


def _within(_figure: Figure, somebody: Hand, rng: Random) -> list[Placed]:
    """Put a wheel into a round arrow."""
    return [(Disc(radius=somebody.size * rng.uniform(0.1, 0.3)), *somebody.place)]


def _under(_figure: Figure, somebody: Hand, rng: Random) -> list[Placed]:
    """Put a body under a sign that is a good deal smaller."""
    size = somebody.size * rng.uniform(1.2, 4.0)
    x, y = somebody.place
    if rng.random() < 0.5:
        return [(Disc(radius=0.7 * size), x, y)]
    return [(Box(width=1.5 * size, height=size), x + rng.uniform(-0.2, 0.2) * size, y)]


def _under_both(_figure: Figure, somebody: Hand, rng: Random) -> list[Placed]:
    """Put two bodies that overlap under a small sign: a wheel and what it carries."""
    size = somebody.size * rng.uniform(2.2, 6.0)
    x, y = somebody.place
    carried = Box(width=size * rng.uniform(1.0, 4.0), height=size * rng.uniform(0.7, 1.2))
    return [(carried, x + rng.uniform(-0.3, 0.3) * size, y), (Disc(radius=size / 2), x, y)]


def _scribbled(_figure: Figure, somebody: Hand, rng: Random) -> list[Placed]:
    """Put a body under a scribble that is about as large."""
    size = somebody.size * rng.uniform(0.35, 0.7)
    x, y = somebody.place
    if rng.random() < 0.5:
        return [(Disc(radius=size / 2), x, y)]
    return [(Box(width=size, height=size * rng.uniform(0.5, 1.0)), x, y)]


def _squiggle(rng: Random) -> Figure:
    """Return a figure without a meaning: a signature, a letter, a knot."""
    angle = np.linspace(0.0, 2.0 * math.pi, 200)
    path = sum(
        np.column_stack(
            (
                rng.normal(0.0, 0.3 / wave) * np.sin(wave * angle + rng.uniform(0, 7)),
                rng.normal(0.0, 0.3 / wave) * np.sin(wave * angle + rng.uniform(0, 7)),
            )
        )
        for wave in np.arange(0.6, 3.2, 0.5)
    )
    return Figure(kind='', path=np.asarray(path), smooth=True)


_PLAIN = Fault()
_Around = Callable[[Figure, Hand, Random], list[Placed]]


@dataclass(frozen=True, slots=True)
class Kind:
    """A row of the table: what is drawn, what that means (None: nothing), and over what."""

    name: str
    draw: Callable[[Random], Figure]
    meaning: str | None
    around: _Around
    # Whether the first body turns about an axle in the middle of what is drawn.
    axle: bool = False


KINDS: tuple[Kind, ...] = (
    Kind('disc', figures.disc, 'disc', _nothing),
    Kind('oval', figures.oval, 'polygon', _nothing),
    Kind('rectangle', figures.rectangle, 'rectangle', _nothing),
    Kind('polygon', figures.polygon, 'polygon', _nothing),
    Kind('pentagram', figures.pentagram, 'polygon', _nothing),
    Kind('pentagram, on a body', figures.pentagram, 'polygon', _scribbled),
    Kind('line', figures.line, 'wall', _nothing),
    Kind('bent line', figures.bent_line, 'wall', _nothing),
    Kind('check, caret, V', figures.check, 'wall', _nothing),
    Kind('bracket', figures.bracket, 'wall', _nothing),
    Kind('brace', figures.brace, 'wall', _nothing),
    Kind('brace, on a body', figures.brace, 'wall', _scribbled),
    Kind('question mark', figures.question_mark, 'wall', _nothing),
    Kind('curve', figures.curve, 'wall', _nothing),
    Kind('line, 2 bodies', figures.line, 'rod', _at_ends),
    Kind('zigzag, 2 bodies', figures.zigzag, 'spring', _at_ends),
    Kind('coil, 2 bodies', figures.coil, 'spring', _at_ends),
    Kind('x, on a body', figures.cross, 'anchor', _under),
    Kind('circle, on a body', figures.disc, 'axle', _under),
    Kind('circle, on 2', figures.disc, 'axle', _under_both),
    Kind('arrow', arrows.arrow, 'gravity', _nothing),
    Kind('scribble, on a body', figures.scribble, 'deletion', _scribbled),
    Kind('pigtail, on a body', figures.pigtail, None, _under),
    Kind('x', figures.cross, None, _nothing),
    Kind('squiggle', _squiggle, None, _nothing),
    # Behind the others, whose random numbers depend on their places.
    Kind('ramp', figures.ramp, 'polygon', _nothing),
    Kind('arrow, from a body', arrows.arrow, 'velocity', _at_start),
    Kind('zigzag, 1 body', figures.short_zigzag, 'spring', _at_start),
    Kind('short zigzag, 2 bodies', figures.short_zigzag, 'spring', _at_ends),
    Kind('short x, on a body', figures.short_cross, 'anchor', _under),
    Kind('letter', figures.letter, 'wall', _nothing),
    Kind('trembling line', figures.trembling_line, 'wall', _nothing),
    Kind('five swings, on a body', figures.five_swings, None, _scribbled),
    Kind('round arrow', arrows.round_arrow, 'motor', _within, axle=True),
    Kind('sagging line, 2 bodies', figures.sag, 'rope', _at_ends),
)
# Closed strokes in the open.
OUTLINES = tuple(
    kind
    for kind in KINDS
    if kind.meaning in {'disc', 'rectangle', 'polygon'} and kind.around is _nothing
)
# All meanings of strokes, in the order of their kinds.
MEANINGS = tuple(dict.fromkeys(kind.meaning for kind in KINDS if kind.meaning is not None))
