# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
Messages of a page: from untrusted text to checked values.

Laws: a message is checked whole, on the server's thread, before the world's thread gets it; what
it asks of the world is one of the world's own requests.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
import json
from typing import Any, NamedTuple

import numpy as np
from physsim_ros.drawing import Tool
from physsim_ros.files import spawn_from
from physsim_ros.model.arrays import Floats
from physsim_ros.model.body_properties import Properties, properties_from
from physsim_ros.model.checks import (
    check_key,
    check_point,
    flag,
    LONGEST,
    number,
    pair,
    shown,
    Whole,
    Within,
)
from physsim_ros.model.colors import Color, color_from
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.requests import (
    ChangeBody,
    Configure,
    DeleteBodies,
    Grab,
    HandRequest,
    LetGo,
    MoveBodies,
    MoveHand,
    Request,
)
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.model.transform import Point, Pose
from physsim_ros.sketchpad.frame_codec import Show

# Depth of nested lists and mappings; a stroke has three levels, a body five.
DEEPEST = 8
# Length of the identifier of a message [characters].
LONGEST_ID = 64
# Length of a name of a body, a joint or a world [characters], as in `model.names`.
LONGEST_NAME = 1000
# Names in one message.
MOST_NAMES = 1000
# Actions that need nothing but a name: those of the services.
ACTIONS = (
    'play',
    'pause',
    'rewind',
    'fast_forward',
    'fast_rewind',
    'step',
    'undo',
    'redo',
    'reset',
    'clear',
    'save_world',
    'load_world',
)


