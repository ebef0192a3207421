# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Words of reading: a stroke has forms, a form has meanings in a scene, a meaning has an outcome.

Law: a meaning changes nothing; its outcome is a list of ordinary requests. An outcome that the
world cannot have is refused when it is built, before any request is submitted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.evidence import Candidate, Form
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.plain_forms import DISC, POLYGON, RECTANGLE
from physsim_ros.drawing.strokes.stroke import Stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.requests import Request
from physsim_ros.model.transform import Point

# Factor on the weight of a sign that was drawn where there is nothing that it could change: a
# meaning that can be carried out is taken before it.
MISPLACED = 0.5
# Share of the weight of a line between two bodies that is a joint's; the rest is a wall's.
BETWEEN = 0.98
# Groups of meanings: a stroke is more clearly closed or open than a certain one of these meanings.
# Every other meaning is a group of its own.
CLOSED = frozenset({DISC, RECTANGLE, POLYGON, 'axle', 'pin'})
OPEN = frozenset({'wall', 'rod', 'rope', 'chain', 'spring', 'hatching'})
# Meanings that destroy what was drawn before, or change the whole world.
DELETION, GRAVITY = 'deletion', 'gravity'


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
    :param forms: that it may have, by falling weight
    :param scene: the world that it was drawn over
    :param settings: of drawing
    :param ends: of a joint between the bodies at its ends, the first on a dynamic body; None where
        no joint can be there
    :param wheels: that it runs around as a rope between these ends, in its order, and where [m]
    """

    features: Features
    forms: Sequence[Form]
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
    message: str
    outline: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Meaning:
    """
    A meaning that a stroke may have.

    :param name: as `~/events` reports it: `disc`, `anchor` and so on
    :param weight: likelihood, not yet normalised
    :param build: returns the outcome, or raises a Refusal
    """

    name: str
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
