# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
from physsim_ros.drawing.strokes.glyphs import arrow, cross, round_arrow, scribble, zigzag
from physsim_ros.drawing.strokes.hypothesis import Hypothesis
from physsim_ros.drawing.strokes.meanings import Context, Interpretation


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
