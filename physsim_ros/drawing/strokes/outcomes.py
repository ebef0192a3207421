# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Outcomes of several forms: requests for regularised bodies, walls and joints.

Law: an outcome that the world cannot have is refused here, before any request is submitted.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
import math

import numpy as np
from physsim_ros.drawing import chains, new_bodies
from physsim_ros.drawing.geometry import circle_outline, point_of
from physsim_ros.drawing.strokes import bodies_under, regularisation
from physsim_ros.drawing.strokes.fitting import simplified
from physsim_ros.drawing.strokes.stages import Context, End, Outcome
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind, JointProperties, MOST_STOPS
from physsim_ros.model.requests import Join
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import Text


def disc(points: Floats, context: Context) -> Outcome:
    """Return a disc, of its centre and a point on its rim."""
    center, radius = point_of(points[0]), math.dist(*points)
    name = context.scene.next_body()
    return Outcome(
        requests=(new_bodies.disc(name, center, radius, context.settings),),
        subject=name,
        message=Text('a disc of radius {radius:.3g} m', radius=radius),
        outline=circle_outline(center, radius),
    )


def rectangle(points: Floats, context: Context) -> Outcome:
    """Return a rectangle, of its corners; a polygon where nothing is regularised."""
    settings = context.settings
    if settings.beautify == 0.0:
        return polygon(points, context)
    name = context.scene.next_body()
    pose, width, height = regularisation.rectangle(points, settings.beautify)
    x, y, yaw = pose
    along = np.array((math.cos(yaw), math.sin(yaw))) * width / 2
    across = np.array((-math.sin(yaw), math.cos(yaw))) * height / 2
    corners = np.array((-along - across, along - across, along + across, across - along))
    return Outcome(
        requests=(new_bodies.rectangle(name, pose, width, height, settings),),
        subject=name,
        message=Text('a rectangle of {width:.3g} m by {height:.3g} m', width=width, height=height),
        outline=_closed(np.array((x, y)) + corners),
    )


def polygon(points: Floats, context: Context) -> Outcome:
    """Return a polygon, of its corners."""
    return smooth_polygon(
        regularisation.polygon_outline(points, context.settings.beautify), context
    )


def smooth_polygon(corners: Floats, context: Context) -> Outcome:
    """Return a polygon that is not regularised: its corners are points of a curve."""
    name = context.scene.next_body()
    return Outcome(
        requests=(new_bodies.polygon(name, list(map(point_of, corners)), context.settings),),
        subject=name,
        message=Text('a polygon of {count} corners', count=len(corners)),
        outline=_closed(corners),
    )


def wall(points: Floats, context: Context) -> Outcome:
    """Return a wall of ends and bends of the stroke; along its curve where these do not fit it."""
    settings, name = context.settings, context.scene.next_body()
    curve = simplified(context.features.path, points, context.drawn.size)
    path = regularisation.line(points, settings.beautify) if curve is None else curve
    corners = list(map(point_of, path))
    corners[0] = bodies_under.wall_end(corners[0], context)
    end = bodies_under.wall_end(corners[-1], context)
    if end != corners[0]:
        # Of a short wall, both ends would go to the same point.
        corners[-1] = end
    length = sum(map(math.dist, corners, corners[1:]))
    return Outcome(
        requests=(new_bodies.wall(name, corners, settings),),
        subject=name,
        message=Text('a wall of {length:.3g} m', length=length),
        outline=np.array(corners),
    )


def join(kind: JointKind, ends: tuple[End, End], context: Context) -> Outcome:
    """Return a joint between the bodies at the ends of the stroke."""
    first, last = ends
    name = context.scene.next_joint()
    line: tuple[Point, ...] = (first.point, last.point)
    a, b = first.body, last.body
    message = Text('{joint} from {a} to {b}', joint=kind.phrase, kind=Text(kind), a=a, b=b)
    properties = JointProperties()
    passed = context.wheels[: MOST_STOPS - 2] if kind is JointKind.ROPE else ()
    if passed:
        if not _begins_at(first, context):
            passed = passed[::-1]
        names = tuple(wheel for wheel, _ in passed)
        properties = JointProperties(over=names)
        line = (first.point, *(point for _, point in passed), last.point)
        over = ', '.join(names)
        message = Text('{message} over {names}', message=message, names=over)
    elif kind is JointKind.ROPE:
        # A rope is as long as it was drawn.
        straight = math.dist(first.point, last.point)
        properties = JointProperties(length=max(context.drawn.length, straight))
    request = Join(name=name, kind=kind, points=line, a=a, b=b, properties=properties)
    return Outcome(
        requests=(request,),
        subject=name,
        message=message,
        outline=np.array(line) if kind is JointKind.ROD else context.drawn.points,
    )


def _begins_at(end: End, context: Context) -> bool:
    """Return whether the pen began at an end of a joint."""
    start, finish = context.drawn.points[[0, -1]]
    return math.dist(end.point, start) <= math.dist(end.point, finish)


def chain(ends: tuple[End, End], context: Context) -> Outcome:
    """Return a chain between the bodies at the ends of the stroke, along it."""
    path = context.drawn.points.copy()
    first, last = ends if _begins_at(ends[0], context) else ends[::-1]
    path[0], path[-1] = first.point, last.point
    bodies = first.body, last.body
    requests = chains.chain(path, bodies, context.scene, context.settings)
    return Outcome(
        requests=requests,
        subject='',
        message=chains.message(requests, bodies),
        outline=path,
    )


def joins_at(
    kind: JointKind, point: Point, pairs: Iterable[tuple[str, str]], context: Context
) -> Iterator[Join]:
    """Yield the requests for axles or pins of pairs of bodies at a point."""
    for name, (a, b) in zip(context.scene.new_joints(), pairs, strict=False):
        yield Join(name=name, kind=kind, points=(point,), a=a, b=b)


def _closed(corners: Floats) -> Floats:
    return np.vstack((corners, corners[:1]))
