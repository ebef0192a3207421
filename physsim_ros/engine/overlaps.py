# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Overlaps: pairs of convex pieces that would overlap at once, counted before the engine has them.

Law: an overlap costs the engine a contact in every step, and n pieces in one place n² / 2 of them
in a step that no signal ends; so they are counted before any is added or moved.

A piece is counted by its *inner box*: the bounding box along its longest edge, about the mean of
its corners, reduced so that pieces that touch or rest on each other do not count (of a disc the
square in it). Two pieces overlap if their inner boxes do, by the separating axis theorem (Ericson,
Real-Time Collision Detection, 4.4.1); candidates are found by the broad phase, in parts, so that
the count ends soon after its limit. Shallower overlaps than that are not counted, and are no more
than some for each piece, since their centres are apart.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.broad_phase import pairs_in_parts
from physsim_ros.engine.settings import COLLISION_SLOP
from physsim_ros.model.arrays import Flags, Floats, Ints
from physsim_ros.model.shapes import Capsule, Circle, Convex, Form, Piece, Shape
from physsim_ros.model.transform import next_vertices, Pose, rotated, rotated_each
from physsim_ros.model.weak_cache import cached_weakly

# Candidates compared at once: some 30 MB.
_PART = 200_000
# Share of an inner box in the bounding box of a piece: a disc's is the square in it; rounding and
# the turning of pieces that lie on each other leave 95 %; of a triangle's box half is inside.
_OF_DISC, _OF_BAR, _OF_CONVEX = math.sqrt(0.5), 0.95, 0.5
# Gap between a rectangle's corner and that of its box, as a share of the width of the box [1].
_SQUARE = 0.005
# The least share: pieces may be as small as the overlap that the engine leaves.
_LEAST = 0.2


Box = tuple[float, float, float, float]


class InnerBoxes(NamedTuple):
    """
    Inner boxes of pieces.

    :ivar centers: (n, 2) float64 [m]
    :ivar halves: (n, 2) float64: half length and half width [m]
    :ivar yaws: (n,) float64: of the length [rad]
    """

    centers: Floats
    halves: Floats
    yaws: Floats


@cached_weakly
def _inner_boxes_of(form: Form) -> InnerBoxes:
    """Return the inner boxes of the pieces of a form, in the body's frame."""
    centers, halves, yaws = zip(*map(_inner_box, form.pieces), strict=True)
    return InnerBoxes(np.array(centers), np.array(halves), np.array(yaws))


@cached_weakly
def _only_inner_box(form: Form) -> tuple[tuple[float, float], tuple[float, float], float]:
    """Return the inner box of a form of one piece: centre, half length and width, yaw."""
    return _inner_box(form.pieces[0])


def _inner_box(piece: Piece) -> tuple[tuple[float, float], tuple[float, float], float]:
    match piece:
        case Circle(center, radius):
            half = _reduced(radius, _OF_DISC)
            return center, (half, half), 0.0
        case Capsule(start, end, radius):
            dx, dy = end[0] - start[0], end[1] - start[1]
            middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
            halves = (math.hypot(dx, dy) / 2 + _reduced(radius, _OF_DISC),
                      _reduced(radius, _OF_BAR))  # fmt: skip
            return middle, halves, math.atan2(dy, dx)
        case Convex(vertices):
            corners = np.array(vertices)
            edges = next_vertices(corners) - corners
            longest = edges[np.argmax(np.hypot(edges[:, 0], edges[:, 1]))]
            yaw = math.atan2(longest[1], longest[0])
            along = rotated_each(corners, np.full(len(corners), -yaw))
            low, high = along.min(axis=0), along.max(axis=0)
            middle = (low + high) / 2
            # All corners of a rectangle are corners of its box.
            gaps = np.abs(np.abs(along - middle) - (high - low) / 2).max()
            is_rectangle = len(corners) == 4 and gaps < _SQUARE * float((high - low).min())
            share = _OF_BAR if is_rectangle else _OF_CONVEX
            x, y = corners.mean(axis=0).tolist()
            length, width = ((high - low) / 2).tolist()
            return (x, y), (_reduced(length, share), _reduced(width, share)), yaw


def _reduced(half: float, share: float) -> float:
    """Return half the extent of an inner box, of a piece of half an extent [m]."""
    return max(half * share - COLLISION_SLOP, half * _LEAST)


