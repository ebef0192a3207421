# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Evidence for signs: log odds, from the measures of a stroke and a table of numbers.

The evidence for a sign is a sum over its measures; each term is a piecewise linear function whose
knots and values are rows of `evidence.csv` (a generalised additive model; Hastie and Tibshirani,
1986). The probability of a sign is the share of its exponential among those of all signs and of
no sign at all, whose evidence is 0 (the conditional logit; McFadden, 1974).

`python -m tools.evaluation.fit` makes the table, from hands of the tuning half of `make evaluate`.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
import csv
from dataclasses import dataclass
from importlib.resources import files
import math

from physsim_ros.model.arrays import Floats

# The file of the table, beside this one, and the name of the measure that is 0 for every stroke.
TABLE, CONSTANT = 'evidence.csv', 'constant'


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Candidate:
    """
    A way in which a stroke may be a sign: with its tail at either end, with either crossing.

    :param measures: of the stroke by name, as the table of the sign has them
    :param points: (n, 2) float64: the points that describe the sign, in the world [m]
    """

    measures: Mapping[str, float]
    points: Floats


@dataclass(frozen=True, slots=True)
class Term:
    """
    A term of the evidence: linear between its knots, constant beyond the first and the last.

    :param measure: name of it
    :param knots: values of the measure, increasing
    :param values: log odds at the knots
    """

    measure: str
    knots: Sequence[float]
    values: Sequence[float]

    def at(self, value: float) -> float:
        """Return the log odds at a value of the measure."""
        knots, values = self.knots, self.values
        after = bisect_right(knots, value)
        if after == 0:
            return values[0]
        if after == len(knots):
            return values[-1]
        start, end = knots[after - 1], knots[after]
        share = (value - start) / (end - start)
        return values[after - 1] + share * (values[after] - values[after - 1])


def terms_of(sign: str) -> Sequence[Term]:
    """Return the terms of the evidence for a sign."""
    return _TABLE[sign]


def evidence(sign: str, measures: Mapping[str, float]) -> float:
    """Return the log odds of a sign against no sign."""
    return sum(term.at(measures.get(term.measure, 0.0)) for term in terms_of(sign))


def probabilities(evidences: Sequence[float]) -> list[float]:
    """Return the probability of each alternative; the rest to 1 is that of no sign."""
    greatest = max((0.0, *evidences))
    odds = [math.exp(each - greatest) for each in evidences]
    total = math.exp(-greatest) + sum(odds)
    return [each / total for each in odds]


def _read_table() -> dict[str, list[Term]]:
    table: dict[str, list[Term]] = {}
    path = files(__package__) / TABLE
    for row in csv.DictReader(path.read_text('utf-8').splitlines()):
        knots, values = (tuple(map(float, row[column].split())) for column in ('knots', 'values'))
        table.setdefault(row['sign'], []).append(Term(row['measure'], knots, values))
    return table


_TABLE = _read_table()
