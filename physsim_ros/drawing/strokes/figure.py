# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Figures: the last things that a person drew, each of one or several strokes, with their guesses.

Law: a figure changes nothing in the world.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.choice import is_likely
from physsim_ros.drawing.strokes.reading import guesses_of
from physsim_ros.drawing.strokes.stages import (
    Classification,
    Guess,
    MeaningKind,
    MOST_GUESSES,
    OPEN,
    SOLIDS,
)
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Refusal
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Join, Request

# Meanings of open lines that join nothing.
_LOOSE = frozenset({MeaningKind.WALL, MeaningKind.HATCHING})
# Meanings of arrows.
ARROWS = frozenset({MeaningKind.GRAVITY, MeaningKind.VELOCITY})
# Meanings of the heads of arrows, closed and filled, without their shafts.
_HEADS = frozenset({MeaningKind.POLYGON, MeaningKind.DELETION})
# The least share of a line that lies on a solid, or on the bodies at its ends, if it is no more
# than a mark on the one or a joint of the others.
ON_SOLID = 0.6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Figure:
    """
    One or several strokes that are read together.

    :param strokes: each (COUNT, 2) float64: evenly spaced [m]
    :param began: when its first stroke began [s]
    :param ended: when its last stroke ended [s]
    :param whole: its strokes as one
    :param scene: over which the first one was drawn
    :param guesses: its possible meanings, the likeliest first
    :param chosen: index of the guess that was taken; None where it was not recognised
    :param requests: of that reading; () where the world cannot have it
    :param gestures: numbers of the gestures with which these were submitted
    """

    strokes: tuple[Floats, ...]
    began: float
    ended: float
    whole: Classification
    scene: SceneQuery
    guesses: tuple[Guess, ...]
    chosen: int | None = None
    requests: tuple[Request, ...] = ()
    gestures: tuple[int, ...] = ()

    @classmethod
    def read(
        cls,
        whole: Classification,
        scene: SceneQuery,
        settings: DrawingSettings,
        *,
        strokes: tuple[Floats, ...],
        began: float,
        ended: float,
    ) -> Figure:
        """Return a figure with its guesses; the first one is taken if it is likely enough."""
        guesses = guesses_of(whole, scene, settings)
        likely = is_likely(guesses, settings)
        return cls(
            strokes=strokes,
            began=began,
            ended=ended,
            whole=whole,
            scene=scene,
            guesses=guesses,
            chosen=0 if likely else None,
            requests=_requests_of(guesses[0]) if likely else (),
        )

    @property
    def meaning(self) -> MeaningKind | None:
        """Return the meaning that it was read with; None where it was not recognised."""
        return None if self.chosen is None else self.guesses[self.chosen].meaning

    @property
    def is_open(self) -> bool:
        """Return whether it is an open line, or not recognised, and joins no two bodies."""
        to_background = any(isinstance(each, Join) and each.b == WORLD for each in self.requests)
        return self.is_line and (self.meaning in {None, *_LOOSE} or to_background)

    @property
    def is_line(self) -> bool:
        """Return whether it is an open line, or not recognised."""
        return self.meaning is None or self.meaning in OPEN

    @property
    def is_arrow(self) -> bool:
        """Return whether it is a straight arrow."""
        return self.meaning in ARROWS

    @property
    def is_part(self) -> bool:
        """Return whether it may be a part of a figure of several strokes."""
        return self.is_line or self.is_arrow or self.meaning in _HEADS

    @property
    def is_solid(self) -> bool:
        """Return whether it is a body of its own."""
        return self.meaning in SOLIDS

    def with_gravity(self) -> Figure:
        """Return a new body with the guess that the arrow before it did turn gravity."""
        chosen = self.guesses[self.chosen or 0]
        # The body alone is built.
        turned = replace(chosen, meaning=MeaningKind.GRAVITY, confidence=1.0 - chosen.confidence)
        rest = (
            each
            for each in self.guesses
            if each is not chosen and each.meaning is not MeaningKind.GRAVITY
        )
        return replace(self, guesses=(chosen, turned, *rest)[:MOST_GUESSES], chosen=0)

    @property
    def other_guesses(self) -> list[int]:
        """Return the indices of the other guesses, beginning with the next likely one."""
        count = len(self.guesses)
        if self.chosen is None:
            return list(range(count))
        return [(self.chosen + step) % count for step in range(1, count)]


def _requests_of(guess: Guess) -> tuple[Request, ...]:
    """Return the requests of a guess; none where the world cannot have it."""
    try:
        return guess.build().requests
    except Refusal:
        return ()
