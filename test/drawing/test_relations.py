# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Relations of strokes: what does not matter to a reader does not change a reading."""

from collections.abc import Callable, Sequence
from functools import partial
import math

import numpy as np
from physsim_ros.drawing import DrawingSession, DrawingSettings, submit_reading
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.simulation import Simulation
import pytest

from ..building import spawning

# A world in which things are drawn: its bodies, strokes as (n, 3) float64: x, y [m], time [s].
Drawn = tuple[Sequence[Spawn], list[Floats]]
# Samples and seconds of a stroke, and seconds between strokes.
_COUNT, _SECONDS, _PAUSE = 60, 0.6, 0.4
ANGLE = np.linspace(0.0, 2.0 * math.pi, 61)
CIRCLE = np.column_stack((np.cos(ANGLE), 0.9 * np.sin(ANGLE)))
TEETH = [(0.5 * n, 0.4 * (-1) ** n) for n in range(1, 9)]
PLATE = [spawning('a/0', Box(width=6.0, height=4.0))]
BESIDE = [spawning(f'a/{n}', Disc(radius=0.5), (4.5 * n, 0.0, 0.0)) for n in range(2)]
# Bodies, ways of the pen, and the readings.
THINGS: dict[str, tuple[Sequence[Spawn], Sequence[Floats | list[tuple[float, float]]], str]] = {
    'disc': ([], [CIRCLE], 'disc'),
    'rectangle': ([], [[(0, 0), (3, 0.1), (2.9, 1.6), (0.1, 1.5), (0, 0)]], 'rectangle'),
    'polygon': ([], [[(0, 0), (3, 0), (1.2, 2.2), (0, 0)]], 'polygon'),
    'wall': ([], [[(0, 0), (2, 0.4), (3, 2)]], 'wall'),
    'rod': (BESIDE, [[(0, 0), (4.5, 0.1)]], 'rod'),
    'spring': (BESIDE, [[(0, 0), *TEETH, (4.5, 0)]], 'spring'),
    'axle': (PLATE, [0.4 * CIRCLE], 'axle'),
    'x in one stroke': (PLATE, [[(-1, 0.8), (1, -0.9), (0.9, 0.8), (-1, -0.8)]], 'anchor'),
    'x of two lines': (PLATE, [[(-1, -0.9), (1.1, 0.8)], [(-0.8, 1), (0.7, -0.9)]], 'anchor'),
    'arrow': ([], [[(0, 0), (3, 0.2), (2.2, 0.7), (3, 0.2), (2.3, -0.4)]], 'gravity'),
    'shaft and head': ([], [[(0, 0), (3, 0.2)], [(2.2, 0.7), (3, 0.2), (2.3, -0.4)]], 'gravity'),
}  # fmt: skip


def along(way: Floats | list[tuple[float, float]], count: int = _COUNT) -> Floats:
    """Return samples along a way at an even pace, (n, 3) float64."""
    points = np.array(way, dtype=np.float64)
    length = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))))
    at = np.linspace(0.0, length[-1], count)
    places = [np.interp(at, length, axis) for axis in points.T]
    return np.column_stack((*places, np.linspace(0.0, _SECONDS, count)))


def placed(drawn: Drawn, turn: Callable[[Floats], Floats]) -> Drawn:
    """Return bodies, which are symmetric, and strokes moved by a function of places."""
    bodies, strokes = drawn
    moved = []
    for body in bodies:
        x, y, _ = body.pose
        (here, there) = turn(np.array([(x, y), (x + 1.0, y)]))
        scale = float(np.hypot(*(there - here)))
        shape = body.shape
        if isinstance(shape, Box):
            shape = Box(width=scale * shape.width, height=scale * shape.height)
        elif isinstance(shape, Disc):
            shape = Disc(radius=scale * shape.radius)
        moved.append(spawning(body.name, shape, (*here.tolist(), 0.0)))
    return moved, [np.column_stack((turn(each[:, :2]), each[:, 2])) for each in strokes]


def each_stroke(change: Callable[[Floats], Floats]) -> Callable[[Drawn], Drawn]:
    """Return a relation that changes every stroke."""
    return lambda drawn: (drawn[0], [change(each) for each in drawn[1]])


