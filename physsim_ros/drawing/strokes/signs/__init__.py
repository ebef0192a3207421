# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Signs: one file for each, with its hypothesis, its meanings and the outcomes of those.

A new sign is a file with the three names of `Sign` and a line in `SIGNS`. The axle is a meaning of
a small closed shape, so `closed_shapes` asks it for its share. Features that several signs need
are in `features`, outcomes that several forms have in `request_builder`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.hypothesis import Hypothesis
from physsim_ros.drawing.strokes.meanings import Context, Interpretation
from physsim_ros.drawing.strokes.signs import arrow, cross, round_arrow, scribble, zigzag


class Sign(Protocol):
    """The names that the file of a sign defines."""

    @property
    def PRIMITIVE(self) -> str:  # noqa: N802  a constant of the module
        """Return the name of the form."""

    def hypothesis(self, features: Features) -> Hypothesis:
        """Return the hypothesis that a stroke has this form."""

    def interpretations(
        self, hypothesis: Hypothesis, context: Context
    ) -> Iterator[Interpretation]:
        """Yield the meanings of the form; their weights add up to that of the hypothesis."""


SIGNS: tuple[Sign, ...] = (zigzag, scribble, cross, arrow, round_arrow)
