# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The bodies under a stroke: those at its ends, those that it covers, those that it only crosses.

Laws: the end of a drawn joint or wall moves by no more than `snap`, and only onto a body. A body
that the stroke only crosses is not covered.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.drawing.geometry import nearest_points, point_of, towards
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.strokes.resampled import few_points, middle_half
from physsim_ros.drawing.strokes.stages import Context, End
from physsim_ros.model.arrays import Floats
from physsim_ros.model.names import WORLD
from physsim_ros.model.shapes import Chain, Disc
from physsim_ros.model.transform import dots, norms, Point

# The least change of direction of a rope that runs around a wheel [rad].
_BEND = math.radians(45.0)
# The greatest depth of the end of a line on which a body stands, in inner radii of the body, and
# the cosine of the slope of a ramp that bears a ball: 45°.
_SHALLOW, SLOPE = 0.33, 0.7
# The least share of a hatching line on its body: ends may cross the edge.
_INSIDE = 0.95
# Name of a body -> which of the few points of a stroke lie on it.
Crossed = dict[str, NDArray[np.bool_]]
# The least share of the stroke on a body that is covered.
_COVERING = 0.3
# Of a body with a smaller share, whose centroid lies in the bounding box of the stroke: its
# greatest outer radius, in diagonals of that box, and the least number of entries of the stroke.
_AS_LARGE, _LEAST_ENTRIES = 0.75, 2


def joint_ends(points: Floats, scene: SceneQuery, snap: float) -> tuple[End, End] | None:
    """
    Return the ends of a joint between the bodies at two points, the first on a dynamic body.

    :param points: (n, 2) float64: the first and the last one are those points [m]
    :return: None where no body at either point is dynamic, or it is the same body at both
    """
    start, end = point_of(points[0]), point_of(points[-1])
    first = scene.bodies_near(start, snap) or (WORLD,)
    last = scene.bodies_near(end, snap) or (WORLD,)
    moving = next((b for b in last if _is_dynamic(b, scene)), None)
    for a in first:
        b = next((b for b in last if b != a), None) if _is_dynamic(a, scene) else moving
        if b is not None:
            ends = End(_snapped(start, a, scene, snap), a), End(_snapped(end, b, scene, snap), b)
            return ends if _is_dynamic(a, scene) else ends[::-1]
    return None


def _is_dynamic(name: str, scene: SceneQuery) -> bool:
    return name != WORLD and scene.body(name).dynamic


def stands_on(name: str, end: Point, scene: SceneQuery, steepness: float = SLOPE) -> bool:
    """
    Return whether a body stands on the end of a line: that lies little above its underside.

    :param end: within the body [m]
    :param steepness: least cosine of the angle between gravity and the surface of the body there
    """
    surface = nearest_on_surface(end, name, scene)
    reach = _SHALLOW * scene.body(name).shape.form.inner
    return math.dist(end, surface) < reach and _downward(end, surface, scene) > steepness


def hangs_from(name: str, last: tuple[Point, Point], scene: SceneQuery, snap: float) -> bool:
    """
    Return whether a body hangs from the end of a line that goes down to its upper side.

    :param last: a point of the line before its end, and its end, beside the body [m]
    """
    before, end = last
    above = towards(end, before, snap)
    falls = _downward(above, nearest_on_surface(above, name, scene), scene)
    return name in scene.bodies_at(end, snap) and min(falls, _downward(*last, scene)) > SLOPE


def _downward(start: Point, end: Point, scene: SceneQuery) -> float:
    """Return the cosine of the angle between gravity and a displacement; 0 without gravity."""
    displacement, gravity = np.subtract(end, start), np.array(scene.settings.gravity)
    return float(dots(displacement, gravity)) / max(
        float(norms(displacement) * norms(gravity)), 1e-300
    )


