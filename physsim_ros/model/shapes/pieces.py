# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

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
