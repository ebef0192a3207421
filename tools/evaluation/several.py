# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Things that people draw in several strokes, and drawings of ten strokes, read by one session.

Between strokes of one thing people pause for 0.3 to 0.7 s, 88 % of them for less than 0.8 s. A
thing is right when the world is as it should be, whatever was read in between.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from physsim_ros.drawing import DrawingSession, DrawingSettings, submit_reading
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import Spawn
from physsim_ros.simulation.simulation import Simulation

from . import figures
from .hand import Hand
from .hands import drawn, hand
from .joints import JOINTS
from .outlines import Floats, Random
from .people import figure_of, placed
from .scenes import SEEDS
from .things import Thing, THINGS

# Seconds between two strokes of one thing, and between two things: least and greatest.
_WITHIN, _BETWEEN = (0.3, 0.7), (0.4, 1.6)
# The longest first step of a finger, in shares of the stroke.
_LONGEST_STEP = 0.4


class Sheet:
    """A standing world, and somebody who draws into it."""

    def __init__(self, under: Sequence[Spawn] = ()) -> None:
        self.simulation = Simulation(speed=0.0)
        for request in under:
            self.simulation.requests.submit(request, topic='')
        self.session = DrawingSession(DrawingSettings())
        self.frame = self.simulation.advance_frame()
        self.frame = self.simulation.apply_requests() or self.frame
        self.now = 0.0

    def draw(self, samples: Floats, pause: float) -> str:
        """Draw a stroke after a pause [s], and return its reading; '' where it is refused."""
        began = self.now + pause
        self.now = began + float(np.ptp(samples[:, 2]))
        try:
            reading = self.session.stroke(samples, '', self.frame.snapshot, began=began)
        except Refusal:
            return ''
        submit_reading(self.simulation, self.session, reading, topic='~/stroke')
        self.frame = self.simulation.apply_requests() or self.frame
        return reading.meaning


def show_several(count: int, half: str) -> None:
    """Print the share of things of several strokes, and of drawings, that become what is meant."""
    print('\nin several strokes, with pauses')
    for number, (name, thing) in enumerate({**THINGS, **JOINTS}.items()):
        rng = np.random.default_rng((SEEDS[half], 2000 + number))
        hits = [_is_right(thing(rng, half), half, rng) for _ in range(count)]
        print(f'{name:<34}{np.mean(hits):7.1%} of {count}')
    rng = np.random.default_rng((SEEDS[half], 3000))
    count = max(count // 2, 10)
    wrong: Counter[str] = Counter()
    misread = [_misread(half, rng) for _ in range(count)]
    for each in misread:
        wrong.update(each)
    right = np.mean([not each for each in misread])
    print(f'{"drawings of ten strokes":<34}{right:7.1%} of {count}   {dict(wrong)}')


def joined_things(count: int, half: str) -> Iterator[tuple[Thing, list[Floats]]]:
    """Yield so many things of each name with their samples, (n, 3) float64: x, y [m], time [s]."""
    for number, draw in enumerate(THINGS.values()):
        rng = np.random.default_rng((SEEDS[half], 4000 + number))
        for _ in range(count):
            thing = draw(rng, half)
            yield thing, list(_samples_of(thing, half, rng))


def _is_right(thing: Thing, half: str, rng: Random) -> bool:
    sheet = Sheet(thing.under)
    for samples in _samples_of(thing, half, rng):
        sheet.draw(samples, rng.uniform(*_WITHIN))
    return thing.right(sheet.frame.snapshot)


def _samples_of(thing: Thing, half: str, rng: Random) -> Iterator[Floats]:
    """Yield the samples of each stroke of a thing, (n, 3) float64: x, y [m], time [s]."""
    somebody = hand(rng, figure_of(thing.paths[0])[0], half)
    whole = _extent(np.vstack(thing.paths))
    for path in thing.paths:
        # The first step of a finger is as long for a barb as for a shaft.
        first_step = min(somebody.first_step * whole / _extent(path), _LONGEST_STEP)
        yield _by_hand(path, replace(somebody, first_step=first_step), rng)


def _by_hand(path: Floats, somebody: Hand, rng: Random) -> Floats:
    """Return the samples of a path that somebody draws where it is."""
    figure, place = figure_of(path)
    return drawn(figure, placed(somebody, path, place, rng), rng)


def _extent(path: Floats) -> float:
    return float(np.hypot(*np.ptp(path, axis=0)))


def _misread(half: str, rng: Random) -> list[str]:
    """Return the misreadings of ten strokes: eight, each in its place, an axle and an x on two."""
    kinds = [figures.disc, figures.disc, figures.rectangle, figures.rectangle, figures.polygon]
    kinds += [figures.line, figures.bent_line, figures.curve]
    order = rng.permutation(len(kinds))
    meant = ['disc', 'disc', 'rectangle', 'rectangle', 'polygon', 'wall', 'wall', 'wall']
    sheet, wrong = Sheet(), []
    person = hand(rng, figures.line(rng), half)
    # Where the first disc and the first rectangle lie, and their sizes [m].
    places: dict[int, tuple[Floats, float]] = {}
    for cell, kind in enumerate(order.tolist()):
        figure = kinds[kind](rng)
        place, size = np.array((5.0 * (cell % 4), 5.0 * (cell // 4))), rng.uniform(1.5, 3.0)
        places[kind] = place, size
        wrong += _drawn_wrong(sheet, figure, person, (place, size), meant[kind], half, rng)
    (place, size), (there, large) = places[0], places[2]
    wrong += _drawn_wrong(sheet, figures.disc(rng), person, (place, 0.2 * size), 'axle', half, rng)
    wrong += _drawn_wrong(
        sheet, figures.cross(rng), person, (there, 0.4 * large), 'anchor', half, rng
    )
    snapshot = sheet.frame.snapshot
    if not wrong and (len(snapshot.scene.bodies), len(snapshot.scene.joints)) != (8, 1):
        wrong.append('count')
    return wrong


def _drawn_wrong(
    sheet: Sheet,
    figure: figures.Figure,
    person: Hand,
    where: tuple[Floats, float],
    meant: str,
    half: str,
    rng: Random,
) -> Iterator[str]:
    """Draw a figure at a place in a size [m], and yield its misreading, if it is one."""
    # Somebody keeps the habits of the screen, and has others anew for each figure.
    somebody = replace(
        hand(rng, figure, half),
        size=where[1],
        place=tuple(where[0].tolist()),
        first_step=person.first_step,
        batch=person.batch,
        dropped=person.dropped,
        simplified=person.simplified,
    )
    read = sheet.draw(drawn(figure, somebody, rng), rng.uniform(*_BETWEEN))
    if read != meant:
        yield f'{meant} > {read or "refused"}'
