# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`make evaluate`: how well strokes are read, by hands that were not there when limits were chosen.

`make evaluate ARGS='300 tuning'` chooses the strokes of each kind and the half: `report`,
`tuning`, by which limits are chosen, `apart`, hands of another kind, or `strangers`, hands and
arrows of a third kind with which nothing was chosen.
"""

from __future__ import annotations

from collections import Counter, defaultdict
import itertools
import statistics
import sys
from test.drawing.machines import LAWS, Machine, strokes_of
from test.drawing.single_stroke import interpret_stroke
import time

import numpy as np
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.forms import classification_of
from physsim_ros.drawing.strokes.stages import MeaningKind
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.model.errors import Refusal

from .people import drawn_by, PEOPLE
from .scenes import faulty_scenes, MEANINGS, Scene, scenes
from .several import show_several

CLOSED = ('disc', 'rectangle', 'polygon')
SETTINGS = DrawingSettings()
_REFUSED = 'refused'
# Bounds of the classes of confidence.
_BOUNDS = (0.0, 0.5, 0.7, 0.9, 0.95, 0.99, 1.0)


class Reliability:
    """
    Reliability of confidence: of the readings said to be so sure, how many are right.

    The area under the curve (AUC) is the chance that a right reading has more confidence than a
    wrong one.
    """

    def __init__(self) -> None:
        self._confidences: list[float] = []
        self._right: list[bool] = []

    def add(self, confidence: float, *, right: bool) -> None:
        """Add a reading."""
        self._confidences.append(confidence)
        self._right.append(right)

    def show(self, where: str) -> None:
        """Print a row for each class of confidence, and the area under the curve."""
        confidences, right = np.array(self._confidences), np.array(self._right)
        print(f'\n{f"{where}, said to be sure by":<34}{"mean":>8}{"right":>8}')
        for low, high in itertools.pairwise(_BOUNDS):
            rows = (confidences > low) & (confidences <= high)
            if rows.any():
                name = f'{low:.0%} to {high:.0%}'
                said, true = confidences[rows].mean(), right[rows].mean()
                print(f'{name:<34}{said:8.1%}{true:8.1%} of {rows.sum()}')
        print(f'{"AUC of right against wrong":<34}{self.auc():8.2f}\n')

    def auc(self) -> float:
        """Return the area under the curve, 0 .. 1; ties count half."""
        confidences, right = np.array(self._confidences), np.array(self._right)
        wrong, well = np.sort(confidences[~right]), confidences[right]
        if not len(wrong) or not len(well):
            return 1.0
        below = np.searchsorted(wrong, well, 'left'), np.searchsorted(wrong, well, 'right')
        return float(np.mean(below) / len(wrong))


class Tally:
    """Counts of the readings of strokes, right and wrong."""

    def __init__(self) -> None:
        self.readings: dict[str, Counter[str]] = defaultdict(Counter)
        self.right: dict[str, list[bool]] = defaultdict(list)
        self.faulty: dict[str, list[bool]] = defaultdict(list)
        self.corners: dict[str, list[bool]] = defaultdict(list)
        # Whether a stroke kept 85 % of its size, by its name.
        self.whole: list[bool] = []
        self.milliseconds: list[float] = []
        self.reliability = {name: Reliability() for name in ('in the open', 'with bodies')}
        # Readings that destroyed something or turned gravity, and were not meant to.
        self.harm = 0

    def add(self, scene: Scene) -> None:
        """Read the stroke of a scene."""
        begun = time.process_time_ns()
        confidence = 0.0
        try:
            reading = interpret_stroke(scene.samples, scene.view, SETTINGS)
            what, confidence = reading.meaning, reading.confidence
        except Refusal:
            what = _REFUSED
        self.milliseconds.append((time.process_time_ns() - begun) / 1e6)
        if what != _REFUSED and scene.meaning is not None:
            where = 'with bodies' if scene.view.names else 'in the open'
            self.reliability[where].add(confidence, right=what == scene.meaning)
        self.harm += what in {MeaningKind.DELETION, MeaningKind.GRAVITY} and what != scene.meaning
        if scene.fault in _ALL_DRAWN:
            drawn = float(np.hypot(*np.ptp(scene.samples[:, :2], axis=0)))
            self.whole.append(resample_stroke(scene.samples).size > 0.85 * drawn)
        if scene.fault:
            self.faulty[scene.fault].append(what == scene.meaning)
            return
        self.readings[scene.name][what] += 1
        if scene.meaning is None:
            return
        right = what == scene.meaning
        group = 'signs' if scene.meaning in _SIGNS else 'shapes and lines'
        self.right[group].append(right)
        self.right['all'].append(right)
        if scene.name in CLOSED and what in CLOSED:
            self.right['disc or polygon'].append((what == 'disc') == (scene.name == 'disc'))
        if scene.name in _CORNERED:
            found = classification_of(resample_stroke(scene.samples)).forms
            exact = bool(found) and len(found[0].points) == scene.figure.corners
            self.corners[_CORNERED[scene.name]].append(exact)

    def show(self) -> None:
        """Print the tables."""
        columns = [*MEANINGS, _REFUSED]
        print(f'{"drawn":<24}' + ''.join(f'{column[:9]:>10}' for column in columns))
        for name, counts in self.readings.items():
            cells = (f'{counts[column] or "·":>10}' for column in columns)
            print(f'{name:<24}' + ''.join(cells))
        print()
        for name, hits in self.faulty.items():
            print(f'{"fault: " + name:<34}{statistics.fmean(hits):7.1%} of {len(hits)}')
        print()
        for name, hits in self.right.items():
            print(f'{name + " read right":<34}{statistics.fmean(hits):7.1%} of {len(hits)}')
        print(f'{"no more than 15 % cut off":<34}{statistics.fmean(self.whole):7.1%}')
        for name, hits in self.corners.items():
            print(f'{f"corners exact, {name}":<34}{statistics.fmean(hits):7.1%} of {len(hits)}')
        print(f'{"deletions and gravity by error":<34}{self.harm:7}')
        for where, reliability in self.reliability.items():
            reliability.show(where)
        worst = statistics.quantiles(self.milliseconds, n=100)[-1]
        middle = statistics.median(self.milliseconds)
        print(f'{"CPU time of a stroke":<34}{middle:7.2f} ms median, {worst:.2f} ms 99th of 100')


# Without these faults, all samples of a stroke were meant.
_ALL_DRAWN = ('', 'a finger on a tablet', 'a finger on a busy page', 'few samples', 'simplified')
_CORNERED = {
    'rectangle': 'closed',
    'polygon': 'closed',
    'line': 'open',
    'bent line': 'open',
    'check, caret, V': 'open',
    'bracket': 'open',
}
_SIGNS = ('anchor', 'axle', 'deletion', 'gravity', 'spring', 'velocity')


def main(arguments: list[str]) -> None:
    """Read all strokes of a half and print what became of them."""
    count = int(arguments[0]) if arguments else 300
    half = arguments[1] if len(arguments) > 1 else 'report'
    tally = Tally()
    for scene in scenes(count, half):
        tally.add(scene)
    for scene in faulty_scenes(count, half):
        tally.add(scene)
    print(f'{count} strokes of each kind, half `{half}`\n')
    tally.show()
    show_several(count, half)
    show_machines(half)


def show_machines(half: str) -> None:
    """Print the share of shipped drawings that run when people of a half draw them."""
    print('\ndrawings that run, of ten people each')
    total: list[bool] = []
    for name, law in LAWS.items():
        runs, failed = [], []
        for person in PEOPLE:
            try:
                law(Machine(drawn_by(person, strokes_of(name), half=half)))
            except (AssertionError, Refusal):
                failed.append(person)
            runs.append(person not in failed)
        total += runs
        print(f'{name:<34}{statistics.fmean(runs):7.1%} {", ".join(failed)}')
    print(f'{"all":<34}{statistics.fmean(total):7.1%} of {len(total)}')


main(sys.argv[1:])
