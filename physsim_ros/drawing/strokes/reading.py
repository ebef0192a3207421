# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Reading: the likeliest meanings of a stroke in the scene that it was drawn over.

Law: reading changes nothing; a reading holds ordinary requests, to be submitted.

Each form that the stroke may have has a weight, and the scene divides that weight among the
meanings of the form. Meanings are chosen by group: closed outlines are one group, since circles,
ovals and rounded polygons look alike; open lines are another; every sign is a group of its own.
The likeliest group is chosen first, and then the likeliest meaning in it. A stroke is refused when
the confidence in the group is too small.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache

from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes import closed_shapes, open_lines
from physsim_ros.drawing.strokes.evidence import (
    evidence,
    group_confidence,
    LEAST,
    probabilities,
    share_confidence,
)
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.judge import judged
from physsim_ros.drawing.strokes.meanings import (
    CLOSED,
    Context,
    DELETION,
    DISC,
    Form,
    GRAVITY,
    Meaning,
    OPEN,
    Outcome,
    POLYGON,
    RECTANGLE,
)
from physsim_ros.drawing.strokes.signs import SIGNS
from physsim_ros.model.errors import NotRecognised

# The greatest number of guesses that a reading has.
MOST_GUESSES = 3
# The least confidence with which bodies are deleted, and gravity is turned.
SURE = 0.9

