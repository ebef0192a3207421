# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages of the pen, of click tools and of the hand, and the material of what is drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from physsim_ros.drawing import Tool
from physsim_ros.model.arrays import Floats
from physsim_ros.model.body_properties import Properties, properties_from
from physsim_ros.model.checks import number, pair, shown
from physsim_ros.model.colors import Color
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.requests import Grab, HandRequest, LetGo, MoveHand
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.model.transform import Point
from physsim_ros.sketchpad.messages.fields import color_of, Fields, point_of, Readers, text_of

# Name of a hand until it gets that of its page.
_HAND = 'page'
# The properties that a page may choose for the bodies that it draws.
_MATERIAL = ['density', 'friction', 'elasticity', 'velocity']


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Stroke:
    """
    Read a stroke.

    :param samples: (n, 3) float64: x, y [m], time from any start [s]
    """

    samples: Floats


@dataclass(frozen=True, slots=True, kw_only=True)
class Click:
    """Click with a tool [m]; another tool than before drops the unfinished gesture."""

    tool: Tool
    point: Point


@dataclass(frozen=True, slots=True, kw_only=True)
class Instead:
    """
    Read the last stroke otherwise.

    :param meaning: one of its guesses; '' is the next one
    """

    meaning: str = ''


@dataclass(frozen=True, slots=True, kw_only=True)
class Drop:
    """Drop the unfinished gesture."""


@dataclass(frozen=True, slots=True, kw_only=True)
class UseHand:
    """
    Grab, drag or let go with the hand of this page.

    :param request: of some hand, whose name is replaced by that of the page's own
    """

    request: HandRequest


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawWith:
    """
    Choose the material of what this page draws next.

    :param properties: that bodies get; those that are not set stay as they were
    :param color: that bodies get; None stays as it was, '' is one of the world's choice
    """

    properties: Properties
    color: Color | Literal[''] | None = None


def _stroke(fields: Fields) -> Stroke:
    points = fields.get('points')
    if not isinstance(points, list) or len(points) > MOST_SAMPLES:
        raise Malformed(f'a stroke is a list of at most {MOST_SAMPLES} points', field='points')
    for point in points:
        if not isinstance(point, list) or len(point) != 3:
            raise Malformed('a point of a stroke is [x, y, time]', field='points')
        if not all(type(each) in (int, float) for each in point):
            raise BadProperty('a point of a stroke is three numbers', field='points')
    try:
        samples = np.array(points, dtype=np.float64).reshape(-1, 3)
    except OverflowError as error:
        raise Malformed('a sample of the stroke is not finite', field='points') from error
    if not np.isfinite(samples).all():
        raise Malformed('a sample of the stroke is not finite', field='points')
    if len(samples):
        samples[:, 2] -= samples[0, 2]
    return Stroke(samples=samples)


def _instead(fields: Fields) -> Instead:
    return Instead(meaning=text_of(fields.get('meaning', ''), 'meaning'))


def _click(fields: Fields) -> Click:
    tool = fields.get('tool')
    if tool not in list(Tool):
        raise BadProperty(f'there is no tool {shown(tool)}', field='tool')
    return Click(tool=Tool(tool), point=point_of(fields.get('point'), 'point'))


def _grab(fields: Fields) -> UseHand:
    return UseHand(request=Grab(hand=_HAND, point=pair(fields.get('point'), 'point')))


def _move(fields: Fields) -> UseHand:
    yaw = number(fields['yaw'], 'yaw') if 'yaw' in fields else None
    return UseHand(request=MoveHand(hand=_HAND, point=pair(fields.get('point'), 'point'), yaw=yaw))


def _let_go(_: Fields) -> UseHand:
    return UseHand(request=LetGo(hand=_HAND))


def _draw_with(fields: Fields) -> DrawWith:
    properties = {key: fields[key] for key in _MATERIAL if key in fields}
    color: Color | Literal[''] | None = None
    if 'color' in fields:
        color = '' if fields['color'] == '' else color_of(fields['color'])
    return DrawWith(properties=properties_from(properties), color=color)


READERS: Readers = {
    'stroke': (['points'], _stroke),
    'instead': (['meaning'], _instead),
    'click': (['tool', 'point'], _click),
    'drop': ([], lambda _: Drop()),
    'grab': (['point'], _grab),
    'move': (['point', 'yaw'], _move),
    'let_go': ([], _let_go),
    'draw_with': ([*_MATERIAL, 'color'], _draw_with),
}
