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
The state of a world from the mapping of its file.

Laws: bodies are spawned by a world, so that a file is held to the rules of a message; numbers that
only the node writes count where nobody has edited the values that they belong to.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from physsim_ros.engine.body_table import LOST
from physsim_ros.files.entries import count_from, entries_of, is_same, naming
from physsim_ros.files.impulse_cache import cache_from
from physsim_ros.files.joint_reader import joints_from
from physsim_ros.files.world_schema import FORMAT, PARAMETERS, PROPERTIES, SETTINGS
from physsim_ros.model.body_properties import properties_from
from physsim_ros.model.checkpoint import BodyState, Motion, WorldState
from physsim_ros.model.checks import check_key, known_mapping, number, pair, Within
from physsim_ros.model.colors import Color, color_from
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.requests import Command, LONGEST, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Shape, SHAPES
from physsim_ros.model.transform import Pose, rotated
from physsim_ros.simulation.world import steps_in, World

_BODY_KEYS = ['name', *SHAPES, 'at', 'color', 'lifetime', *PROPERTIES, 'motion', 'wrench']
# Keys of a body whose values follow from `motion`.
_MOTION_KEYS = ('at', 'velocity', 'spin')


def state_from(
    content: Mapping[Any, Any], settings: WorldSettings, physics_rate: float
) -> WorldState:
    """
    Return the state of a world file.

    :param content: of the file
    :param settings: those that the file does not set
    :param physics_rate: of the world that continues from it [Hz]
    :raises Refusal: a key or value; of a body or a joint, `bad_world_file` with its name
    """
    for key in content:
        if key in PARAMETERS:
            raise UnknownProperty(
                f'{key} is a parameter of the node, which no world file holds', field=key
            )
        check_key(key, ['format', 'bodies', 'joints', 'memory', *SETTINGS])
    if content.get('format') != FORMAT or isinstance(content['format'], bool):
        raise BadProperty(f'format must be {FORMAT}', field='format')
    changes = {key: content[key] for key in SETTINGS if key in content}
    if changes.get('bounds') == []:
        changes['bounds'] = None
    world = World(physics_rate=physics_rate, settings=replace(settings, **changes))
    entries = _spawned(world, entries_of(content.get('bodies'), 'bodies'))
    resumed: dict[str, BodyState] = {}
    unmoved: set[str] = set()
    for state in world.save().bodies:
        entry = entries[state.body.name]
        if 'motion' in entry:
            with naming(entry):
                saved = _saved_state(state, entry)
                if saved is not None:
                    resumed[state.body.name] = saved
                else:
                    world.apply(spawn_from(entry))
                if saved is not None or _is_unmoved(state, entry):
                    unmoved.add(state.body.name)
    spawned = world.save()
    bodies = [resumed.get(state.body.name, state) for state in spawned.bodies]
    # One edited body, and the impulses of all contacts are outdated.
    unedited = len(resumed) == len(bodies) and 'memory' in content
    unjoined = replace(
        spawned,
        bodies=tuple(
            _with_wrench_time(each, entries[each.body.name], physics_rate) for each in bodies
        ),
        memory=cache_from(content['memory'], spawned) if unedited else None,
    )
    joints = entries_of(content.get('joints'), 'joints')
    if not joints:
        return unjoined
    return replace(unjoined, joints=joints_from(unjoined, joints, unmoved, physics_rate))


def _spawned(world: World, entries: list[dict[Any, Any]]) -> dict[str, dict[Any, Any]]:
    """
    Spawn the bodies of a file, those with a saved motion at the origin and at rest.

    :return: the entries by name
    """
    named: dict[str, dict[Any, Any]] = {}
    for count, entry in enumerate(entries, 1):
        with naming(entry, 'body', count):
            # Saved poses and velocities may exceed the ranges of requests.
            at_rest = {key: entry[key] for key in entry if key not in _MOTION_KEYS}
            spawn = spawn_from(at_rest if 'motion' in entry else entry)
            if spawn.name in named:
                raise BadProperty('the name comes twice', field='name')
            world.apply(spawn)
            if 'wrench' in entry:
                world.apply(_wrench(spawn.name, entry['wrench']))
        named[spawn.name] = entry
    return named


def spawn_from(entry: dict[Any, Any]) -> Spawn:
    """
    Return the request for the body of an entry.

    :raises Refusal: a key is unknown, or a value is out of range
    """
    for key in entry:
        check_key(key, _BODY_KEYS)
    name = entry.get('name')
    if not isinstance(name, str):
        raise BadProperty('a body needs a name', field='name')
    return Spawn(
        name=name,
        shape=_shape(entry),
        pose=_pose(entry),
        color=_color(entry['color']) if 'color' in entry else None,
        lifetime=number(entry.get('lifetime', 0.0), 'lifetime'),
        properties=properties_from({key: entry[key] for key in PROPERTIES if key in entry}),
    )