class Layout(NamedTuple):
    """
    The inner boxes of the pieces of bodies in the world.

    :ivar inner: in world coordinates
    :ivar bodies: (n,) int64: number of the body of each
    """

    inner: InnerBoxes
    bodies: Ints


def laid_out(shapes: Sequence[Shape], poses: Floats) -> Layout:
    """
    Return the inner boxes of bodies.

    :param shapes: of the bodies
    :param poses: (n, 3) float64: of the bodies' origins, in the same order [m, rad]
    """
    parts = [_inner_boxes_of(shape.form) for shape in shapes]
    bodies = np.repeat(np.arange(len(parts)), [len(part.yaws) for part in parts])
    if not parts:
        return Layout(InnerBoxes(np.empty((0, 2)), np.empty((0, 2)), np.empty(0)), bodies)
    local = InnerBoxes(*(np.concatenate(column) for column in zip(*parts, strict=True)))
    yaws = poses[bodies, 2]
    centers = poses[bodies, :2] + rotated_each(local.centers, yaws)
    return Layout(InnerBoxes(centers, local.halves, local.yaws + yaws), bodies)


def count_overlaps(layout: Layout, first: Flags, anchored: Flags, *, most: int) -> int:
    """
    Count the pairs of pieces of different bodies that overlap.

    :param first: (b,) bool: one body of each pair is among these
    :param anchored: (b,) bool: bodies, which do not collide with each other
    :param most: the count ends when it is greater
    """
    inner, bodies = layout
    count = 0
    if not len(bodies):
        return count
    boxes = _boxes(inner)
    for one, other in pairs_in_parts(boxes, first[bodies], most=_PART):
        a, b = bodies[one], bodies[other]
        apart = (a != b) & ~(anchored[a] & anchored[b])
        count += int(_overlap(inner, one[apart], other[apart]).sum())
        if count > most:
            break
    return count


def count_inside(shape: Shape) -> int:
    """Count the pairs of pieces of one shape that overlap, of which the engine has a list too."""
    return _count_inside(shape.form)


@cached_weakly
def _count_inside(form: Form) -> int:
    count = len(form.pieces)
    if count == 1:
        return 0
    # As if each piece were a body.
    layout = Layout(_inner_boxes_of(form), np.arange(count))
    none = np.zeros(count, np.bool_)
    return count_overlaps(layout, ~none, none, most=count**2)


def _overlap(inner: InnerBoxes, one: Ints, other: Ints) -> Flags:
    """Return which pairs of inner boxes overlap."""
    offset = inner.centers[other] - inner.centers[one]
    difference = inner.yaws[other] - inner.yaws[one]
    cos, sin = np.abs(np.cos(difference)), np.abs(np.sin(difference))
    overlap = np.ones(len(one), np.bool_)
    for axes, own, its in ((one, one, other), (other, other, one)):
        distance = np.abs(rotated_each(offset, -inner.yaws[axes]))
        length, width = inner.halves[its].T
        reach = np.column_stack((length * cos + width * sin, length * sin + width * cos))
        overlap &= (distance < inner.halves[own] + reach).all(axis=1)
    return overlap


def bounds_of_pieces(shape: Shape, pose: Pose) -> list[Box]:
    """Return left, bottom, right, top of the inner boxes of a body [m]."""
    if len(shape.form.pieces) > 1:
        boxes = _boxes(laid_out([shape], np.array([pose])).inner).tolist()
        return [(left, bottom, right, top) for left, bottom, right, top in boxes]
    # Without arrays, which take ten times as long for one piece.
    (x, y), (length, width), yaw = _only_inner_box(shape.form)
    x, y = rotated((x, y), pose[2])
    cos, sin = abs(math.cos(yaw + pose[2])), abs(math.sin(yaw + pose[2]))
    dx, dy = length * cos + width * sin, length * sin + width * cos
    x, y = pose[0] + x, pose[1] + y
    return [(x - dx, y - dy, x + dx, y + dy)]


def _boxes(inner: InnerBoxes) -> Floats:
    """Return (n, 4) float64: left, bottom, right, top of inner boxes [m]."""
    cos, sin = np.abs(np.cos(inner.yaws)), np.abs(np.sin(inner.yaws))
    length, width = inner.halves.T
    extents = np.column_stack((length * cos + width * sin, length * sin + width * cos))
    return np.hstack((inner.centers - extents, inner.centers + extents))
