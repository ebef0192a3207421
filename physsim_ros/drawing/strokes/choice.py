# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The choice among the meanings of a stroke: its guesses, and the reading of one of them.

Law: a guess changes nothing; the requests of its reading are to be submitted.

A weight becomes a confidence, the share of guesses of that weight that are right, by Platt scaling
(Platt, 1999): a logistic function of the log odds of the weight against the others. By it strokes
are refused; how sure a reading is, `judge` tells. The constants of the confidence were fitted to
the tuning half of `make evaluate`, all kinds and all faults, by maximum likelihood; that command
prints how well they hold.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache

from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.evidence import log_odds, logistic
from physsim_ros.drawing.strokes.stages import (
    CLOSED,
    confidences_in,
    Guess,
    Meaning,
    MeaningKind,
    MOST_GUESSES,
    OPEN,
    Reading,
)
from physsim_ros.model.errors import NotRecognised

# Weight of the possibility that a stroke means nothing, and the share of the weight that no form
# has that adds to it.
_DOUBT, _UNEXPLAINED = 0.02, 0.3
# Log odds of a group being right at equal weights, and their growth with the log odds of weights.
_GROUP_BIAS, _GROUP_SLOPE = -0.4, 1.9
# Meanings that destroy what was drawn before, or change the whole world; the least confidence in
# them.
_DRASTIC, _SURE = frozenset({MeaningKind.DELETION, MeaningKind.GRAVITY}), 0.9


def guesses_among(meanings: Iterable[Meaning], unexplained: float) -> tuple[Guess, ...]:
    """
    Return the most likely meanings of a stroke, at most `MOST_GUESSES`, the likeliest first.

    :param unexplained: the weight that no form of the stroke has, 0 .. 1
    """
    weights: dict[MeaningKind, float] = {}
    # Of each meaning, the likeliest one.
    best: dict[MeaningKind, Meaning] = {}
    for each in meanings:
        weights[each.kind] = weights.get(each.kind, 0.0) + each.weight
        if each.kind not in best or each.weight > best[each.kind].weight:
            best[each.kind] = each
    total = sum(weights.values())
    guesses: list[Guess] = []
    for meaning, weight in weights.items():
        others = _group_of(meaning)
        # In the order of the meanings: that of a set differs from process to process.
        group = sum(share for each, share in weights.items() if each in others)
        sure = group_confidence(group, total, unexplained)
        guesses.append(
            Guess(
                meaning=meaning,
                confidence=sure * weight / group,
                group_confidence=sure,
                # An outcome is built once, whoever needs it first.
                build=cache(best[meaning].build),
            )
        )
    guesses.sort(key=lambda each: (-each.group_confidence, -each.confidence))
    return tuple(guesses[:MOST_GUESSES])


def group_confidence(weight: float, total: float, unexplained: float = 0.0) -> float:
    """
    Return the confidence in a group of meanings, 0 .. 1.

    :param weight: of the group
    :param total: of all groups
    :param unexplained: the weight that no form of the stroke has, 0 .. 1
    """
    doubt = _DOUBT + _UNEXPLAINED * unexplained
    return logistic(_GROUP_BIAS + _GROUP_SLOPE * log_odds(weight / (total + doubt)))


def _group_of(meaning: MeaningKind) -> frozenset[MeaningKind]:
    """Return the group of a meaning."""
    return next((group for group in (CLOSED, OPEN) if meaning in group), frozenset({meaning}))


def not_recognised(guesses: Sequence[Guess]) -> NotRecognised:
    """Return the refusal of a stroke of which no guess is likely enough."""
    template = 'the stroke looks like nothing that can be drawn'
    if guesses:
        template = 'the stroke is not clear enough; it might be: {words}. Nothing was drawn'
    words = ' or '.join(f'{guess.meaning} ({guess.confidence:.0%})' for guess in guesses)
    return NotRecognised(template, field='poses', guesses=confidences_in(guesses), words=words)


def reading_of(guesses: Sequence[Guess], number: int, *, amends: tuple[int, ...] = ()) -> Reading:
    """
    Return the reading of one of the guesses.

    :param amends: numbers of earlier gestures that it replaces
    :raises Refusal: the world cannot have its outcome
    """
    chosen = guesses[number]
    outcome = chosen.build()
    return Reading(
        guesses=(chosen, *(guess for guess in guesses if guess is not chosen)),
        amends=amends,
        requests=outcome.requests,
        subject=outcome.subject,
        message=outcome.message,
        outline=outcome.outline,
    )


def is_likely(guesses: Sequence[Guess], settings: DrawingSettings) -> bool:
    """Tell whether the first of some guesses is likely enough to be built."""
    if not guesses:
        return False
    guess = guesses[0]
    if guess.meaning in _DRASTIC and guess.group_confidence < _SURE:
        return False
    return guess.group_confidence >= settings.sketch_confidence
