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
from physsim_ros.model.arrays import Floats
from physsim_ros.model.checks import check_key, flag, number, pair, shown
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.requests import check_point, Configure, Delete, Request
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.model.transform import Point
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
class Drop:
    """Drop the unfinished gesture."""


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
    """Go to a simulation time [s]."""

    time: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ShowParts:
    """Choose the parts of a frame that this page gets."""

    show: Show


Message = Submit | Stroke | Click | Drop | Perform | SetSpeed | Seek | ShowParts


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


def _delete(fields: Mapping[str, Any]) -> Submit:
    names = _names(fields.get('names'), 'names')
    return Submit(requests=tuple(Delete(name=name) for name in names), topic='~/spawn')


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
    'service': (['name', 'world'], _perform),
    'speed': (['speed'], lambda fields: SetSpeed(speed=number(fields.get('speed'), 'speed'))),
    'seek': (['time'], lambda fields: Seek(time=number(fields.get('time'), 'time'))),
    'delete': (['names'], _delete),
    'gravity': (['gravity'], _gravity),
    'show': (list(_PARTS), _show),
}
