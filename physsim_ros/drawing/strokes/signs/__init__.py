# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Signs: one file for each, with its measures, its meanings and the outcomes of those.

A new sign is a file with the three names of `Sign`, a line in `SIGNS` and rows in the table of
`evidence`, which `python -m tools.evaluation.fit` makes. The axle is a meaning of a small closed
shape, so `closed_shapes` asks it for its share. Features that several signs need are in
`features`, outcomes that several forms have in `request_builder`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from physsim_ros.drawing.strokes.evidence import Candidate
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.hypothesis import Hypothesis
from physsim_ros.drawing.strokes.meanings import Context, Interpretation
from physsim_ros.drawing.strokes.signs import arrow, cross, round_arrow, scribble, zigzag


class Sign(Protocol):
    """The names that the file of a sign defines."""

    @property
    def PRIMITIVE(self) -> str:  # noqa: N802  a constant of the module
        """Return the name of the form."""

    def candidates(self, features: Features) -> Iterator[Candidate]:
        """Yield the ways in which a stroke may have this form, with their measures."""

    def interpretations(
        self, hypothesis: Hypothesis, context: Context
    ) -> Iterator[Interpretation]:
        """Yield the meanings of the form; their weights add up to that of the hypothesis."""


SIGNS: tuple[Sign, ...] = (zigzag, scribble, cross, arrow, round_arrow)
