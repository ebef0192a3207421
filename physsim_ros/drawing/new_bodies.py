# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests for drawn bodies, from their geometry in the world.

A request leaves density, friction and elasticity to the defaults of the world. The origin of a
body lies at its centre of mass.
"""

from __future__ import annotations

from collections.abc import Sequence
import math

from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Box, Chain, Disc, Polygon, Shape
from physsim_ros.model.transform import Point, Pose


def disc(name: str, center: Point, radius: float, settings: DrawingSettings) -> Spawn:
    """
    Return the request for a disc.

    :raises BadSize: the radius [m] is out of range
    """
    return _dynamic_body(name, Disc(radius=radius), (*center, 0.0), settings)


def rectangle(
    name: str, center: Pose, width: float, height: float, settings: DrawingSettings
) -> Spawn:
    """
    Return the request for a rectangle.

    :param center: x, y [m] and the yaw of its width [rad]
    :raises BadSize: a side [m] is out of range
    """
    return _dynamic_body(name, Box(width=width, height=height), center, settings)


def polygon(name: str, corners: Sequence[Point], settings: DrawingSettings) -> Spawn:
    """
    Return the request for a polygon.

    :param corners: in either orientation, the first not repeated [m]
    :raises BadOutline: they are not the outline of a simple polygon
    :raises BadSize: it is too large or too thin
    """
    x, y = Polygon(outline=tuple(corners)).form.centroid
    outline = tuple((corner[0] - x, corner[1] - y) for corner in corners)
    return _dynamic_body(name, Polygon(outline=outline), (x, y, 0.0), settings)


def wall(name: str, points: Sequence[Point], settings: DrawingSettings) -> Spawn:
    """
    Return the request for a wall of anchored segments; the x axis of a single one is along it.

    :param points: at least two, in order [m]
    :raises BadOutline: all are the same point
    """
    thickness = settings.wall_thickness
    x, y = Chain(points=tuple(points), thickness=thickness).form.centroid
    yaw = 0.0
    line = tuple((point[0] - x, point[1] - y) for point in points)
    if len(points) == 2:
        (start, end), half = points, math.dist(*points) / 2
        yaw = math.atan2(end[1] - start[1], end[0] - start[0])
        line = (-half, 0.0), (half, 0.0)
    return Spawn(
        name=name,
        shape=Chain(points=line, thickness=thickness),
        pose=(x, y, yaw),
        color=settings.draw_color,
        properties=Properties(anchored=True),
    )


def _dynamic_body(name: str, shape: Shape, pose: Pose, settings: DrawingSettings) -> Spawn:
    velocity = settings.draw_velocity
    return Spawn(
        name=name,
        shape=shape,
        pose=pose,
        color=settings.draw_color,
        properties=Properties(velocity=None if velocity == (0.0, 0.0) else velocity),
    )
