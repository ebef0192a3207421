# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A sketch: the figures that a person drew last, and what a stroke, or another guess, makes of them.

Law: a sketch is a value. It changes nothing, and refuses before it returns another one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.choice import reading_of
from physsim_ros.drawing.strokes.figure import Figure
from physsim_ros.drawing.strokes.grouping import grouped, MOST_STROKES
from physsim_ros.drawing.strokes.marks import marked_solid
from physsim_ros.drawing.strokes.stages import MeaningKind, Reading
from physsim_ros.drawing.strokes.waiting import readings_over, Reread
from physsim_ros.drawing.strokes.waiting_joints import requests_with_waiting_joints
from physsim_ros.model.translation import Text


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Sketch:
    """
    The figures that a person drew last.

    :param figures: at most `MOST_STROKES`, the earliest first
    :param mark: a line within the last one, which has no effect
    """

    figures: tuple[Figure, ...] = ()
    mark: Figure | None = None

    def is_marked_by(self, stroke: Figure, settings: DrawingSettings) -> bool:
        """Return whether a new stroke is a mark within the last figure, the first one on it."""
        return self.mark is None and marked_solid(self.figures, stroke, settings)

    def with_mark(self, stroke: Figure) -> Sketch:
        """Return the sketch with a mark: the solid under it may still get another reading."""
        return replace(self, mark=stroke)

    def with_stroke(
        self, stroke: Figure, settings: DrawingSettings, clock: Callable[[], float]
    ) -> Sketch:
        """
        Return the sketch with a stroke, by itself or as one with the strokes before it.

        :param clock: returns the CPU time of the thread [s]
        """
        # A second line may make an x of a mark.
        mark = () if self.mark is None else (replace(self.mark, scene=stroke.scene),)
        figures = grouped((*self.figures, *mark), stroke, settings, clock)
        return Sketch(figures=figures[-MOST_STROKES:])

    def built(self, number: int, settings: DrawingSettings) -> tuple[Sketch, Reading]:
        """
        Return the sketch with a guess of its last figure built, and the reading by that.

        Earlier figures are read again over its new body.

        :param number: of the guess
        :raises Refusal: the world cannot have its outcome
        """
        *earlier, figure = self.figures
        reading = reading_of(figure.guesses, number, amends=figure.gestures)
        requests = requests_with_waiting_joints(reading.requests, figure.scene, settings.snap)
        figure = replace(figure, chosen=number, requests=requests)
        again = list(readings_over(figure, earlier, settings))
        reading = _with_earlier(replace(reading, requests=requests), again)
        if any(over.meaning is MeaningKind.VELOCITY for _, over in again):
            figure = figure.with_gravity()
            reading = replace(reading, guesses=figure.guesses)
        figures = *earlier, replace(figure, requests=reading.requests)
        marks = [lines[0] for lines, over in again if over.meaning is MeaningKind.MARK]
        mark = replace(marks[-1], requests=(), gestures=()) if marks else self.mark
        return Sketch(figures=figures, mark=mark), reading

    def other_guesses(self, meaning: str = '') -> list[int]:
        """
        Return the numbers of the other guesses at the last figure, the next likely one first.

        :param meaning: of the guesses; '' is any
        """
        if not self.figures:
            return []
        last = self.figures[-1]
        return [each for each in last.other_guesses if meaning in {'', last.guesses[each].meaning}]

    def submitted(self, gesture: int) -> Sketch:
        """Return the sketch with the number of the gesture that its last figure became."""
        *earlier, last = self.figures
        return replace(self, figures=(*earlier, replace(last, gestures=(gesture,))))


def _with_earlier(reading: Reading, again: Sequence[Reread]) -> Reading:
    """Return a reading with what earlier figures are over its new body, read again."""
    for _, over in again:
        reading = replace(
            reading,
            requests=reading.requests + over.requests,
            message=Text('{first}; {then}', first=reading.message, then=over.message),
            also=(*reading.also, over.meaning),
        )
    return reading
