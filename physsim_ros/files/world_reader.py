# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The state of a world from the mapping of its file.

Laws: a body is read as a request that spawns it, so that files obey the rules of messages. The
numbers of `motion`, which only the node writes, count where nobody has edited the pose or the
velocity.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

from physsim_ros.files.engine_state import is_where_saved, with_saved_motion, with_saved_state
from physsim_ros.files.impulse_cache import cache_from
from physsim_ros.files.joint_reader import commands_from, joints_from
from physsim_ros.files.robot_files import with_shipped_robot
from physsim_ros.files.world_schema import (
    BODY_KEYS,
    entries_of,
    FORMAT,
    LIMITS,
    naming,
    PROPERTIES,
    SETTINGS,
    WORLD_KEYS,
)
from physsim_ros.model.body_description import check_namespaces, check_start, new_body
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checkpoint import BodyState, WorldState
from physsim_ros.model.checks import number, pair
from physsim_ros.model.colors import color_value
from physsim_ros.model.declarations import check_key
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.lesson import Lesson
from physsim_ros.model.requests import parts_of, Spawn
from physsim_ros.model.settings import check_limit, OF_WORLD, WorldSettings
from physsim_ros.model.shapes import shape_in, SHAPES
from physsim_ros.model.spelling import canonical
from physsim_ros.model.transform import Pose
from physsim_ros.simulation.world import steps_covering

# Keys of a body whose values follow from `motion`.
_MOTION_KEYS = ('at', 'velocity', 'spin')


def state_from(
    content: Mapping[Any, Any],
    settings: WorldSettings,
    physics_rate: float,
    parameters: Collection[str] = LIMITS,
) -> WorldState:
    """
    Return the state of a world file.

    :param content: of the file
    :param settings: those that the file does not set
    :param physics_rate: of the world that continues from it [Hz]
    :param parameters: names that a node has for what is no setting of a world
    :raises Refusal: a key or value; of a body or a joint, `bad_world_file` with its name
    """
    for key in content:
        if key in parameters and key not in WORLD_KEYS:
            raise UnknownProperty(
                '{field} is a parameter of the node; a world file cannot set it', field=key
            )
        check_key(key, WORLD_KEYS)
    if 'map' in content:
        raise BadProperty(
            'a map is read from beside a world file, and this world has none', field='map'
        )
    if content.get('format') != FORMAT or isinstance(content['format'], bool):
        raise BadProperty('format must be {format}', field='format', format=FORMAT)
    changes = {key: content[key] for key in SETTINGS if key in content}
    changes |= {key: None for key in ('bounds', 'datum') if changes.get(key) == []}
    own = {
        name: each.default for name, each in WorldSettings.FIELDS.items() if OF_WORLD in each.notes
    }
    settings = replace(settings, **(own | changes))
    lesson = _lesson(content['lesson']) if 'lesson' in content else None
    entries = entries_of(content.get('bodies'), 'bodies')
    bodies, unmoved, parts = _body_states(entries, settings, physics_rate)
    check_namespaces(state.body for state in bodies)
    unjoined = WorldState(
        settings=settings, bodies=bodies, lesson=lesson, physics_rate=physics_rate
    )
    # One edited body, and the impulses of all contacts are outdated.
    if 'memory' in content and all(state.motion is not None for state in bodies):
        unjoined = replace(unjoined, memory=cache_from(content['memory'], unjoined))
    entries = [*entries_of(content.get('joints'), 'joints'), *parts]
    if not entries:
        return unjoined
    joints = joints_from(unjoined, entries, unmoved, physics_rate)
    return replace(unjoined, joints=joints, commands=commands_from(entries, joints, physics_rate))


def _lesson(value: object) -> Lesson:
    try:
        return Lesson.from_value(value, 'lesson')
    except BadProperty as refusal:
        if isinstance(value, dict) and refusal.field not in value:
            # Of what is missing, the line is that of the lesson.
            raise BadProperty(refusal.text, field='lesson') from refusal
        raise


