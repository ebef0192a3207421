# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The evidence for signs and shapes, and soft limits by which lines and outlines share a weight.

The evidence for a sign is a sum over its measures; each term is a piecewise linear function whose
knots and values are rows of `evidence.csv` (a generalised additive model; Hastie and Tibshirani,
1986). The probability of a sign is the share of its exponential among those of all signs and of
no sign at all, whose evidence is 0 (the conditional logit; McFadden, 1974). So are outlines told
to be ellipses or rectangles, and not other polygons.

`python -m tools.evaluation.fit` makes the table, from hands of the tuning half of `make evaluate`.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
import csv
from dataclasses import dataclass
from importlib.resources import files
import math

# The file of the table, beside this one, and the name of the measure that is 0 for every stroke.
TABLE, CONSTANT = 'evidence.csv', 'constant'
# Forms and meanings of a lower weight are dropped, and no share is nearer to 0 or 1, so that log
# odds are finite. A rival of a hundredth tells right readings from wrong ones.
LEAST = 0.002
# Width of a soft limit, in shares of it: with 0.1, the line of a rope up, over a wheel and down,
# whose ends lie 14 % of its length apart, is too nearly an outline to be read.
_SOFT = 0.075


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


@dataclass(frozen=True, slots=True)
class Limit:
    """
    A soft limit of a measure, by which lines and outlines share their weight.

    At `_SOFT` beyond the limit, the better side has 73 % of the weight.

    :param at: value of the measure at which either side has half the weight, > 0
    """

    at: float

    def above(self, value: float) -> float:
        """Return the weight of being above: 0 far below the limit, 1 far above."""
        return logistic((value / self.at - 1.0) / _SOFT)

    def below(self, value: float) -> float:
        """Return the weight of being below: 1 far below the limit, 0 far above."""
        return 1.0 - self.above(value)


def logistic(odds: float) -> float:
    """Return the share that has such log odds."""
    return 1.0 / (1.0 + math.exp(min(max(-odds, -50.0), 50.0)))


def log_odds(share: float) -> float:
    """Return the log odds of a share, 0 .. 1."""
    share = min(max(share, LEAST), 1.0 - LEAST)
    return math.log(share / (1.0 - share))


def terms_of(sign: str) -> Sequence[Term]:
    """Return the terms of the evidence for a sign or shape."""
    return _TABLE[sign]


def evidence(sign: str, measures: Mapping[str, float]) -> float:
    """Return the log odds of a sign against no sign, or of a shape against other polygons."""
    return sum(term.at(measures.get(term.measure, 0.0)) for term in terms_of(sign))


def probabilities(evidences: Sequence[float]) -> list[float]:
    """Return the probability of each alternative; the rest to 1 is that of none of them."""
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