def wheels_passed(
    points: Floats, ends: Sequence[End], scene: SceneQuery, snap: float
) -> list[tuple[str, Point]]:
    """
    Return the wheels that a rope runs around, in the order of the stroke, and where it does [m].

    A wheel is a disc that is anchored or has a joint, and is not at an end of the stroke. A line
    runs around it that bends beside it, about its middle.

    :param points: (n, 2) float64: of the stroke [m]
    :param ends: of the rope
    """
    at_ends = {end.body for end in ends}
    jointed = {body for joint in scene.joints for body in (joint.a, joint.b)}
    low, high, centers = points.min(axis=0), points.max(axis=0), scene.snapshot.centers
    within = ((centers > low) & (centers < high)).all(axis=1)
    found: list[tuple[int, str]] = []
    for row in np.flatnonzero(within).tolist():
        body, name = scene.snapshot.scene.bodies[row], scene.names[row]
        held = isinstance(body.shape, Disc) and (body.anchored or name in jointed)
        if not held or name in at_ends:
            continue
        away, radius = points - centers[row], body.shape.form.outer
        beside = np.flatnonzero(norms(away) < radius + max(snap, radius / 2))
        if not len(beside) or beside[0] == 0 or beside[-1] == len(points) - 1:
            continue
        before, last = beside[0] - 1, beside[-1]
        passing = slice(before, last + 2)
        angles = np.unwrap([math.atan2(y, x) for x, y in away[passing].tolist()])
        (ux, uy), (vx, vy) = (points[each + 1] - points[each] for each in (before, last))
        bend = abs(math.atan2(ux * vy - uy * vx, ux * vx + uy * vy))
        # A line that bends away from the wheel goes about its middle by less than it bends.
        if abs(angles[-1] - angles[0]) > bend > _BEND:
            found.append((int(beside[len(beside) // 2]), name))
    return [(name, point_of(points[at])) for at, name in sorted(found)]


def hatched_body(points: Floats, scene: SceneQuery) -> str | None:
    """Return the name of the topmost dynamic body that all of a stroke lies on, if any."""
    for name in scene.bodies_at(point_of(points[len(points) // 2])):
        if scene.body(name).dynamic and scene.covers(name, points).mean() >= _INSIDE:
            return name
    return None


def wall_end(point: Point, context: Context) -> Point:
    """Return the snapped end of a wall: an end of another wall, or a point on a body [m]."""
    scene, snap = context.scene, context.settings.snap
    for name in scene.bodies_at(point, snap):
        shape = scene.body(name).shape
        if isinstance(shape, Chain):
            for end in (shape.points[0], shape.points[-1]):
                there = scene.in_world(name, end)
                if math.dist(there, point) <= snap:
                    return there
    if scene.bodies_at(point):
        return point
    near = scene.bodies_near(point, snap)
    return nearest_on_surface(point, near[0], scene) if near else point


def _snapped(point: Point, name: str, scene: SceneQuery, snap: float) -> Point:
    """Return the snapped end of a joint: the middle of a body, the point, or the nearest one."""
    if name == WORLD:
        return point
    body = scene.body(name)
    # A body joined exactly at its middle does not turn under gravity.
    middle = scene.centroid(name)
    if body.dynamic and math.dist(point, middle) <= min(snap, body.shape.form.inner):
        return middle
    return point if name in scene.bodies_at(point) else nearest_on_surface(point, name, scene)


def nearest_on_surface(point: Point, name: str, scene: SceneQuery) -> Point:
    """Return the point of the outlines of a body's pieces that is nearest to a point."""
    local = scene.local(name, point)
    pieces = scene.body(name).shape.form.pieces
    nearest = (near for piece in pieces for near in nearest_points(piece, local))
    return scene.in_world(name, min(nearest, key=lambda each: math.dist(each, local)))


def covered_bodies(points: Floats, crossed: Crossed, scene: SceneQuery) -> tuple[str, ...]:
    """
    Return the names of the bodies that a stroke covers, in spawn order.

    :param points: (n, 2) float64: of the stroke [m]
    :param crossed: the bodies that it crosses, by `crossed_bodies`
    """
    low, high = points.min(axis=0), points.max(axis=0)
    reach = _AS_LARGE * float(norms(high - low))
    covered = set()
    for name, hits in crossed.items():
        form = scene.body(name).shape.form
        middle = scene.in_world(name, form.centroid)
        within = bool(((middle >= low) & (middle <= high)).all()) and form.outer <= reach
        if hits.mean() >= _COVERING or (within and _entries(hits) >= _LEAST_ENTRIES):
            covered.add(name)
    if not covered and crossed:
        # Of a scribble across a long wall, only little of either lies on the other.
        most = max(crossed, key=lambda name: _entries(crossed[name]))
        if _entries(crossed[most]) >= _LEAST_ENTRIES:
            covered.add(most)
    return tuple(name for name in scene.names if name in covered)


def _entries(hits: NDArray[np.bool_]) -> int:
    """Return how many times a stroke enters a body."""
    return int(np.count_nonzero(hits[1:] & ~hits[:-1]) + hits[0])


def share_on(crossed: Crossed, ends: Iterable[End]) -> float:
    """Return the share of a stroke that lies on the bodies at its ends, 0 .. 1."""
    hits = [crossed[end.body] for end in ends if end.body in crossed]
    return float(np.any(hits, axis=0).mean()) if hits else 0.0


def middle_share_on(crossed: Crossed, ends: Iterable[End]) -> float:
    """Return the share of the middle half of a stroke on the bodies at its ends, 0 .. 1."""
    return share_on({name: middle_half(hits) for name, hits in crossed.items()}, ends)


def crossed_bodies(points: Floats, scene: SceneQuery) -> Crossed:
    """Return the bodies that a stroke crosses, each with the points that lie on it."""
    low, high = points.min(axis=0), points.max(axis=0)
    x, y = ((low + high) / 2).tolist()
    reach = float(norms(high - low)) / 2
    crossed: Crossed = {}
    for name in scene.bodies_at((x, y), reach):
        hits = scene.covers(name, few_points(points))
        if hits.any():
            crossed[name] = hits
    return crossed