def _body_states(
    entries: list[dict[Any, Any]], settings: WorldSettings, physics_rate: float
) -> tuple[tuple[BodyState, ...], set[str], list[dict[Any, Any]]]:
    """
    Return the states of bodies.

    Robots whose parts are not among them get their parts.

    :return: states; names of the bodies whose poses are the saved ones; entries of the joints of
        robots that got their parts
    """
    check_limit('max_bodies', len(entries), settings)
    bodies: dict[str, BodyState] = {}
    unmoved: set[str] = set()
    names = (entry.get('name') for entry in entries)
    named = {canonical(name) for name in names if isinstance(name, str)}
    joints: list[dict[Any, Any]] = []
    pieces = 0
    for count, entry in enumerate(entries, 1):
        with naming(entry, 'body', count):
            state, is_unmoved = _body_state(entry, settings, physics_rate)
            if state.body.name in bodies:
                raise BadProperty('the name appears twice', field='name')
            links, of_links = _parts_of(state)
            made = {state.body.name: state}
            if named.isdisjoint(link.name for link in links):
                for link in links:
                    body, twist = new_body(link, settings, state.body.expires)
                    made[link.name] = BodyState(body=body, pose=link.pose, twist=twist)
                joints += of_links
        bodies |= made
        if is_unmoved:
            unmoved.add(state.body.name)
        # As they are read: they take longer than their text, which aliases repeat in no time.
        pieces += sum(len(each.body.shape.form.pieces) for each in made.values())
        check_limit('max_shapes', pieces, settings)
        check_limit('max_bodies', len(bodies), settings)
    for count, entry in enumerate(entries, 1):
        state = bodies[canonical(entry['name'])]
        # Of a saved world, the body that an actor waits for may have been deleted.
        if state.acting is None:
            with naming(entry, 'body', count):
                check_start(state.body, bodies)
    return tuple(bodies.values()), unmoved, joints


def _parts_of(state: BodyState) -> tuple[list[Spawn], list[dict[Any, Any]]]:
    """Return the requests for the links of a robot, and the entries of its joints."""
    body = state.body
    if body.robot is None or not body.robot.links:
        return [], []
    properties = Properties(robot=body.robot)
    links, joints = parts_of(
        Spawn(
            name=body.name,
            shape=body.shape,
            pose=state.pose,
            color=body.color,
            properties=properties,
        )
    )
    return links, [
        {
            'name': join.name,
            'kind': str(join.kind),
            'a': join.a,
            'b': join.b,
            'points': [list(point) for point in join.points],
            **join.properties.explicit(),
        }
        for join in joints
    ]


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
    expires = steps_covering(spawn.lifetime, physics_rate) if spawn.lifetime > 0 else None
    body, twist = new_body(spawn, settings, expires)
    state = BodyState(body=body, pose=spawn.pose, twist=twist)
    state = with_saved_state(state, entry, physics_rate)
    if not saved:
        return state, False
    resumed = with_saved_motion(state, entry, _pose(entry), settings.gravity, physics_rate)
    if resumed is not None:
        return resumed, True
    spawn = spawn_from(entry)
    _, twist = new_body(spawn, settings, expires)
    state = replace(state, pose=spawn.pose, twist=twist)
    return state, is_where_saved(state, entry)


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
        shape=shape_in(entry, 'a body', SHAPES),
        pose=_pose(entry),
        color=color_value(entry['color'], 'color') if 'color' in entry else None,
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


def _pose(entry: Mapping[Any, Any]) -> Pose:
    at = entry.get('at', [0.0, 0.0])
    if not isinstance(at, list) or len(at) not in (2, 3):
        raise BadProperty('{field} must be [x, y] or [x, y, yaw]', field='at')
    return (*pair(at[:2], 'at'), number(at[2], 'at') if len(at) == 3 else 0.0)