# The function from each form to its meanings, by the form's name.
_MEANINGS: dict[str, Callable[[Form, Context], Iterator[Meaning]]] = {
    **{sign.name: sign.meanings for sign in SIGNS},
    open_lines.LINE: open_lines.meanings,
    DISC: closed_shapes.disc_meanings,
    closed_shapes.OVAL: closed_shapes.oval_meanings,
    RECTANGLE: closed_shapes.rectangle_meanings,
    POLYGON: closed_shapes.polygon_meanings,
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Guess:
    """
    A meaning that a stroke may have.

    :param meaning: name of it, as `~/events` reports it: `disc`, `anchor` and so on
    :param confidence: in the meaning: the share of such guesses that are right, 0 .. 1
    :param group_confidence: in its group, 0 .. 1
    :param build: returns the outcome, or raises a Refusal; changes nothing
    """

    meaning: str
    confidence: float
    group_confidence: float
    build: Callable[[], Outcome]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reading(Outcome):
    """
    The meaning that a stroke was read with, and its outcome.

    :param guesses: one to three: first that of the reading, then the others, the likeliest first
    :param amends: numbers of earlier gestures that the requests replace: the stroke was read
        together with earlier ones, or anew
    """

    guesses: tuple[Guess, ...]
    amends: tuple[int, ...] = ()

    @property
    def meaning(self) -> str:
        """Return the meaning: `disc`, `anchor` and so on."""
        return self.guesses[0].meaning

    @property
    def confidence(self) -> float:
        """Return the confidence in the meaning, 0 .. 1."""
        return self.guesses[0].confidence

    @property
    def runner_up(self) -> str:
        """Return the second most likely meaning; '' where there is none."""
        return self.guesses[1].meaning if len(self.guesses) > 1 else ''

    @property
    def runner_up_confidence(self) -> float:
        """Return the confidence in the runner-up, 0 .. 1."""
        return self.guesses[1].confidence if len(self.guesses) > 1 else 0.0

    @property
    def values(self) -> tuple[tuple[str, str], ...]:
        """Return the guesses with their confidences, as pairs of key and value."""
        return _values(self.guesses)


def recognise_form(features: Features) -> tuple[Form, ...]:
    """Return the forms that a stroke may have, by falling weight."""
    signs, plain = _signs(features)
    shapes = [
        *open_lines.forms(features, plain),
        *closed_shapes.forms(features, plain),
    ]
    likely = (each for each in (*signs, *shapes) if each.weight >= LEAST)
    return tuple(sorted(likely, key=lambda each: -each.weight))


def _signs(features: Features) -> tuple[list[Form], float]:
    """Return the form of each sign, and the weight of the stroke being no sign."""
    candidates = [(sign.name, each) for sign in SIGNS for each in sign.candidates(features)]
    weights = probabilities([evidence(name, each.measures) for name, each in candidates])
    best: dict[str, Form] = {}
    for (name, each), weight in zip(candidates, weights, strict=True):
        if name not in best or weight > best[name].weight:
            best[name] = Form(name=name, weight=weight, points=each.points)
    return list(best.values()), 1.0 - sum(weights)


def guess_meanings(forms: Sequence[Form], context: Context) -> tuple[Guess, ...]:
    """
    Return the most likely meanings of a stroke by the rules, and how sure the first one is.

    The confidence in the first one is that of the judge; the others have no more, nor more than it
    leaves.

    :param forms: that the stroke may have, as `recognise_form` returns them
    :param context: the stroke in its scene
    """
    guesses = weigh_meanings(forms, context)
    if not guesses:
        return ()
    first, *others = guesses
    sure = judged(first.confidence, measures_of(guesses, forms, context))
    most = min(sure, 1.0 - sure)
    rest = (replace(each, confidence=min(each.confidence, most)) for each in others)
    return replace(first, confidence=sure), *rest


def measures_of(
    guesses: Sequence[Guess], forms: Sequence[Form], context: Context
) -> dict[str, float]:
    """Return the measures of a reading by which the judge doubts it, by their names."""
    return {
        'confidence': guesses[0].confidence,
        'group': guesses[0].group_confidence,
        'second': guesses[1].confidence if len(guesses) > 1 else 0.0,
        'bodies': float(bool(context.scene.names)),
        f'read as {guesses[0].meaning}': 1.0,
        **{f'form {form.name}': form.weight for form in forms},
    }


def weigh_meanings(forms: Sequence[Form], context: Context) -> tuple[Guess, ...]:
    """
    Return the most likely meanings of a stroke, at most `MOST_GUESSES`, the likeliest first.

    :param forms: that the stroke may have, as `recognise_form` returns them
    :param context: the stroke in its scene
    """
    weights: dict[str, float] = {}
    # Of each meaning, the likeliest one: several forms may have it.
    best: dict[str, Meaning] = {}
    for form in forms:
        for each in _MEANINGS[form.name](form, context):
            if each.weight < LEAST:
                continue
            weights[each.name] = weights.get(each.name, 0.0) + each.weight
            if each.name not in best or each.weight > best[each.name].weight:
                best[each.name] = each
    total = sum(weights.values())
    unexplained = max(1.0 - sum(form.weight for form in forms), 0.0)
    guesses: list[Guess] = []
    for meaning, weight in weights.items():
        others = _group_of(meaning)
        # In the order of the meanings: that of a set differs from process to process.
        group = sum(share for each, share in weights.items() if each in others)
        sure = group_confidence(group, total, unexplained)
        within = share_confidence(weight / group) if len(others) > 1 else 1.0
        guesses.append(
            Guess(
                meaning=meaning,
                confidence=sure * within,
                group_confidence=sure,
                # An outcome is built once, whoever needs it first.
                build=cache(best[meaning].build),
            )
        )
    guesses.sort(key=lambda each: (-each.group_confidence, -each.confidence))
    return tuple(guesses[:MOST_GUESSES])


def _group_of(meaning: str) -> frozenset[str]:
    """Return the group of a meaning."""
    return next((group for group in (CLOSED, OPEN) if meaning in group), frozenset({meaning}))


def not_recognised(guesses: Sequence[Guess]) -> NotRecognised:
    """Return the refusal of a stroke of which no guess is likely enough."""
    return NotRecognised(_doubt(guesses), field='poses', values=_values(guesses))


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
    if guess.meaning in {DELETION, GRAVITY} and guess.group_confidence < SURE:
        return False
    return guess.group_confidence >= settings.sketch_confidence


def _values(guesses: Sequence[Guess]) -> tuple[tuple[str, str], ...]:
    """Return meanings and confidences in them, the likeliest first, as pairs of key and value."""
    keys = (
        ('reading', 'confidence'),
        ('runner_up', 'runner_up_confidence'),
        ('third', 'third_confidence'),
    )
    return tuple(
        pair
        for (name, share), guess in zip(keys, guesses, strict=False)
        for pair in ((name, guess.meaning), (share, f'{guess.confidence:.3f}'))
    )


def _doubt(guesses: Sequence[Guess]) -> str:
    """Return the message about a stroke that was not recognised."""
    if not guesses:
        return 'the stroke looks like nothing that can be drawn'
    words = ' or '.join(f'{guess.meaning} ({guess.confidence:.0%})' for guess in guesses)
    return f'the stroke is not clear enough; it might be: {words}. Nothing was drawn'
