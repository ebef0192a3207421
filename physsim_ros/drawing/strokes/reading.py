# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Reading: the likeliest meanings of a stroke in the scene that it was drawn over.

Law: reading changes nothing; a reading holds ordinary requests, to be submitted.

A stroke is read in stages, each a function of what the one before it returns:

==========================  ======================  ============================================
stage                       returns                 which is
==========================  ======================  ============================================
`stroke.resample_stroke`    `Stroke`                samples cleaned and evenly spaced
`features.features_of`      `Features`              its turns, swings and crossings
`forms.forms_of`            `Form` of each kind     its looks, each with a weight
`reading.meanings_of`       `Meaning` of each form  what that would be in this scene
`reading.guesses_by_rules`  `Guess`, at most three  the meanings by falling confidence
`reading.guesses_of`        the same                how sure the first one is, by the judge
`reading.reading_of`        `Reading`               requests, and the words about them
==========================  ======================  ============================================

The scene divides the weight of a form among the meanings of the form. Meanings are chosen by
group: closed outlines are one group, since circles, ovals and rounded polygons look alike; open
lines are another; every sign is a group of its own. The likeliest group is chosen first, and then
the likeliest meaning in it. A stroke is refused when the confidence in the group is too small.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes import closed_shapes, open_lines
from physsim_ros.drawing.strokes.bodies_under import joint_ends, wheels_passed
from physsim_ros.drawing.strokes.evidence import (
    Form,
    group_confidence,
    LEAST,
)
from physsim_ros.drawing.strokes.features import Features, features_of
from physsim_ros.drawing.strokes.forms import forms_of
from physsim_ros.drawing.strokes.judge import judged
from physsim_ros.drawing.strokes.meanings import (
    BETWEEN,
    CLOSED,
    Context,
    DELETION,
    GRAVITY,
    Meaning,
    OPEN,
    Outcome,
)
from physsim_ros.drawing.strokes.plain_forms import DISC, LINE, OVAL, POLYGON, RECTANGLE
from physsim_ros.drawing.strokes.signs import SIGNS
from physsim_ros.drawing.strokes.stroke import Stroke
from physsim_ros.model.errors import NotRecognised

# The greatest number of guesses that a reading has.
MOST_GUESSES = 3
# The least confidence with which bodies are deleted, and gravity is turned.
_SURE = 0.9

# The function from each form to its meanings, by the form's name.
_MEANINGS: dict[str, Callable[[Form, Context], Iterator[Meaning]]] = {
    **{sign.name: sign.meanings for sign in SIGNS},
    LINE: open_lines.meanings,
    DISC: closed_shapes.disc_meanings,
    OVAL: closed_shapes.oval_meanings,
    RECTANGLE: closed_shapes.rectangle_meanings,
    POLYGON: closed_shapes.polygon_meanings,
}
# Forms that enclose an area.
_OUTLINES = frozenset({DISC, OVAL, RECTANGLE, POLYGON})


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
    :param also: meanings that earlier strokes now have, over its new body
    """

    guesses: tuple[Guess, ...]
    amends: tuple[int, ...] = ()
    also: tuple[str, ...] = ()

    @property
    def meaning(self) -> str:
        """Return the meaning: `disc`, `anchor` and so on."""
        return self.guesses[0].meaning

    @property
    def confidence(self) -> float:
        """Return the confidence in the meaning, 0 .. 1."""
        return self.guesses[0].confidence

    @property
    def values(self) -> tuple[tuple[str, str], ...]:
        """Return the guesses with their confidences, as pairs of key and value."""
        return _values(self.guesses)


def in_scene(
    stroke: Stroke,
    scene: SceneQuery,
    settings: DrawingSettings,
    forms_of: Callable[[Features], Sequence[Form]] = forms_of,
) -> Context:
    """Return a stroke with its features and forms in the scene that it was drawn over."""
    features = features_of(stroke)
    forms = forms_of(features)
    ends = joint_ends(stroke.points, scene, settings.snap)
    return Context(
        features=features,
        forms=forms,
        scene=scene,
        settings=settings,
        ends=ends,
        wheels=wheels_passed(stroke.points, ends, scene, settings.snap) if ends else (),
    )


def meanings_of(context: Context) -> Iterator[Meaning]:
    """Yield the meanings of all forms of a stroke; several forms may have the same one."""
    rope = open_lines.rope_around_wheels(context) if context.wheels else None
    for form in context.forms:
        found = _MEANINGS[form.name](form, context)
        if rope is not None and form.name in _OUTLINES:
            # A line from body to body that runs around a wheel encloses nothing.
            yield replace(rope, weight=form.weight * BETWEEN)
            found = (replace(each, weight=each.weight * (1.0 - BETWEEN)) for each in found)
        yield from (each for each in found if each.weight >= LEAST)


def guesses_of(context: Context) -> tuple[Guess, ...]:
    """
    Return the most likely meanings of a stroke by the rules, and how sure the first one is.

    The confidence in the first one is that of the judge; the others have no more, nor more than it
    leaves.
    """
    guesses = guesses_by_rules(context)
    if not guesses:
        return ()
    first, *others = guesses
    sure = judged(first.confidence, measures_of(guesses, context))
    most = min(sure, 1.0 - sure)
    rest = (replace(each, confidence=min(each.confidence, most)) for each in others)
    return replace(first, confidence=sure), *rest


def measures_of(guesses: Sequence[Guess], context: Context) -> dict[str, float]:
    """Return the measures of a reading by which the judge doubts it, by their names."""
    return {
        'confidence': guesses[0].confidence,
        'group': guesses[0].group_confidence,
        'second': guesses[1].confidence if len(guesses) > 1 else 0.0,
        'bodies': float(bool(context.scene.names)),
        f'read as {guesses[0].meaning}': 1.0,
        **{f'form {form.name}': form.weight for form in context.forms},
        **{name: value for form in context.forms for name, value in form.measures.items()},
    }


def guesses_by_rules(context: Context) -> tuple[Guess, ...]:
    """Return the most likely meanings of a stroke, at most `MOST_GUESSES`, the likeliest first."""
    weights: dict[str, float] = {}
    # Of each meaning, the likeliest one.
    best: dict[str, Meaning] = {}
    for each in meanings_of(context):
        weights[each.name] = weights.get(each.name, 0.0) + each.weight
        if each.name not in best or each.weight > best[each.name].weight:
            best[each.name] = each
    total = sum(weights.values())
    unexplained = max(1.0 - sum(form.weight for form in context.forms), 0.0)
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


def _group_of(meaning: str) -> frozenset[str]:
    """Return the group of a meaning."""
    return next((group for group in (CLOSED, OPEN) if meaning in group), frozenset({meaning}))


def not_recognised(guesses: Sequence[Guess]) -> NotRecognised:
    """Return the refusal of a stroke of which no guess is likely enough."""
    words = ' or '.join(f'{guess.meaning} ({guess.confidence:.0%})' for guess in guesses)
    doubt = f'is not clear enough; it might be: {words}. Nothing was drawn'
    message = f'the stroke {doubt if guesses else "looks like nothing that can be drawn"}'
    return NotRecognised(message, field='poses', values=_values(guesses))


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
    if guess.meaning in {DELETION, GRAVITY} and guess.group_confidence < _SURE:
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
