# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Bodies, joints and walls as markers: type, scale, points, colour and text, without pose.

Law: the marker of a body, published to `~/spawn`, spawns an equal body; the first marker of a
joint, published to `~/join`, makes an equal joint.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
import re
from typing import Any

from physsim_ros.files import yaml_line
from physsim_ros.model.colors import Color, is_bright
from physsim_ros.model.names import (
    CROSS_PREFIX,
    HANDS,
    JOINT_PREFIX,
    LINES_PREFIX,
    split_name,
    WALLS,
)
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.settings import Bounds
from physsim_ros.model.transform import Point
from physsim_ros.ros.marker_shapes import geometry_of, Size, THIN
from visualization_msgs.msg import Marker

Key = tuple[str, int]

# Height of joints, above bodies and their crosses [m].
_RAISED = 2 * THIN
# Of the lines from bodies to the hands that drag them [m].
_HAND_WIDTH = 0.02
_HAND = (0.9, 0.2, 0.5, 1.0)
_DARK, _LIGHT, _GREY = (0.1, 0.1, 0.1, 1.0), (0.9, 0.9, 0.9, 1.0), (0.5, 0.5, 0.5, 1.0)
# A key in JSON; within a text, quotes are escaped.
_KEY = re.compile(r'"(\w+)": ')


@dataclass(frozen=True, slots=True)
class BareMarker:
    """
    A marker without its pose.

    :param key: namespace and id
    :param kind: type of the marker
    :param height: z of its points [m]; higher ones are drawn on top
    """

    key: Key
    kind: int = Marker.ARROW
    scale: Size = (0.0, 0.0, 0.0)
    points: tuple[Point, ...] = ()
    height: float = 0.0
    color: Color = (0.0, 0.0, 0.0, 0.0)
    text: str = ''
    action: int = Marker.ADD


def body_markers(body: Body) -> list[BareMarker]:
    """Return the markers of a body: the body, and the x of an anchored one."""
    key = split_name(body.name)
    kind, scale, points = geometry_of(body.shape)
    markers = [BareMarker(key, kind, scale, points, color=body.color, text=_text(body.entry()))]
    if body.anchored:
        markers.append(_cross(body, (f'{CROSS_PREFIX}{key[0]}', key[1])))
    return markers


def joint_markers(joint: Joint, size: float, corners: int) -> tuple[BareMarker, BareMarker]:
    """
    Return the markers of a joint: its points, which make an equal joint, and its lines.

    All points are 0; a frame writes them.

    :param size: half the size of its symbol [m]
    :param corners: number of corners of its lines, two for each segment
    """
    namespace, number = split_name(joint.name)
    if joint.kind.points == 1:
        kind, scale = Marker.SPHERE_LIST, (size, size, size)
    else:
        kind, scale = Marker.LINE_STRIP, (size / 10, 0.0, 0.0)
    key, lines_key = (f'{JOINT_PREFIX}{namespace}', number), (f'{LINES_PREFIX}{namespace}', number)
    points, lines = ((0.0, 0.0),) * joint.kind.points, ((0.0, 0.0),) * corners
    return (
        BareMarker(key, kind, scale, points, _RAISED, text=_terms(joint)),
        BareMarker(lines_key, Marker.LINE_LIST, (size / 4, 0.0, 0.0), lines, _RAISED),
    )


def _terms(joint: Joint) -> str:
    """Return the bodies and properties of a joint, for `text`."""
    ends = {'a': joint.a, 'b': joint.b}
    # Without the values as drawn, the new joint would measure them anew.
    rest = _text(ends | joint.properties.explicit() | joint.drawn_values())
    return f'{{kind: {joint.kind}, {rest[1:]}'


def _text(properties: Mapping[str, Any]) -> str:
    """Return properties as a YAML mapping, whose keys, which are plain words, are not quoted."""
    return _KEY.sub(r'\1: ', yaml_line(properties))


def _cross(body: Body, key: Key) -> BareMarker:
    """Return the small x at the centre of mass of an anchored body."""
    form = body.shape.form
    # About a third of the smaller side: area / outer radius is about 1.5 of it.
    reach = min(max(form.area / form.outer / 5, 0.06), 0.3) / 2
    x, y = form.centroid
    points = (
        (x - reach, y - reach),
        (x + reach, y + reach),
        (x - reach, y + reach),
        (x + reach, y - reach),
    )
    color = _DARK if is_bright(body.color) else _LIGHT
    return BareMarker(key, Marker.LINE_LIST, (reach / 4, 0.0, 0.0), points, THIN, color)


def hands_marker(count: int) -> BareMarker:
    """Return the marker of hands: a line from each dragged body; a frame writes the points."""
    points = ((0.0, 0.0),) * (2 * count)
    key = (HANDS, 0)
    return BareMarker(key, Marker.LINE_LIST, (_HAND_WIDTH, 0.0, 0.0), points, _RAISED, _HAND)


def wall_marker(bounds: Bounds) -> BareMarker:
    """Return the marker of the walls around the world."""
    left, bottom, right, top = bounds
    corners = ((left, bottom), (right, bottom), (right, top), (left, top), (left, bottom))
    key = (WALLS, 0)
    return BareMarker(key, Marker.LINE_STRIP, (THIN, 0.0, 0.0), corners, color=_GREY)