def _shape(entry: Mapping[Any, Any]) -> Shape:
    named = [key for key in SHAPES if key in entry]
    if len(named) != 1:
        raise BadProperty(f'a body has one of {", ".join(SHAPES)}', field='shape')
    return SHAPES[named[0]].from_entry(entry[named[0]])


def _pose(entry: Mapping[Any, Any]) -> Pose:
    at = entry.get('at', [0.0, 0.0])
    if not isinstance(at, list) or len(at) not in (2, 3):
        raise BadProperty('at must be [x, y] or [x, y, yaw]', field='at')
    return (*pair(at[:2], 'at'), number(at[2], 'at') if len(at) == 3 else 0.0)


def _color(value: object) -> Color:
    if isinstance(value, str):
        return color_from(value)
    if not isinstance(value, list) or len(value) != 4:
        raise BadProperty('color must be a string or [r, g, b, a]', field='color')
    red, green, blue, alpha = (number(each, 'color') for each in value)
    return red, green, blue, alpha


def _wrench(name: str, value: object) -> Command:
    wrench = known_mapping(value, 'wrench', ['force', 'torque', 'seconds', 'steps'])
    force, torque = pair(wrench.get('force'), 'force'), number(wrench.get('torque'), 'torque')
    return Command(names=(name,), wrenches=((*force, torque),))


def _with_wrench_time(
    state: BodyState, entry: Mapping[Any, Any], physics_rate: float
) -> BodyState:
    """Return a body whose wrench ends when the file says."""
    if 'wrench' not in entry:
        return state
    with naming(entry):
        return replace(state, wrench_steps=_wrench_steps(entry['wrench'], physics_rate))


def _wrench_steps(wrench: Mapping[Any, Any], physics_rate: float) -> int | None:
    """Return the number of steps for which a wrench acts; None is for ever."""
    seconds, steps = wrench.get('seconds'), wrench.get('steps')
    if seconds is not None:
        return steps_in(Within(0.0, LONGEST, 's')(seconds, 'seconds'), physics_rate)
    # Older files have steps, of the rate at which they were saved.
    if steps is None or count_from(steps, 'steps') <= LONGEST * physics_rate:
        return steps
    raise BadProperty(f'steps are more than {LONGEST:g} s', field='steps')


def _saved_state(state: BodyState, entry: Mapping[Any, Any]) -> BodyState | None:
    """
    Return a body with the pose, twist and motion of its entry.

    :param state: the body at the origin, at rest
    :param entry: the body in the file
    :return: None where somebody has edited the pose or the velocity since
    """
    motion, pose = _motion(entry), _pose(entry)
    velocity = pair(entry.get('velocity', [0.0, 0.0]), 'velocity')
    twist = (*velocity, number(entry.get('spin', 0.0), 'spin'))
    assert state.motion is not None  # noqa: S101 - a world's own state
    # In free flight the engine's velocity is half a step ahead of the reported one.
    lead = state.motion[3:6] if motion.free else (0.0, 0.0, 0.0)
    if state.body.anchored and any(twist):
        return None
    if not is_same(motion[:6], (*_engine_pose(state, pose), *np.add(twist, lead))):
        return None
    if np.abs(motion[:6]).max() > LOST:
        raise BadProperty('motion is out of range', field='motion')
    return replace(state, pose=pose, twist=twist, motion=motion)


def _motion(entry: Mapping[Any, Any]) -> Motion:
    values = entry['motion']
    if not isinstance(values, list) or len(values) != 7 or not isinstance(values[6], bool):
        raise BadProperty('motion must be six numbers and true or false', field='motion')
    x, y, yaw, vx, vy, spin = (number(each, 'motion') for each in values[:6])
    return Motion(x, y, yaw, vx, vy, spin, values[6])


def _is_unmoved(state: BodyState, entry: Mapping[Any, Any]) -> bool:
    """
    Tell whether the pose of a body is the saved one, whatever else somebody has edited.

    :param state: the body at the origin
    """
    return is_same(_motion(entry)[:3], _engine_pose(state, _pose(entry)))


def _engine_pose(state: BodyState, pose: Pose) -> Pose:
    """
    Return the pose of the engine's body, whose origin is the centre of mass.

    :param state: the body at the origin
    :param pose: of the body's own origin in the world [m, rad]
    """
    assert state.motion is not None  # noqa: S101 - a world's own state
    x, y = rotated((state.motion.x, state.motion.y), pose[2])
    return pose[0] + x, pose[1] + y, pose[2]
