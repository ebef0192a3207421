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
Clicks as they were made, and what of them nobody can have meant.

Law: a click holds what it hit, and where on it; that may move on, or go, before the next click.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
import math

from physsim_ros.drawing.scene_query import View
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.errors import BadSize, NothingThere, UnknownBody
from physsim_ros.model.shapes import SMALLEST
from physsim_ros.model.transform import Point

# What is shorter than that share of `snap`, 15 mm as it stands, is a slip of the hand.
SLIP = 0.1


@dataclass(frozen=True, slots=True)
class Click:
    """
    A click as it was made.

    :param point: in the world [m]
    :param body: the topmost body under it; '' where there is none
    :param local: the point in that body's frame [m]
    """

    point: Point
    body: str = ''
    local: Point = (0.0, 0.0)

    @classmethod
    def on(cls, view: View, point: Point) -> Click:
        """Make a click at a point of the world [m]."""
        for name in view.bodies_at(point):
            return cls(point, name, view.local(name, point))
        return cls(point)

    def hit(self, view: View) -> str:
        """
        Return the body that was clicked.

        :raises NothingThere: there was none
        :raises UnknownBody: it has gone since
        """
        if not self.body:
            x, y = self.point
            raise NothingThere(f'there is no body at ({x:g}, {y:g})', field='point')
        if self.body not in view.names:
            raise UnknownBody(f'{self.body} is not there any more', field='point')
        return self.body

    def now(self, view: View) -> Point:
        """
        Return where the place that was clicked is now: on a body, or in the world [m].

        :raises UnknownBody: the body has gone since
        """
        return view.in_world(self.hit(view), self.local) if self.body else self.point


def span(start: Point, end: Point, settings: DrawingSettings, what: str) -> float:
    """
    Return the distance of two points [m].

    :param what: lies between them, for the sentence of the refusal
    :raises BadSize: it is too short to be meant
    """
    return meant(math.dist(start, end), settings, what)


def meant(length: float, settings: DrawingSettings, what: str) -> float:
    """
    Return a length [m].

    :param what: has it, for the sentence of the refusal
    :raises BadSize: it is too short to be meant
    """
    least = _least(settings)
    if length < least:
        raise BadSize(
            f'{what} is {length:.3g} m long; below {least:.3g} m it is a slip of the hand',
            field='point',
        )
    return length


def distinct(points: Sequence[Point], settings: DrawingSettings) -> list[Point]:
    """Return the points without those that repeat the one before: clicked twice by a slip."""
    least = _least(settings)
    return [
        point
        for before, point in zip((None, *points), points, strict=False)
        if before is None or math.dist(before, point) >= least
    ]


def _least(settings: DrawingSettings) -> float:
    return max(SLIP * settings.snap, SMALLEST)
