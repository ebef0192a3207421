# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Clicks with the bodies that they hit, and the least length that clicks can draw.

Law: a click is a point of the body that it hit. That body may move, or be deleted, before the next
click.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
import math

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.errors import BadSize, nothing_at, UnknownBody
from physsim_ros.model.requests import Request
from physsim_ros.model.shapes import SMALLEST
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import NOTHING, Text

# The least length that clicks can draw, in shares of `snap`: 15 mm by default.
SLIP = 0.1


class Tool(StrEnum):
    """The tools of clicks: the values of parameter `tool`."""

    NONE = 'none'
    CIRCLE = 'circle'
    CIRCLE_DIAMETER = 'circle_diameter'
    RECTANGLE = 'rectangle'
    POLYGON = 'polygon'
    WALL = 'wall'
    ANCHOR = 'anchor'
    RELEASE = 'release'
    PIN = 'pin'
    AXLE = 'axle'
    DELETE = 'delete'
    SPRING = 'spring'
    ROD = 'rod'
    ROPE = 'rope'
    PULLEY = 'pulley'
    CHAIN = 'chain'
    SLIDER = 'slider'
    GEAR = 'gear'
    RACK = 'rack'
    VELOCITY = 'velocity'
    GRAVITY = 'gravity'
    FORCE = 'force'
    KNIFE = 'knife'


@dataclass(frozen=True, slots=True, kw_only=True)
class ClickResult:
    """
    The result of a click.

    :param requests: to be submitted; empty while the gesture needs more clicks
    :param message: the clicks so far, and the next click; or what several requests make together
    """

    requests: tuple[Request, ...] = ()
    message: Text = NOTHING


@dataclass(frozen=True, slots=True)
class Click:
    """
    A click.

    :param point: in the world [m]
    :param body: the topmost body under it; '' where there is none
    :param local: the point in that body's frame [m]
    """

    point: Point
    body: str = ''
    local: Point = (0.0, 0.0)

    @classmethod
    def at_point(cls, scene: SceneQuery, point: Point) -> Click:
        """Return a click at a point of the world [m]."""
        for name in scene.bodies_at(point):
            return cls(point, name, scene.local(name, point))
        return cls(point)

    def hit_body(self, scene: SceneQuery) -> str:
        """
        Return the name of the body that the click hit.

        :raises NothingThere: it hit no body
        :raises UnknownBody: the body has been deleted since
        """
        if not self.body:
            raise nothing_at(self.point, 'point')
        if self.body not in scene.names:
            raise UnknownBody('{body} no longer exists', field='point', body=self.body)
        return self.body

    def current_point(self, scene: SceneQuery) -> Point:
        """
        Return the clicked point, moved with the body that the click hit [m].

        :raises UnknownBody: the body has been deleted since
        """
        return scene.in_world(self.hit_body(scene), self.local) if self.body else self.point


def checked_distance(start: Point, end: Point, settings: DrawingSettings, name: str) -> float:
    """
    Return the distance of two points [m].

    :param name: of the distance, for the message of the refusal
    :raises BadSize: it is below the least length that clicks can draw
    """
    return checked_length(math.dist(start, end), settings, name)


def checked_length(length: float, settings: DrawingSettings, name: str) -> float:
    """
    Return a length [m].

    :param name: of the length, for the message of the refusal
    :raises BadSize: it is below the least length that clicks can draw
    """
    least = _least(settings)
    if length < least:
        template = '{edge} is {length:.3g} m long; below {least:.3g} m it is a slip of the hand'
        raise BadSize(template, field='point', edge=name, length=length, least=least)
    return length


def without_repeats(points: Sequence[Point], settings: DrawingSettings) -> list[Point]:
    """Return the points without those that repeat the point before."""
    least = _least(settings)
    return [
        point
        for before, point in zip((None, *points), points, strict=False)
        if before is None or math.dist(before, point) >= least
    ]


def _least(settings: DrawingSettings) -> float:
    return max(SLIP * settings.snap, SMALLEST)
