# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Regularisation (beautification): right angles, horizontal and vertical lines, equal sides.

Law: only deviations below the tolerance, an angle [rad] or a share of a length, are removed. With
a tolerance of 0 nothing changes.
"""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.drawing.geometry import headings, meeting_point, quarter_heading
from physsim_ros.drawing.strokes import fitting
from physsim_ros.model.arrays import Floats
from physsim_ros.model.shapes import crosses_itself
from physsim_ros.model.transform import cross, dots, next_vertices, norms, Pose


def rectangle(corners: Floats, tolerance: float) -> tuple[Pose, float, float]:
    """
    Return the regularised rectangle of four corners.

    :return: its centre and the yaw of its width, -π/4 .. π/4; its width and height [m]
    """
    nearest = fitting.rectangle(corners)
    side, other = nearest[1] - nearest[0], nearest[2] - nearest[1]
    angle = math.atan2(side[1], side[0])
    width, height = float(norms(side)), float(norms(other))
    quarters = round(angle / (math.pi / 2))
    yaw = angle - quarters * math.pi / 2
    if quarters % 2:
        width, height = height, width
    if abs(yaw) <= tolerance:
        yaw = 0.0
    if abs(width - height) <= tolerance * max(width, height):
        width = height = math.sqrt(width * height)
    x, y = nearest.mean(axis=0).tolist()
    return (x, y, yaw), width, height


def polygon_outline(corners: Floats, tolerance: float) -> Floats:
    """Return the regularised outline of corners: a regular polygon, else with right angles."""
    if tolerance == 0.0:
        return corners
    regular = _regular(corners, tolerance)
    if regular is not None:
        return regular
    straightened = _squared(corners, tolerance)
    if len(corners) == 3 and not _has_right_angle(straightened):
        straightened = _isosceles(straightened, tolerance)
    # An outline that would cross itself stays as it was drawn.
    return corners if crosses_itself(straightened) else straightened


def line(points: Floats, tolerance: float) -> Floats:
    """Return a polyline with nearly horizontal and vertical sides regularised."""
    result = points.copy()
    sides = np.diff(points, axis=0)
    for axis in (0, 1):
        # Sides that hardly change along an axis.
        level = np.abs(sides[:, axis]) <= math.sin(tolerance) * norms(sides)
        first = 0
        while first < len(level):
            last = first
            while last < len(level) and level[last]:
                last += 1
            if last > first:
                run = slice(first, last + 1)
                result[run, axis] = points[run, axis].mean()
            first = last + 1
    return result if tolerance > 0 else points


def _regular(corners: Floats, tolerance: float) -> Floats | None:
    """Return the nearest regular polygon, or None where the corners deviate too far from it."""
    count = len(corners)
    middle = corners.mean(axis=0)
    away = corners - middle
    radii = norms(away)
    turn = 2 * math.pi / count
    if cross(away, next_vertices(away)).sum() < 0:
        turn = -turn
    # The angle of the first corner, estimated from each corner.
    firsts = headings(away) - turn * np.arange(count)
    first = math.atan2(float(np.sin(firsts).sum()), float(np.cos(firsts).sum()))
    off = np.abs((firsts - first + math.pi) % (2.0 * math.pi) - math.pi)
    if off.max() > tolerance or np.ptp(radii) > 2 * tolerance * radii.mean():
        return None
    # A nearly horizontal or vertical side becomes exactly so.
    normals = first + turn * (np.arange(count) + 0.5)
    slants = normals - np.round(normals / (math.pi / 2)) * math.pi / 2
    slant = float(slants[np.abs(slants).argmin()])
    if abs(slant) <= tolerance:
        first -= slant
    places = first + turn * np.arange(count)
    regular: Floats = middle + radii.mean() * np.column_stack((np.cos(places), np.sin(places)))
    return regular


def _squared(corners: Floats, tolerance: float) -> Floats:
    """Return corners whose nearly horizontal, vertical or perpendicular sides are exactly so."""
    following = next_vertices(corners)
    sides = following - corners
    angles = headings(sides)
    lengths = norms(sides)
    # The dominant direction modulo a quarter turn, sides weighed by their length².
    base = quarter_heading(sides, lengths**2)
    if abs(base) <= tolerance:
        base = 0.0
    for grid in (base, 0.0):
        slants = angles - grid
        slants -= np.round(slants / (math.pi / 2)) * math.pi / 2
        angles = np.where(np.abs(slants) <= tolerance, angles - slants, angles)
    middles = (corners + following) / 2
    along = np.column_stack((np.cos(angles), np.sin(angles)))
    result = corners.copy()
    for corner in range(len(corners)):
        before = corner - 1
        meeting = meeting_point(middles[before], along[before], middles[corner], along[corner])
        if meeting is not None:
            result[corner] = meeting
    moved = norms(result - corners)
    return result if moved.max() <= tolerance * lengths.mean() + 1e-12 else corners


def _has_right_angle(corners: Floats) -> bool:
    sides = next_vertices(corners) - corners
    lengths = norms(sides)
    cosines = (sides * np.roll(sides, 1, axis=0)).sum(axis=1) / (lengths * np.roll(lengths, 1))
    return bool(np.abs(cosines).min() < 1e-9)


def _isosceles(corners: Floats, tolerance: float) -> Floats:
    """Return a triangle whose two nearly equal sides are equal."""
    sides = norms(next_vertices(corners) - corners)
    # Relative difference of the two sides at each corner.
    ahead, behind = sides, np.roll(sides, 1)
    difference = np.abs(ahead - behind) / np.maximum(ahead, behind)
    apex = int(difference.argmin())
    if difference[apex] > tolerance:
        return corners
    base = corners[[apex - 1, (apex + 1) % 3]]
    along = (base[1] - base[0]) / norms(base[1] - base[0])
    result = corners.copy()
    result[apex] -= along * float(dots(corners[apex] - base.mean(axis=0), along))
    return result
