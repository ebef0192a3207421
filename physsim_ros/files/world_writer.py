# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The text of a world file from the state of the world, motion and impulse cache included.

Laws: a body or joint is one line, in JSON, which is YAML too and is read a hundred times as fast;
all texts are quoted; a number has a point before its exponent, as readers of YAML 1.1 need it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
import json
import math
import re

from physsim_ros.files.engine_state import state_entry
from physsim_ros.files.impulse_cache import cache_entry
from physsim_ros.files.joint_reader import command_entries
from physsim_ros.files.world_schema import FORMAT, SETTINGS
from physsim_ros.model.checkpoint import BodyState, WorldState
from physsim_ros.model.colors import Color, color_from
from physsim_ros.model.declarations import entry_of
from physsim_ros.model.errors import WorldFull
from physsim_ros.model.motor_command import TimedCommand
from physsim_ros.model.scene import Joint
from physsim_ros.model.transform import Pose

# Quoted texts, and whole numbers with an exponent.
_TEXT_OR_POWER = re.compile(r'("(?:[^"\\]|\\.)*")|(?<![\d.])(\d+)(?=e)')
# Characters that are printable in JSON but not in YAML.
_UNPRINTABLE = re.compile('[\x7f-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff]')


def text_of(state: WorldState, physics_rate: float, *, longest: float = math.inf) -> str:
    """
    Return the YAML text of a world, one line for each body and joint.

    :param state: of the world
    :param physics_rate: of the world [Hz]
    :param longest: greatest length [characters]; no more than that is written
    :raises WorldFull: the text is longer
    """
    lines: list[str] = []
    length = 0
    for line in _lines(state.at_rate(physics_rate), physics_rate):
        length += len(line)
        if length > longest:
            raise WorldFull(
                'the world as text is longer than {longest} characters', longest=longest
            )
        lines.append(line)
    return ''.join(lines)


def _lines(state: WorldState, physics_rate: float) -> Iterator[str]:
    yield f'format: {FORMAT}\n'
    for key in SETTINGS:
        value = getattr(state.settings, key)
        yield f'{key}: {yaml_line([] if value is None else entry_of(value))}\n'
    if state.lesson is not None:
        yield f'lesson: {yaml_line(state.lesson.entry())}\n'
    yield 'bodies:\n' if state.bodies else 'bodies: []\n'
    for body in state.bodies:
        yield f'  - {yaml_line(_entry(body, physics_rate))}\n'
    if state.joints:
        poses = {body.body.name: body.pose for body in state.bodies}
        commands: dict[str, list[TimedCommand]] = {}
        for each in state.commands:
            commands.setdefault(each.command.joint, []).append(each)
        yield 'joints:\n'
        for joint in state.joints:
            entry = _joint_entry(joint, poses)
            entry.update(command_entries(commands.get(joint.name, []), physics_rate))
            yield f'  - {yaml_line(entry)}\n'
    if state.memory is not None:
        yield '# What the engine remembers of contacts: not to be edited, but may be deleted.\n'
        yield f'memory: {yaml_line(cache_entry(state.memory))}\n'


def yaml_line(value: object) -> str:
    """Return a value in one line that is JSON and YAML, 1.1 and 1.2."""
    text = json.dumps(value, ensure_ascii=False)
    if 'e' in text:
        text = _TEXT_OR_POWER.sub(lambda found: found[1] or f'{found[2]}.0', text)
    return _UNPRINTABLE.sub(lambda found: f'\\u{ord(found[0]):04x}', text)


def _entry(state: BodyState, physics_rate: float) -> dict[str, object]:
    body = state.body
    entry: dict[str, object] = {
        'name': body.name,
        body.shape.KEY: body.shape.entry(),
        'at': list(state.pose),
        'color': _color_entry(body.color),
        **body.entry(),
    }
    if not body.anchored:
        entry |= {'velocity': list(state.twist[:2]), 'spin': state.twist[2]}
    if body.expires is not None:
        entry['lifetime'] = body.expires / physics_rate
    return entry | state_entry(state, physics_rate)


def _joint_entry(joint: Joint, poses: Mapping[str, Pose]) -> dict[str, object]:
    points = joint.drawn_points(poses)
    entry: dict[str, object] = {'name': joint.name, 'kind': str(joint.kind)}
    entry |= {'a': joint.a, 'b': joint.b, 'points': [list(point) for point in points]}
    # Also an empty list, which is not the same as none.
    given = joint.properties.explicit()
    properties: dict[str, object] = {name: entry_of(value) for name, value in given.items()}
    return entry | properties | {'seat': _seat_entry(joint)}


def _seat_entry(joint: Joint) -> list[float]:
    """Return the numbers of its seat, then those of each guide."""
    return [*joint.seat, *(number for guide in joint.guides for number in guide[1:])]


def _color_entry(color: Color) -> object:
    """Return '#rrggbb' or '#rrggbbaa' where that is exact, else the four channels."""
    channels = bytes(round(channel * 255) for channel in color)
    text = '#' + channels[: 3 if channels[3] == 255 else 4].hex()
    return text if color_from(text) == color else list(color)
