# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The results of the stages of reading a stroke; `reading` has the order of these."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.stroke import Stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Confidences
from physsim_ros.model.requests import Request
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import Text

# Names of the forms.
LINE, DISC, OVAL, RECTANGLE, POLYGON = 'line', 'disc', 'oval', 'rectangle', 'polygon'
# Factor on the weight of a sign that was drawn where there is nothing that it could change: a
# meaning that can be carried out is taken before it.
MISPLACED = 0.5
# Share of the weight of a line between two bodies that is a joint's; the rest is a wall's.
BETWEEN = 0.98
# The greatest number of guesses that a reading has.
MOST_GUESSES = 3


class MeaningKind(StrEnum):
    """The kinds of meanings; the value is the word in `~/events` and on pages."""

    DISC = 'disc'
    RECTANGLE = 'rectangle'
    POLYGON = 'polygon'
    AXLE = 'axle'
    PIN = 'pin'
    WALL = 'wall'
    ROD = 'rod'
    ROPE = 'rope'
    CHAIN = 'chain'
    SPRING = 'spring'
    HATCHING = 'hatching'
    ANCHOR = 'anchor'
    DELETION = 'deletion'
    MOTOR = 'motor'
    VELOCITY = 'velocity'
    GRAVITY = 'gravity'
    MARK = 'mark'


# Bodies of their own.
SOLIDS = frozenset({MeaningKind.DISC, MeaningKind.RECTANGLE, MeaningKind.POLYGON})
# Groups of meanings: a stroke is more clearly closed or open than a certain one of these meanings.
# Every other meaning is a group of its own.
CLOSED = SOLIDS | {MeaningKind.AXLE, MeaningKind.PIN}
OPEN = frozenset(
    {
        MeaningKind.WALL,
        MeaningKind.ROD,
        MeaningKind.ROPE,
        MeaningKind.CHAIN,
        MeaningKind.SPRING,
        MeaningKind.HATCHING,
    }
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Candidate:
    """
    A stroke as a sign: with its tail at one of both ends, with one of its crossings.

    :param measures: of the stroke by name, as the table of the sign has them
    :param points: (n, 2) float64: the points that describe the sign, in the world [m]
    """

    measures: Mapping[str, float]
    points: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Form:
    """
    A form that a stroke may have.

    :param name: name of the form: `disc`, `line`, `arrow` and so on; its module defines it
    :param weight: how well the stroke fits the form, 0 .. 1
    :param points: (n, 2) float64: the points that describe the form, in the world [m]
    """

    name: str
    weight: float
    points: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Classification:
    """
    A stroke with the forms that it may have, whatever it was drawn over.

    :param features: of the stroke
    :param forms: by falling weight
    :param fits: measures of the fits to its outline, by name; {} where no form is an outline
    """

    features: Features
    forms: Sequence[Form]
    fits: Mapping[str, float] = field(default_factory=dict)

    @property
    def unexplained(self) -> float:
        """Return the weight that no form has, 0 .. 1."""
        return max(1.0 - sum(form.weight for form in self.forms), 0.0)


@dataclass(frozen=True, slots=True)
class End:
    """
    An end of a joint.

    :param point: in the world [m]
    :param body: name of the body, or 'world' for the background
    """

    point: Point
    body: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Context:
    """
    A stroke in the scene that it was drawn over.

    :param features: of the stroke
    :param scene: the world that it was drawn over
    :param settings: of drawing
    :param ends: of a joint between the bodies at its ends, the first on a dynamic body; None where
        no joint can be there
    :param wheels: that it runs around as a rope between these ends, in its order, and where [m]
    """

    features: Features
    scene: SceneQuery
    settings: DrawingSettings
    ends: tuple[End, End] | None
    wheels: Sequence[tuple[str, Point]]

    @property
    def drawn(self) -> Stroke:
        """Return the stroke."""
        return self.features.stroke


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outcome:
    """
    The requests of a stroke, with words and a line that tell about them.

    :param requests: to be submitted, in this order
    :param subject: the body or joint concerned; '' where there is none or there are several
    :param message: one sentence about the requests
    :param outline: (n, 2) float64: the regularised stroke for the preview; the first point
        repeated where it is closed [m]
    """

    requests: tuple[Request, ...]
    subject: str
    message: Text
    outline: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Meaning:
    """
    A meaning that a stroke may have.

    :param kind: of meaning
    :param weight: likelihood, not yet normalised
    :param build: returns the outcome, or raises a Refusal
    """

    kind: MeaningKind
    weight: float
    build: Callable[[], Outcome]


@dataclass(frozen=True, slots=True, kw_only=True)
class Sign:
    """
    A sign: a form that is told from lines and outlines by evidence.

    :param name: of the form, and of its rows in the table of evidence
    :param candidates: yields what a stroke would be as this sign, with the measures of each
    :param meanings: yields the meanings of the form; their weights add up to that of the form
    """

    name: str
    candidates: Callable[[Features], Iterator[Candidate]]
    meanings: Callable[[Form, Context], Iterator[Meaning]]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Guess:
    """
    One of the likeliest meanings of a stroke, with the confidence in it.

    :param meaning: the kind of it
    :param confidence: in the meaning: the share of such guesses that are right, 0 .. 1
    :param group_confidence: in its group, 0 .. 1
    :param build: returns the outcome, or raises a Refusal; changes nothing
    """

    meaning: MeaningKind
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
    also: tuple[MeaningKind, ...] = ()

    @property
    def meaning(self) -> MeaningKind:
        """Return the meaning."""
        return self.guesses[0].meaning

    @property
    def confidence(self) -> float:
        """Return the confidence in the meaning, 0 .. 1."""
        return self.guesses[0].confidence

    @property
    def confidences(self) -> Confidences:
        """Return the meanings of the guesses, and the confidences in them."""
        return confidences_in(self.guesses)


def confidences_in(guesses: Sequence[Guess]) -> Confidences:
    """Return the meanings of guesses, and the confidences in them."""
    return tuple((guess.meaning, guess.confidence) for guess in guesses)