def late(samples: Floats, slop: float) -> Floats:
    """Return samples of a touch screen: the first move arrives late, the others at its pace."""
    away = np.hypot(*(samples[:, :2] - samples[0, :2]).T)
    kept = np.maximum.accumulate(away) > slop * float(np.hypot(*np.ptp(samples[:, :2], axis=0)))
    received = np.vstack((samples[:1], samples[kept]))
    received[:, 2] = np.arange(len(received)) / 60.0
    return received


def trembling(samples: Floats, size: float) -> Floats:
    noise = np.random.default_rng(7).normal(0.0, size, (len(samples), 2))
    return samples + np.column_stack((noise, np.zeros(len(samples))))


def rounded(samples: Floats) -> Floats:
    """Return samples of a mouse, in whole pixels of a page of 1,000 for 8 m."""
    return np.column_stack((np.round(samples[:, :2] / 0.008) * 0.008, samples[:, 2]))


def backwards(samples: Floats) -> Floats:
    return np.column_stack((samples[::-1, :2], samples[:, 2]))


def slowly(samples: Floats) -> Floats:
    return samples * (1.0, 1.0, 4.0)


def every(samples: Floats, step: int) -> Floats:
    return np.vstack((samples[::step], samples[-1:]))


RELATIONS: dict[str, Callable[[Drawn], Drawn]] = {
    **{
        f'{share} of the samples': each_stroke(partial(every, step=step))
        for share, step in (('half', 2), ('a third', 3))
    },
    **{f'slop of {slop:.0%}': each_stroke(partial(late, slop=slop)) for slop in (0.1, 0.2, 0.35)},
    'a sample less': each_stroke(lambda it: np.delete(it, len(it) // 2, axis=0)),
    'slower': each_stroke(slowly),
    'equal times': each_stroke(lambda it: it * (1.0, 1.0, 0.0)),
    'by pen': each_stroke(lambda it: trembling(it, 0.004)),
    'by mouse': each_stroke(rounded),
    'by finger': each_stroke(lambda it: late(rounded(trembling(it, 0.008)), 0.2)),
    'moved': lambda drawn: placed(drawn, lambda xy: np.add(xy, (37.0, -21.0))),
    'smaller': lambda drawn: placed(drawn, lambda xy: 0.5 * xy),
    'larger': lambda drawn: placed(drawn, lambda xy: 3.0 * xy),
    'mirrored': lambda drawn: placed(drawn, lambda xy: xy * (-1.0, 1.0)),
    'upside down': lambda drawn: placed(drawn, lambda xy: xy * (1.0, -1.0)),
    'strokes in another order': lambda drawn: (drawn[0], drawn[1][::-1]),
}
# A stroke from its end: an arrow in one stroke points elsewhere then, but is one.
RELATIONS['reversed'] = each_stroke(backwards)


def readings(drawn: Drawn) -> str:
    """Return the meaning of the last stroke; '' where it is refused."""
    bodies, strokes = drawn
    simulation = Simulation(speed=0.0)
    for body in bodies:
        simulation.requests.submit(body, topic='')
    frame = simulation.advance_frame()
    frame = simulation.apply_requests() or frame
    session, now, meaning = DrawingSession(DrawingSettings()), 0.0, ''
    for samples in strokes:
        began, now = now + _PAUSE, now + _PAUSE + float(np.ptp(samples[:, 2]))
        try:
            reading = session.stroke(samples, '', frame.snapshot, began=began)
        except Refusal:
            meaning = ''
            continue
        submit_reading(simulation, session, reading, topic='')
        frame = simulation.apply_requests() or frame
        meaning = reading.meaning
    return meaning


@pytest.mark.parametrize('relation', ['', *RELATIONS])
@pytest.mark.parametrize('thing', THINGS)
def test_a_reading_stays_the_same(thing: str, relation: str) -> None:
    bodies, ways, meaning = THINGS[thing]
    drawn: Drawn = bodies, [along(way) for way in ways]

    assert readings(RELATIONS[relation](drawn) if relation else drawn) == meaning
