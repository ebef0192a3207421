# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`python -m tools.evaluation.fit`: the table of evidence for signs and shapes, from imitated hands.

A conditional logit whose terms are piecewise linear, fitted by Newton's method to strokes of the
tuning half: the likelihood of the sign that was meant, and of its tail, less a penalty on the
curvature of the terms and on their size. The evidence for the shapes of outlines is fitted by
itself. No stroke by people is among them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import csv
from dataclasses import dataclass
from io import StringIO
import itertools
from pathlib import Path
import sys

import numpy as np
from physsim_ros.drawing.strokes import evidence
from physsim_ros.drawing.strokes.evidence import CONSTANT, TABLE
from physsim_ros.drawing.strokes.features import features_of
from physsim_ros.drawing.strokes.joining import joined_arrow, joined_strokes
from physsim_ros.drawing.strokes.plain_forms import ELLIPSE, fits_of, SHAPES
from physsim_ros.drawing.strokes.signs import SIGNS
from physsim_ros.drawing.strokes.stages import Candidate, RECTANGLE
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.model.arrays import Flags
from physsim_ros.model.errors import Refusal

from .outlines import Floats
from .scenes import faulty_scenes, OUTLINES, Scene, scenes
from .several import joined_things

# Strokes of each kind and of each fault, and things of several strokes.
_COUNT = 100
# Outlines of each kind, for one of each fault: as many rectangles as other polygons of all kinds,
# since planks and boxes are drawn more often than other solids with corners.
_OUTLINES, _RECTANGLES = 3, 9
# Knots of a term: quantiles of its measure among all candidates, and among those that were meant.
_EVERY, _MEANT = (0.02, 0.25, 0.5, 0.75, 0.98), (0.02, 0.15, 0.85, 0.98)
# Weights of the penalties on the second differences of a term's values, and on the values.
_CURVED, _LARGE = 1.0, 0.1
# Rounds of Newton's method.
_ROUNDS = 10
# Names of the signs, by the kinds of figures.
_NAMES = tuple(sign.name for sign in SIGNS)

# A row of the table: sign or shape, measure, knots and values.
Row = tuple[str, str, Floats, Floats]


