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
from physsim_ros.drawing import body_requests, chains
from physsim_ros.drawing.strokes import bodies_under, regularisation
from physsim_ros.drawing.strokes.fitting import simplified
from physsim_ros.drawing.strokes.geometry import point_of
from physsim_ros.drawing.strokes.meanings import Context, Outcome
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NothingThere
from physsim_ros.model.joints import JointKind, JointProperties, MOST_STOPS
from physsim_ros.model.requests import Join
from physsim_ros.model.transform import Point

# Number of sides that a circle of the preview is drawn with.
_SIDES = 48


def disc(points: Floats, context: Context) -> Outcome:
    """Return a disc, of its centre and a point on its rim."""
    center, radius = point_of(points[0]), math.dist(*points)
    name = context.scene.next_body()
    return Outcome(
        requests=(body_requests.disc(name, center, radius, context.settings),),
        subject=name,
        message=f'a disc of radius {radius:.3g} m',
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
        requests=(body_requests.rectangle(name, pose, width, height, settings),),
        subject=name,
        message=f'a rectangle of {width:.3g} m by {height:.3g} m',
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
        requests=(body_requests.polygon(name, list(map(point_of, corners)), context.settings),),
        subject=name,
        message=f'a polygon of {len(corners)} corners',
        outline=_closed(corners),
    )


def wall(points: Floats, context: Context) -> Outcome:
    """Return a wall, of its ends and bends, or along the curve of the stroke."""
    settings, name = context.settings, context.scene.next_body()
    # A stroke that straight sides do not fit is a curve, and stays one.
    curve = simplified(context.drawn.points, points)
    path = regularisation.line(points, settings.beautify) if curve is None else curve
    corners = list(map(point_of, path))
    corners[0] = bodies_under.wall_end(corners[0], context)
    end = bodies_under.wall_end(corners[-1], context)
    if end != corners[0]:
        # Of a short wall, both ends would go to the same point.
        corners[-1] = end
    length = sum(map(math.dist, corners, corners[1:]))
    return Outcome(
        requests=(body_requests.wall(name, corners, settings),),
        subject=name,
        message=f'a wall of {length:.3g} m',
        outline=np.array(corners),
    )


def join(kind: JointKind, points: Floats, context: Context) -> Outcome:
    """Return a joint between the bodies at the first and the last point."""
    ends = bodies_under.joint_ends(points, context)
    if ends is None:
        raise NothingThere(
            f'{kind.phrase} joins two bodies, one of which moves; there are none at its ends',
            field='poses',
        )
    first, last = ends
    name = context.scene.next_joint()
    line: tuple[Point, ...] = (first.point, last.point)
    message = f'{kind.phrase} from {first.body} to {last.body}'
    properties = JointProperties()
    if kind is JointKind.ROPE and (passed := _wheels_between(first, last, points, context)):
        names = tuple(wheel for wheel, _ in passed)
        properties = JointProperties(over=names)
        line = (first.point, *(point for _, point in passed), last.point)
        message += f' over {", ".join(names)}'
    elif kind is JointKind.ROPE:
        # A rope is as long as it was drawn.
        straight = math.dist(first.point, last.point)
        properties = JointProperties(length=max(context.drawn.length, straight))
    request = Join(
        name=name, kind=kind, points=line, a=first.body, b=last.body, properties=properties
    )
    return Outcome(
        requests=(request,),
        subject=name,
        message=message,
        outline=np.array(line) if kind is JointKind.ROD else context.drawn.points,
    )


def _wheels_between(
    first: bodies_under.End, last: bodies_under.End, points: Floats, context: Context
) -> list[tuple[str, Point]]:
    """Return the wheels that a rope runs around from its first to its last end, and where [m]."""
    passed = bodies_under.wheels_passed(points, context)
    passed = [each for each in passed if each[0] not in (first.body, last.body)]
    is_drawn_so = math.dist(first.point, points[0]) <= math.dist(last.point, points[0])
    return passed[: MOST_STOPS - 2] if is_drawn_so else passed[::-1][: MOST_STOPS - 2]


def chain(context: Context) -> Outcome:
    """Return a chain between the bodies at the ends of the stroke, along it."""
    path = context.drawn.points.copy()
    ends = bodies_under.joint_ends(path, context)
    if ends is None:
        raise NothingThere('a chain joins two bodies; there are none at its ends', field='poses')
    first, last = sorted(ends, key=lambda end: math.dist(end.point, path[0]))
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


def circle_outline(center: Point, radius: float, sides: int = _SIDES) -> Floats:
    """Return a circle as a closed outline, (n, 2) float64 [m]."""
    angles = np.linspace(0.0, 2 * math.pi, sides + 1)
    circle: Floats = np.array(center) + radius * np.column_stack((np.cos(angles), np.sin(angles)))
    return circle


def _closed(corners: Floats) -> Floats:
    return np.vstack((corners, corners[:1]))
