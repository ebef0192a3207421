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
Pieces: the convex primitives that collide, in the body's frame.

The engine makes one of its own shapes of each: Pymunk's Circle, Poly and Segment.
"""

from __future__ import annotations

from dataclasses import dataclass

from physsim_ros.model.transform import Point


@dataclass(frozen=True, slots=True)
class Circle:
    """A full circle [m]."""

    center: Point
    radius: float


@dataclass(frozen=True, slots=True)
class Convex:
    """A convex polygon: vertices counter-clockwise [m], at least three."""

    vertices: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class Capsule:
    """A segment with round ends [m]."""

    start: Point
    end: Point
    radius: float


Piece = Circle | Convex | Capsule