class Envelope(NamedTuple):
    """
    A message that is not checked yet.

    :ivar request: identifier that the page gave to it; its answers carry it
    :ivar kind: its `type`
    :ivar fields: everything else
    """

    request: str
    kind: str
    fields: dict[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Submit:
    """
    Submit requests that are undone together.

    :param requests: in order
    :param topic: on which a node would publish them; answers and events name it
    """

    requests: tuple[Request, ...]
    topic: str


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
    :param color: that bodies get; None stays as it was
    """

    properties: Properties
    color: Color | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Copy:
    """
    Add a body like another one, at rest.

    :param name: of the body
    :param to: position of the copy [m]
    """

    name: str
    to: Point


@dataclass(frozen=True, slots=True, kw_only=True)
class Watch:
    """
    Ask for the past of a body, as far as it was shown.

    :param name: of the body; '' is none
    """

    name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """Ask for the world as the text of a world file."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Upload:
    """
    Replace the world by that of a file.

    :param content: of the world file
    """

    content: Mapping[Any, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Perform:
    """
    Perform what a service does.

    :param action: one of `ACTIONS`
    :param world: name of the world to save or load; '' is the one of parameter `world_file`
    """

    action: str
    world: str = ''


@dataclass(frozen=True, slots=True, kw_only=True)
class SetSpeed:
    """Set the speed of time [simulation seconds a second]."""

    speed: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Seek:
    """Go to a simulation time [ns]."""

    stamp: int


@dataclass(frozen=True, slots=True, kw_only=True)
class ReturnToCourse:
    """Return to a course of events that was left, by its number."""

    course: int


@dataclass(frozen=True, slots=True, kw_only=True)
class ShowParts:
    """Choose the parts of a frame that this page gets."""

    show: Show


Message = (
    Submit
    | Stroke
    | Click
    | Drop
    | Instead
    | UseHand
    | DrawWith
    | Copy
    | Watch
    | Share
    | Upload
    | Perform
    | SetSpeed
    | Seek
    | ReturnToCourse
    | ShowParts
)
# Messages that a page may send which only shows the world.
OF_VIEWERS = (ShowParts, Watch)
# Name of a hand until it gets that of its page.
_HAND = 'page'


def read_envelope(text: str) -> Envelope:
    """
    Return identifier, type and fields of a message.

    :raises Malformed: it is no JSON object, too deep, or without identifier or type
    """
    try:
        value = json.loads(text, parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        raise Malformed('the message is not JSON', field='message') from error
    if not isinstance(value, dict):
        raise Malformed('the message is no JSON object', field='message')
    _check_depth(value)
    id_ = value.pop('id', '')
    if not isinstance(id_, str) or len(id_) > LONGEST_ID:
        raise Malformed(f'id must be a text of at most {LONGEST_ID} characters', field='id')
    kind = value.pop('type', None)
    if not isinstance(kind, str):
        raise Malformed('the message has no type', field='type')
    return Envelope(id_, kind, value)


def message_from(envelope: Envelope) -> Message:
    """
    Return the checked message of an envelope.

    :raises Refusal: it has an unknown type or field, or a value that is out of range
    """
    if envelope.kind not in _READERS:
        raise Malformed(f'there is no message {shown(envelope.kind)}', field='type')
    known, read = _READERS[envelope.kind]
    for key in envelope.fields:
        check_key(key, known)
    return read(envelope.fields)


def _refuse_constant(name: str) -> float:
    raise ValueError(name)


def _check_depth(value: object) -> None:
    """
    Refuse a value of too many levels.

    :raises Malformed: it has
    """
    level = [value]
    for _ in range(DEEPEST):
        level = [
            child
            for each in level
            if isinstance(each, list | dict)
            for child in (each.values() if isinstance(each, dict) else each)
            if isinstance(child, list | dict)
        ]
        if not level:
            return
    raise Malformed(f'the message has more than {DEEPEST} levels', field='message')


def _text(value: object, name: str) -> str:
    if not isinstance(value, str) or len(value) > LONGEST_NAME:
        raise BadProperty(f'{name} must be a text, not {shown(value)}', field=name)
    return value


def _names(value: object, name: str) -> tuple[str, ...]:
    if not isinstance(value, list) or not 0 < len(value) <= MOST_NAMES:
        raise BadProperty(f'{name} must be a list of 1 to {MOST_NAMES} names', field=name)
    return tuple(_text(each, name) for each in value)


def _point(value: object, name: str) -> Point:
    point = pair(value, name)
    check_point(point, name)
    return point


def _stroke(fields: Mapping[str, Any]) -> Stroke:
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


def _instead(fields: Mapping[str, Any]) -> Instead:
    return Instead(meaning=_text(fields.get('meaning', ''), 'meaning'))


def _click(fields: Mapping[str, Any]) -> Click:
    tool = fields.get('tool')
    if tool not in list(Tool):
        raise BadProperty(f'there is no tool {shown(tool)}', field='tool')
    return Click(tool=Tool(tool), point=_point(fields.get('point'), 'point'))


def _perform(fields: Mapping[str, Any]) -> Perform:
    action = fields.get('name')
    if action not in ACTIONS:
        raise BadProperty(f'there is no service {shown(action)}', field='name')
    return Perform(action=action, world=_text(fields.get('world', ''), 'world'))


def _seek(fields: Mapping[str, Any]) -> Seek:
    return Seek(stamp=round(Within(0.0, LONGEST, 's')(fields.get('time'), 'time') * 1e9))


def _course(fields: Mapping[str, Any]) -> ReturnToCourse:
    return ReturnToCourse(course=Whole(0, 2**31)(fields.get('course'), 'course'))


def _save(fields: Mapping[str, Any]) -> Perform:
    return Perform(action='save_world', world=_world_name(fields))


def _open(fields: Mapping[str, Any]) -> Perform:
    return Perform(action='load_world', world=_world_name(fields))


def _world_name(fields: Mapping[str, Any]) -> str:
    name = _text(fields.get('name'), 'name')
    if not name:
        raise BadProperty('a world has a name', field='name')
    return name


def _grab(fields: Mapping[str, Any]) -> UseHand:
    return UseHand(request=Grab(hand=_HAND, point=pair(fields.get('point'), 'point')))


def _move(fields: Mapping[str, Any]) -> UseHand:
    yaw = number(fields['yaw'], 'yaw') if 'yaw' in fields else None
    return UseHand(request=MoveHand(hand=_HAND, point=pair(fields.get('point'), 'point'), yaw=yaw))


def _let_go(_: Mapping[str, Any]) -> UseHand:
    return UseHand(request=LetGo(hand=_HAND))


# The properties that a page may choose for the bodies that it draws.
_MATERIAL = ['density', 'friction', 'elasticity', 'velocity']


def _draw_with(fields: Mapping[str, Any]) -> DrawWith:
    properties = {key: fields[key] for key in _MATERIAL if key in fields}
    color = _color(fields['color']) if 'color' in fields else None
    return DrawWith(properties=properties_from(properties), color=color)


def _color(value: object) -> Color:
    return color_from(_text(value, 'color'))


def _copy(fields: Mapping[str, Any]) -> Copy:
    return Copy(name=_text(fields.get('name'), 'name'), to=_point(fields.get('to'), 'to'))


def _watch(fields: Mapping[str, Any]) -> Watch:
    return Watch(name=_text(fields.get('name'), 'name'))


def _delete(fields: Mapping[str, Any]) -> Submit:
    names = _names(fields.get('names'), 'names')
    return Submit(requests=(DeleteBodies(names=names),), topic='~/spawn')


def _change(fields: Mapping[str, Any]) -> Submit:
    name = _text(fields.get('name'), 'name')
    given = fields.get('properties')
    if not isinstance(given, dict):
        raise BadProperty('properties must be a mapping', field='properties')
    properties = {key: value for key, value in given.items() if key not in ('color', 'at')}
    request = ChangeBody(
        name=name,
        properties=properties_from(properties),
        color=_color(given['color']) if 'color' in given else None,
        pose=_pose(given['at']) if 'at' in given else None,
    )
    return Submit(requests=(request,), topic='~/spawn')


def _pose(value: object) -> Pose:
    if not isinstance(value, list) or len(value) != 3:
        raise Malformed('at must be [x, y, yaw]', field='at')
    x, y, yaw = (number(each, 'at') for each in value)
    return x, y, yaw


def _move_bodies(fields: Mapping[str, Any]) -> Submit:
    names = _names(fields.get('names'), 'names')
    request = MoveBodies(names=names, by=_point(fields.get('by'), 'by'))
    return Submit(requests=(request,), topic='~/command')


def _spawn(fields: Mapping[str, Any]) -> Submit:
    body = fields.get('body')
    if not isinstance(body, dict):
        raise BadProperty('body must be a mapping', field='body')
    return Submit(requests=(spawn_from(body),), topic='~/spawn')


def _gravity(fields: Mapping[str, Any]) -> Submit:
    gravity = pair(fields.get('gravity'), 'gravity')
    return Submit(requests=(Configure(changes={'gravity': gravity}),), topic='gravity')


_PARTS = {'velocities': Show.VELOCITIES, 'contacts': Show.CONTACTS, 'forces': Show.FORCES}


def _show(fields: Mapping[str, Any]) -> ShowParts:
    show = Show.POSES
    for name, part in _PARTS.items():
        if flag(fields.get(name, False), name):
            show |= part
    return ShowParts(show=show)


# Fields and reader of each type of message.
_READERS: dict[str, tuple[list[str], Callable[[Mapping[str, Any]], Message]]] = {
    'stroke': (['points'], _stroke),
    'click': (['tool', 'point'], _click),
    'drop': ([], lambda _: Drop()),
    'instead': (['meaning'], _instead),
    'grab': (['point'], _grab),
    'move': (['point', 'yaw'], _move),
    'let_go': ([], _let_go),
    'draw_with': ([*_MATERIAL, 'color'], _draw_with),
    'copy': (['name', 'to'], _copy),
    'watch': (['name'], _watch),
    'share': ([], lambda _: Share()),
    'save': (['name'], _save),
    'open': (['name'], _open),
    'service': (['name', 'world'], _perform),
    'speed': (['speed'], lambda fields: SetSpeed(speed=number(fields.get('speed'), 'speed'))),
    'seek': (['time'], _seek),
    'spawn': (['body'], _spawn),
    'change': (['name', 'properties'], _change),
    'move_bodies': (['names', 'by'], _move_bodies),
    'delete': (['names'], _delete),
    'course': (['course'], _course),
    'gravity': (['gravity'], _gravity),
    'show': (list(_PARTS), _show),
}
