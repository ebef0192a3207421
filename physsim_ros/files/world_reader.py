# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The state of a world from the mapping of its file.

Laws: a body is read as a request that spawns it, so that files obey the rules of messages. The
numbers of `motion`, which only the node writes, count where nobody has edited the pose or the
velocity.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
import operator
from typing import Any

import numpy as np
from physsim_ros.engine.body import lead_of, offset_of
from physsim_ros.engine.body_table import LOST
from physsim_ros.engine.core import sub_step_of
from physsim_ros.files.engine_state import acting_from, cache_from, driven_from
from physsim_ros.files.joint_reader import joints_from
from physsim_ros.files.resources import with_shipped_robot
from physsim_ros.files.world_schema import (
    BODY_KEYS,
    count_from,
    entries_of,
    FORMAT,
    naming,
    PARAMETERS,
    PROPERTIES,
    ROUNDING,
    SETTINGS,
    WORLD_KEYS,
)
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checkpoint import BodyState, Motion, WorldState
from physsim_ros.model.checks import LONGEST, number, pair, Within
from physsim_ros.model.colors import Color, color_from
from physsim_ros.model.declarations import check_key, known_mapping
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.lesson import Lesson
from physsim_ros.model.requests import Command, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Shape, SHAPES
from physsim_ros.model.transform import local_to_world, NO_WRENCH, Pose, REST, Twist
from physsim_ros.simulation.world import steps_in
from physsim_ros.simulation.world.body_description import new_body
from physsim_ros.simulation.world.body_requests import check_command, check_namespaces
from physsim_ros.simulation.world.capacity import check_limit
from physsim_ros.simulation.world.live_space import check_start

# Keys of a body whose values follow from `motion`.
_MOTION_KEYS = ('at', 'velocity', 'spin')


def state_from(
    content: Mapping[Any, Any],
    settings: WorldSettings,
    physics_rate: float,
    progress: Callable[[int, int], object] | None = None,
) -> WorldState:
    """
    Return the state of a world file.

    :param content: of the file
    :param settings: those that the file does not set
    :param physics_rate: of the world that continues from it [Hz]
    :param progress: called with the number of bodies that are read, and of all
    :raises Refusal: a key or value; of a body or a joint, `bad_world_file` with its name
    """
    for key in content:
        if key in PARAMETERS:
            raise UnknownProperty(
                f'{key} is a parameter of the node; a world file cannot set it', field=key
            )
        check_key(key, WORLD_KEYS)
    if 'map' in content:
        raise BadProperty(
            'a map is read from beside a world file, and this world has none', field='map'
        )
    if content.get('format') != FORMAT or isinstance(content['format'], bool):
        raise BadProperty(f'format must be {FORMAT}', field='format')
    changes = {key: content[key] for key in SETTINGS if key in content}
    changes |= {key: None for key in ('bounds', 'datum') if changes.get(key) == []}
    settings = replace(settings, **changes)
    lesson = Lesson.from_entry(content['lesson']) if 'lesson' in content else None
    entries = entries_of(content.get('bodies'), 'bodies')
    bodies, unmoved = _body_states(entries, settings, physics_rate, progress)
    check_namespaces(state.body for state in bodies)
    unjoined = WorldState(settings=settings, bodies=bodies, lesson=lesson)
    # One edited body, and the impulses of all contacts are outdated.
    if 'memory' in content and all(state.motion is not None for state in bodies):
        unjoined = replace(unjoined, memory=cache_from(content['memory'], unjoined))
    joints = entries_of(content.get('joints'), 'joints')
    if not joints:
        return unjoined
    return replace(unjoined, joints=joints_from(unjoined, joints, unmoved, physics_rate))


def _body_states(
    entries: list[dict[Any, Any]],
    settings: WorldSettings,
    physics_rate: float,
    progress: Callable[[int, int], object] | None,
) -> tuple[tuple[BodyState, ...], set[str]]:
    """Return the states of bodies, and the names of those whose poses are the saved ones."""
    check_limit('max_bodies', len(entries), settings)
    bodies: dict[str, BodyState] = {}
    unmoved: set[str] = set()
    pieces = 0
    for count, entry in enumerate(entries, 1):
        with naming(entry, 'body', count):
            state, is_unmoved = _body_state(entry, settings, physics_rate)
            if state.body.name in bodies:
                raise BadProperty('the name appears twice', field='name')
            bodies[state.body.name] = state
            if is_unmoved:
                unmoved.add(state.body.name)
        # As they are read: they take longer than their text, which aliases repeat in no time.
        pieces += len(state.body.shape.form.pieces)
        check_limit('max_shapes', pieces, settings)
        if progress is not None:
            progress(count, len(entries))
    for count, (entry, state) in enumerate(zip(entries, bodies.values(), strict=True), 1):
        # Of a saved world, the body that an actor waits for may have been deleted.
        if state.acting is None:
            with naming(entry, 'body', count):
                check_start(state.body, bodies)
    return tuple(bodies.values()), unmoved


