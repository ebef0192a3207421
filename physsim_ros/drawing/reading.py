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
What a stroke means where it lies: requests that make the world as it was drawn.

Law: reading changes nothing; what it returns are ordinary requests, for somebody to submit.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from physsim_ros.core.errors import NotRecognised
from physsim_ros.core.requests import Request
from physsim_ros.core.snapshot import Floats
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.view import View


class Meaning(StrEnum):
    """What a stroke can mean."""

    DISC = 'disc'
    RECTANGLE = 'rectangle'
    POLYGON = 'polygon'
    WALL = 'wall'
    ROD = 'rod'
    SPRING = 'spring'
    ANCHOR = 'anchor'
    AXLE = 'axle'
    GRAVITY = 'gravity'
    DELETION = 'deletion'


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reading:
    """
    What a stroke was read as.

    :param what: the meaning
    :param confidence: in it, 0 .. 1
    :param runner_up: the next likely meaning; None where there is no other
    :param runner_up_confidence: in that, 0 .. 1
    :param requests: what to submit, in this order
    :param subject: the body or joint concerned; '' where there is none or there are several
    :param message: a sentence that says what is to be done
    :param outline: (n, 2) float64: the beautified stroke, to be shown; the first point repeated
        where it is closed [m]
    """

    what: Meaning
    confidence: float
    runner_up: Meaning | None
    runner_up_confidence: float
    requests: tuple[Request, ...]
    subject: str
    message: str
    outline: Floats


def read(samples: Floats, view: View, settings: DrawingSettings) -> Reading:  # noqa: ARG001
    """
    Read a stroke.

    :param samples: (n, 2) float64: the pen's positions in the world, in order [m]; or (n, 3), the
        third column the time of each [s], used only where they differ
    :param view: the world it was drawn in
    :param settings: of drawing
    :raises Malformed: there are no samples, or one is not finite
    :raises BadSize: the stroke is too small to be anything, or too large
    :raises NotRecognised: it might be anything; the sentence says what was thought of
    """
    raise NotRecognised('strokes are not read yet')