@dataclass(frozen=True, slots=True, kw_only=True)
class Example:
    """
    A stroke with its candidates.

    :param candidates: of all signs or shapes, with the name of each
    :param meant: the index of the candidate that was meant; None where it was none
    """

    candidates: list[tuple[str, Candidate]]
    meant: int | None

    def chose(self, candidates: list[tuple[str, Candidate]]) -> bool:
        """Return whether one of some candidates was meant."""
        return self.meant is not None and any(
            each is self.candidates[self.meant] for each in candidates
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """
    The candidates of one place: of a sign, the first of each stroke, or the second.

    :param basis: (n, k) float64: the shares of the sign's k numbers in the evidence of each stroke
    :param columns: where these numbers are among all
    :param there: (n,) bool: the strokes that have this candidate
    :param meant: (n,) bool: those of which it was meant
    """

    basis: Floats
    columns: slice
    there: Flags
    meant: Flags


def examples(count: int, half: str) -> Iterator[Example]:
    """Yield strokes of all kinds, so many of each, with their candidates for signs."""
    for scene in itertools.chain(scenes(count, half), faulty_scenes(count, half)):
        samples, figure = scene.samples, scene.figure
        # The pen is where the tail is at its first or its last sample.
        try:
            yield _example(samples, figure.kind, samples[figure.tail, :2])
        except Refusal:
            continue
    for thing, strokes in joined_things(count, half):
        paths = [resample_stroke(each).points for each in strokes]
        arrow = joined_arrow(paths)
        whole = joined_strokes(paths) if arrow is None else arrow
        yield _example(whole, thing.kind, whole[0] if thing.tail is None else thing.tail)


def outlines(count: int, half: str) -> Iterator[Example]:
    """Yield outlines of all kinds, so many with each fault, with their candidates for shapes."""
    faulty = faulty_scenes(count, half, OUTLINES)
    for scene in itertools.chain(*_plain_outlines(count, half), faulty):
        try:
            outline = resample_stroke(scene.samples).outline
        except Refusal:
            continue
        candidate = Candidate(measures=fits_of(outline).measures, points=outline)
        shape = ELLIPSE if scene.figure.smooth else scene.figure.kind
        meant = SHAPES.index(shape) if shape in SHAPES else None
        yield Example(candidates=[(name, candidate) for name in SHAPES], meant=meant)


def _plain_outlines(count: int, half: str) -> Iterator[Iterator[Scene]]:
    for kind in OUTLINES:
        times = _RECTANGLES if kind.meaning == RECTANGLE else _OUTLINES
        yield scenes(times * count, half, (kind,))


def _example(samples: Floats, kind: str, tail: Floats) -> Example:
    features = features_of(resample_stroke(samples))
    candidates = [(sign.name, each) for sign in SIGNS for each in sign.candidates(features)]
    right = [number for number, (name, _) in enumerate(candidates) if name == kind]
    if 'arrow' in kind:
        # Of both directions, that from the tail; behind the centre of a round arrow is its tail.
        first = int(kind == 'round arrow')
        right.sort(key=lambda each: float(np.hypot(*(candidates[each][1].points[first] - tail))))
    return Example(candidates=candidates, meant=right[0] if right else None)


def fit(names: Sequence[str], strokes: list[Example]) -> list[Row]:
    """Return the rows of the table of the signs or shapes with these names."""
    rows: list[tuple[str, str, Floats]] = []
    blocks: list[Block] = []
    start = 0
    for name in names:
        own = [[each for each in stroke.candidates if each[0] == name] for stroke in strokes]
        places = range(max(map(len, own)))
        there = [np.array([len(each) > place for each in own]) for place in places]
        meant = [
            np.array(
                [
                    stroke.chose(each[slice(place, place + 1)])
                    for stroke, each in zip(strokes, own, strict=True)
                ]
            )
            for place in places
        ]
        bases: list[list[Floats]] = [[] for _ in places]
        for measure in (CONSTANT, *max(own, key=len)[0][1].measures):
            values = [_values(own, measure, place) for place in places]
            every, right = np.concatenate(values), np.concatenate(meant)
            knots = _knots(every[np.concatenate(there)], every[right])
            rows.append((name, measure, knots))
            for basis, column in zip(bases, values, strict=True):
                basis += [np.interp(column, knots, each) for each in np.eye(len(knots))]
        columns = slice(start, start + len(bases[0]))
        start = columns.stop
        blocks += [
            Block(basis=np.column_stack(basis), columns=columns, there=present, meant=right)
            for basis, present, right in zip(bases, there, meant, strict=True)
        ]
    values = _newton(blocks, [_penalty(len(knots)) for _, _, knots in rows])
    ends = np.cumsum([len(knots) for _, _, knots in rows])
    parts = np.split(values, ends[:-1])
    return [(*row, part) for row, part in zip(rows, parts, strict=True)]


def _values(own: list[list[tuple[str, Candidate]]], measure: str, place: int) -> Floats:
    """Return a measure of the candidate at a place for each stroke; 0 where there is none."""
    return np.array(
        [each[place][1].measures.get(measure, 0.0) if len(each) > place else 0.0 for each in own]
    )


def _knots(every: Floats, meant: Floats) -> Floats:
    """Return quantiles of a measure among all candidates and among those that were meant."""
    return np.unique(
        np.round(np.quantile(every, _EVERY).tolist() + np.quantile(meant, _MEANT).tolist(), 4)
    )


def _penalty(count: int) -> Floats:
    second = np.diff(np.eye(count), n=2, axis=0) if count > 2 else np.zeros((0, count))
    return np.asarray(_CURVED * second.T @ second + _LARGE * np.eye(count))


def _newton(blocks: list[Block], penalties: list[Floats]) -> Floats:
    """Return the numbers of greatest penalised likelihood."""
    size = sum(map(len, penalties))
    penalty, at = np.zeros((size, size)), 0
    for each in penalties:
        own = slice(at, at + len(each))
        penalty[own, own] = each
        at += len(each)
    found = np.zeros(size)
    for _ in range(_ROUNDS):
        utility = np.array(
            [np.where(b.there, b.basis @ found[b.columns], -np.inf) for b in blocks]
        )
        odds = np.exp(utility - np.maximum(utility.max(axis=0), 0.0))
        share = odds / (odds.sum(axis=0) + np.exp(-np.maximum(utility.max(axis=0), 0.0)))
        gradient, hessian = -penalty @ found, penalty.copy()
        for one, p in zip(blocks, share, strict=True):
            gradient[one.columns] += one.basis.T @ (one.meant - p)
            hessian[one.columns, one.columns] += one.basis.T @ (p[:, None] * one.basis)
            for other, q in zip(blocks, share, strict=True):
                hessian[one.columns, other.columns] -= one.basis.T @ (
                    (p * q)[:, None] * other.basis
                )
        found = found + np.linalg.solve(hessian, gradient)
    return found


def table(count: int = _COUNT) -> str:
    """Return the table, fitted to so many strokes of each kind."""
    file = StringIO()
    writer = csv.writer(file, lineterminator='\n')
    writer.writerow(('sign', 'measure', 'knots', 'values'))
    signs = fit(_NAMES, list(examples(count, 'tuning')))
    shapes = fit(SHAPES, list(outlines(count, 'tuning')))
    for sign, measure, knots, values in signs + shapes:
        writer.writerow((sign, measure, _text(knots, 4), _text(values, 2)))
    return file.getvalue()


def _text(numbers: Floats, digits: int) -> str:
    return ' '.join(f'{each:.{digits}f}' for each in numbers.tolist())


if __name__ == '__main__':
    Path(evidence.__file__).with_name(TABLE).write_text(table(*map(int, sys.argv[1:])), 'utf-8')