def _body_state(
    entry: Mapping[Any, Any], settings: WorldSettings, physics_rate: float
) -> tuple[BodyState, bool]:
    """
    Return the state of a body, without the engine, and whether its pose is the saved one.

    A saved motion counts where nobody has edited the pose or the velocity since.
    """
    saved = 'motion' in entry
    # Saved poses and velocities may exceed the ranges of requests.
    at_rest = {key: entry[key] for key in entry if key not in _MOTION_KEYS}
    spawn = spawn_from(at_rest if saved else entry)
    expires = steps_in(spawn.lifetime, physics_rate) if spawn.lifetime > 0 else None
    body, twist = new_body(spawn, settings, expires)
    wrench, wrench_steps = NO_WRENCH, None
    if 'wrench' in entry:
        command = _wrench(spawn.name, entry['wrench'])
        check_command(body, command)
        if command.wrenches.any():
            fx, fy, torque = command.wrenches[0].tolist()
            wrench = fx, fy, torque
            wrench_steps = _wrench_steps(entry['wrench'], physics_rate)
    state = BodyState(
        body=body, pose=spawn.pose, twist=twist, wrench=wrench, wrench_steps=wrench_steps
    )
    if 'driven' in entry:
        state = replace(state, driven=driven_from(entry['driven'], body, physics_rate))
    if 'acting' in entry:
        state = replace(state, acting=acting_from(entry['acting'], body, physics_rate))
    if not saved:
        return state, False
    sub_step = sub_step_of(physics_rate)
    lead = lead_of(body, wrench, _pose(entry)[2], settings.gravity, sub_step)
    resumed = _saved_state(state, entry, lead)
    if resumed is not None:
        return resumed, True
    spawn = spawn_from(entry)
    _, twist = new_body(spawn, settings, expires)
    state = replace(state, pose=spawn.pose, twist=twist)
    return state, _is_motion(_motion(entry), _engine_pose(state, _pose(entry)))


def spawn_from(entry: Mapping[Any, Any]) -> Spawn:
    """
    Return the request for the body of an entry.

    :raises Refusal: a key is unknown, or a value is out of range
    """
    for key in entry:
        check_key(key, BODY_KEYS)
    entry = with_shipped_robot(entry, BODY_KEYS)
    name = entry.get('name')
    if not isinstance(name, str):
        raise BadProperty('a body needs a name', field='name')
    return Spawn(
        name=name,
        shape=_shape(entry),
        pose=_pose(entry),
        color=_color(entry['color']) if 'color' in entry else None,
        lifetime=number(entry.get('lifetime', 0.0), 'lifetime'),
        properties=Properties.from_mapping(
            {key: entry[key] for key in PROPERTIES if key in entry}
        ),
    )


def robot_spawn(
    robot: str | Mapping[Any, Any], *, name: str = 'robot/0', at: Sequence[float] = (0.0, 0.0)
) -> Spawn:
    """
    Return the request for a shipped robot.

    :param robot: its name, or a mapping with that as `from`, and what is different
    :param name: of its body
    :param at: x, y [m] and, where there are three, yaw [rad]
    :raises Refusal: there is no such robot, or a value is out of range
    """
    return spawn_from({'name': name, 'robot': robot, 'at': [*at]})


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
    return Command(names=(name,), wrenches=np.array(((*force, torque),)))


def _wrench_steps(wrench: Mapping[Any, Any], physics_rate: float) -> int | None:
    """Return the number of steps for which a wrench acts; None is for ever."""
    seconds, steps = wrench.get('seconds'), wrench.get('steps')
    if seconds is not None:
        seconds = Within(0.0, LONGEST, 's')(seconds, 'seconds')
        # One that ends at the step at which it was saved acts no more.
        return steps_in(seconds, physics_rate) if seconds > 0.0 else 0
    # Older files have steps, of the rate at which they were saved.
    if steps is None or count_from(steps, 'steps') <= LONGEST * physics_rate:
        return steps
    raise BadProperty(f'steps are more than {LONGEST:g} s', field='steps')


def _saved_state(state: BodyState, entry: Mapping[Any, Any], lead: Twist) -> BodyState | None:
    """
    Return a body with the pose, twist and motion of its entry.

    :param entry: the body in the file
    :param lead: half-step lead of the body in free flight [m/s, m/s, rad/s]
    :return: None where pose or velocity were edited since
    """
    motion, pose = _motion(entry), _pose(entry)
    velocity = pair(entry.get('velocity', [0.0, 0.0]), 'velocity')
    twist = (*velocity, number(entry.get('spin', 0.0), 'spin'))
    # In free flight the engine's velocity is half a sub-step ahead of the reported one.
    ahead = lead if motion.free else REST
    if state.body.anchored and any(twist):
        return None
    if not _is_motion(motion, (*_engine_pose(state, pose), *map(operator.add, twist, ahead))):
        return None
    if max(map(abs, motion[:6])) > LOST:
        raise BadProperty('motion is out of range', field='motion')
    return replace(state, pose=pose, twist=twist, motion=motion)


def _is_motion(motion: Motion, written: tuple[float, ...]) -> bool:
    """Tell whether numbers are those of a motion; `is_same` takes ten times as long for so few."""
    return all(
        abs(one - other) <= ROUNDING + ROUNDING * abs(other)
        for one, other in zip(motion, written, strict=False)
    )


def _motion(entry: Mapping[Any, Any]) -> Motion:
    values = entry['motion']
    if not isinstance(values, list) or len(values) != 7 or not isinstance(values[6], bool):
        raise BadProperty('motion must be six numbers and true or false', field='motion')
    x, y, yaw, vx, vy, spin = (number(each, 'motion') for each in values[:6])
    return Motion(x, y, yaw, vx, vy, spin, values[6])


def _engine_pose(state: BodyState, pose: Pose) -> Pose:
    """
    Return the pose of the engine's body, whose origin is the centre of mass.

    :param pose: of the body's own origin in the world [m, rad]
    """
    return *local_to_world(offset_of(state.body), pose), pose[2]
