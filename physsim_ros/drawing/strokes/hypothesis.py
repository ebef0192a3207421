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
What a stroke could be, and how much it looks like that.

A weight is a product of soft conditions, each half fulfilled at its limit. The limits lie between
what hands draw; `make evaluate` shows how well.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
import math

from physsim_ros.model.arrays import Floats

# Weights below are not worth telling.
LEAST = 0.04


class Primitive(StrEnum):
    """What a stroke can look like."""

    DISC = 'disc'
    RECTANGLE = 'rectangle'
    POLYGON = 'polygon'
    LINE = 'line'
    ZIGZAG = 'zigzag'
    CROSS = 'x'
    ARROW = 'arrow'
    SCRIBBLE = 'scribble'


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Candidate:
    """
    What a stroke could be.

    :param primitive: what
    :param weight: how well it looks like that, 0 .. 1
    :param points: (n, 2) float64, in the world [m]: of a disc, its centre and a point on its rim;
        of a rectangle or polygon, the corners; of a line, ends and bends; of a zigzag, its ends;
        of an x, where its lines cross; of an arrow, tail and tip; of a scribble, its way
    """

    primitive: Primitive
    weight: float
    points: Floats


def rises(value: float, limit: float, width: float) -> float:
    """Return a soft condition: 0 far below a limit, a half there, 1 far above."""
    return 1.0 / (1.0 + math.exp(min(max((limit - value) / width, -50.0), 50.0)))


def falls(value: float, limit: float, width: float) -> float:
    """Return a soft condition: 1 far below a limit, a half there, 0 far above."""
    return rises(-value, -limit, width)
