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
The state of a world from a mapping, as YAML gives it.

Laws: bodies and joints go through a world of their own, so that a file is held to what a message
is; the numbers that only the node writes are taken where nobody has edited what they belong to.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
import math
from typing import Any

import numpy as np
from physsim_ros.engine.body import REST
from physsim_ros.engine.space import LOST
from physsim_ros.files.base64_array import unpack
from physsim_ros.files.world_schema import FORMAT, MEMORY, PARAMETERS, PROPERTIES, SETTINGS
from physsim_ros.model.body_properties import properties_from
from physsim_ros.model.checkpoint import BodyState, ContactMemory, Motion, WorldState
from physsim_ros.model.checks import check_key, number, pair, shown, Within
from physsim_ros.model.colors import Color, color_from
from physsim_ros.model.errors import BadProperty, BadWorldFile, Refusal, UnknownProperty
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import check_name, WORLD
from physsim_ros.model.requests import Command, join_from, joined_from, LONGEST, Restore, Spawn
from physsim_ros.model.scene import Joint, Seat
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, Shape, Triangles
from physsim_ros.model.transform import Point, Pose, rotated
from physsim_ros.simulation.joint_requests import drawn_points
from physsim_ros.simulation.world import steps_in, World

_SHAPES = ('circle', 'box', 'polygon', 'chain', 'triangles', 'compound')
_BODY_KEYS = ['name', *_SHAPES, 'at', 'color', 'lifetime', *PROPERTIES, 'motion', 'wrench']
# Of a joint, what is not the node's own `text` of markers.
_JOINT_KEYS = ('name', 'points', 'seat')
_MOTION = ('at', 'velocity', 'spin')
# Shapes that `bounds` is made of.
_WALLS = 4
# Saved numbers and the engine's own may differ by rounding; more, and somebody edited the file.
_ROUNDING = 1e-9


def state_from(
    content: Mapping[Any, Any], settings: WorldSettings, physics_rate: float
) -> WorldState:
    """
    Return the world that a file holds.

    :param content: of the file
    :param settings: what holds where the file says nothing
    :param physics_rate: of the world that will go on from it [Hz]
    :raises Refusal: a key or a value in it; of a body or a joint, `bad_world_file` with its name
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
    # Bodies go through a world of their own, so that a file is held to what a message is.
    world = World(physics_rate=physics_rate, settings=replace(settings, **changes))
    entries = _spawned(world, _entries(content.get('bodies'), 'bodies'))
    resumed: dict[str, BodyState] = {}
    unmoved: set[str] = set()
    for state in world.save().bodies:
        entry = entries[state.body.name]
        if 'motion' in entry:
            with _naming(state.body.name):
                going_on = _resumed(state, entry)
                if going_on is not None:
                    resumed[state.body.name] = going_on
                else:
                    world.apply(_spawn(entry))
                if going_on is not None or _is_unmoved(state, entry):
                    unmoved.add(state.body.name)
    saved = world.save()
    bodies = [resumed.get(state.body.name, state) for state in saved.bodies]
    # Where somebody has edited a body, nothing is what was remembered.
    intact = len(resumed) == len(bodies) and 'memory' in content
    unjoined = replace(
        saved,
        bodies=tuple(_timed(each, entries[each.body.name], physics_rate) for each in bodies),
        memory=_memory(content['memory'], saved) if intact else None,
    )
    joints = _entries(content.get('joints'), 'joints')
    if not joints:
        return unjoined
    return replace(unjoined, joints=_joined(unjoined, joints, unmoved, physics_rate))


def _spawned(world: World, entries: list[dict[Any, Any]]) -> dict[str, dict[Any, Any]]:
    """Spawn the bodies of a file, those with saved numbers at rest; return them by name."""
    named: dict[str, dict[Any, Any]] = {}
    for count, entry in enumerate(entries, 1):
        with _naming(entry.get('name'), 'body', count):
            # What goes on from saved numbers may have come further and faster than anyone may ask.
            at_rest = {key: entry[key] for key in entry if key not in _MOTION}
            spawn = _spawn(at_rest if 'motion' in entry else entry)
            if spawn.name in named:
                raise BadProperty('the name comes twice', field='name')
            world.apply(spawn)
            if 'wrench' in entry:
                world.apply(_wrench(spawn.name, entry['wrench']))
        named[spawn.name] = entry
    return named


def _joined(
    state: WorldState, entries: list[dict[Any, Any]], unmoved: set[str], physics_rate: float
) -> tuple[Joint, ...]:
    """
    Join the bodies of a file, in a world of their own where they are by now.

    :param unmoved: bodies that are where they were saved
    """
    world, loose = (World(physics_rate=physics_rate, settings=state.settings) for _ in range(2))
    world.apply(Restore(state=state))
    # A joint may have been made before both its bodies were anchored.
    bodies = tuple(
        replace(
            each, body=replace(each.body, anchored=False, kinematic=False), motion=None, twist=REST
        )
        for each in state.bodies
    )
    loose.apply(Restore(state=replace(state, bodies=bodies, memory=None)))
    poses = {saved.body.name: saved.pose for saved in state.bodies}
    # Of each, what was saved; None where it is to be made.
    joints: dict[str, Joint | None] = {}
    for count, entry in enumerate(entries, 1):
        with _naming(entry.get('name'), 'joint', count):
            name = entry.get('name')
            if not isinstance(name, str):
                raise BadProperty('a joint needs a name', field='name')
            if name in joints:
                raise BadProperty('the name comes twice', field='name')
            said = {key: entry[key] for key in entry if key not in _JOINT_KEYS}
            points = _points(entry.get('points'), 'points')
            joints[name] = None
            if 'seat' in entry:
                joint = _saved_joint(name, said, _seat(entry['seat']))
                if _is_whole(joint, points, poses, unmoved):
                    joints[name] = joint
                    continue
            join = join_from(said, name=name, points=points)
            if 'seat' not in entry:
                world.apply(join)
            loose.apply(join)
    made = {joint.name: joint for joint in loose.save().joints}
    return tuple(joint or made[name] for name, joint in joints.items())


def _saved_joint(name: str, said: Mapping[Any, Any], seat: Seat) -> Joint:
    """Return a joint as it was saved: where it may have come, nobody could draw it."""
    check_name(name)
    kind, a, b, properties = joined_from(said)
    properties.check_kind(kind)
    return Joint(name=name, kind=kind, a=a, b=b, seat=seat, properties=properties)


def _is_whole(
    joint: Joint, points: tuple[Point, ...], poses: Mapping[str, Pose], unmoved: set[str]
) -> bool:
    """Tell whether nobody has edited where a saved joint sits, nor moved a body of it."""
    seat, phase = joint.seat, joint.properties.phase
    # The background is the only one that `unmoved` does not name.
    if joint.a not in unmoved or joint.b not in unmoved | {WORLD} or joint.a == joint.b:
        return False
    if joint.kind is JointKind.SLIDER and abs(math.hypot(seat.ux, seat.uy) - 1.0) > _ROUNDING:
        return False
    if phase is not None:
        off = abs(math.remainder(seat.phase - phase, math.tau))
        if off > _ROUNDING + 4.0 * math.ulp(seat.phase):
            return False
    return joint.kind.points == len(points) and _is_same(drawn_points(joint, poses), points)


def _seat(value: object) -> Seat:
    count = len(Seat._fields)
    if not isinstance(value, list) or len(value) != count:
        raise BadProperty(f'seat must be {count} numbers', field='seat')
    return Seat(*(Within(-LOST, LOST)(each, 'seat') for each in value))


@contextmanager
def _naming(name: object, what: str = 'body', count: int = 0) -> Iterator[None]:
    """
    Say of which body or joint a refusal is.

    :param count: of it in the file, from 1, which tells what has no name
    """
    try:
        yield
    except Refusal as refusal:
        which = f'number {count}' if name is None else shown(name)
        raise BadWorldFile(f'{what} {which}: {refusal}', field=refusal.field) from refusal


def _entries(value: object, what: str) -> list[dict[Any, Any]]:
    if value is None:
        return []
    if not isinstance(value, list) or not all(isinstance(each, dict) for each in value):
        raise BadProperty(f'{what} must be a list of mappings', field=what)
    return value


def _spawn(entry: dict[Any, Any]) -> Spawn:
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


def _pose(entry: Mapping[Any, Any]) -> Pose:
    at = entry.get('at', [0.0, 0.0])
    if not isinstance(at, list) or len(at) not in (2, 3):
        raise BadProperty('at must be [x, y] or [x, y, yaw]', field='at')
    return (*pair(at[:2], 'at'), number(at[2], 'at') if len(at) == 3 else 0.0)


def _wrench(name: str, value: object) -> Command:
    wrench = _mapping(value, 'wrench', ['force', 'torque', 'seconds', 'steps'])
    force, torque = pair(wrench.get('force'), 'force'), number(wrench.get('torque'), 'torque')
    return Command(names=(name,), wrenches=((*force, torque),))


def _shape(entry: Mapping[Any, Any]) -> Shape:
    named = [key for key in _SHAPES if key in entry]
    if len(named) != 1:
        raise BadProperty(f'a body has one of {", ".join(_SHAPES)}', field='shape')
    kind, value = named[0], entry[named[0]]
    match kind:
        case 'polygon':
            return Polygon(outline=_points(value, kind))
        case 'triangles':
            return Triangles(vertices=_points(value, kind))
        case 'chain':
            known = _mapping(value, kind, ['points', 'thickness'])
            thickness = number(known.get('thickness'), 'thickness')
            return Chain(points=_points(known.get('points'), 'points'), thickness=thickness)
        case 'compound':
            known = _mapping(value, kind, ['circle', 'box', 'centers'])
            element = _shape({key: known[key] for key in ('circle', 'box') if key in known})
            if not isinstance(element, Disc | Box):
                raise BadProperty('a compound is made of a circle or a box', field=kind)
            return Compound(element=element, centers=_points(known.get('centers'), 'centers'))
        case 'circle':
            known = _mapping(value, kind, ['radius'])
            return Disc(radius=number(known.get('radius'), 'radius'))
        case _:
            known = _mapping(value, kind, ['width', 'height'])
            width, height = (number(known.get(side), side) for side in ('width', 'height'))
            return Box(width=width, height=height)


def _mapping(value: object, name: str, known: list[str]) -> dict[Any, Any]:
    if not isinstance(value, dict):
        raise BadProperty(f'{name} must be a mapping', field=name)
    for key in value:
        check_key(key, known)
    return value


def _points(value: object, name: str) -> tuple[tuple[float, float], ...]:
    if not isinstance(value, list):
        raise BadProperty(f'{name} must be a list of points', field=name)
    return tuple(pair(point, name) for point in value)


def _color(value: object) -> Color:
    if isinstance(value, str):
        return color_from(value)
    if not isinstance(value, list) or len(value) != 4:
        raise BadProperty('color must be a string or [r, g, b, a]', field='color')
    red, green, blue, alpha = (number(each, 'color') for each in value)
    return red, green, blue, alpha


def _resumed(state: BodyState, entry: Mapping[Any, Any]) -> BodyState | None:
    """
    Return a body that goes on from the numbers that only the node writes.

    :param state: the body at the origin, at rest
    :param entry: the body in the file
    :return: None where somebody has edited the pose or the velocity since
    """
    saved, pose = _motion(entry), _pose(entry)
    velocity = pair(entry.get('velocity', [0.0, 0.0]), 'velocity')
    twist = (*velocity, number(entry.get('spin', 0.0), 'spin'))
    assert state.motion is not None  # noqa: S101 - a world's own state
    lead = state.motion[3:6] if saved.free else (0.0, 0.0, 0.0)
    if state.body.anchored and any(twist):
        return None
    if not _is_same(saved[:6], (*_engine_pose(state, pose), *np.add(twist, lead))):
        return None
    if np.abs(saved[:6]).max() > LOST:
        raise BadProperty('motion is out of range', field='motion')
    return replace(state, pose=pose, twist=twist, motion=saved)


def _motion(entry: Mapping[Any, Any]) -> Motion:
    values = entry['motion']
    if not isinstance(values, list) or len(values) != 7 or not isinstance(values[6], bool):
        raise BadProperty('motion must be six numbers and true or false', field='motion')
    x, y, yaw, vx, vy, spin = (number(each, 'motion') for each in values[:6])
    return Motion(x, y, yaw, vx, vy, spin, values[6])


def _is_unmoved(state: BodyState, entry: Mapping[Any, Any]) -> bool:
    """
    Tell whether a body is where it was saved, whatever else somebody has edited.

    :param state: the body at the origin
    """
    return _is_same(_motion(entry)[:3], _engine_pose(state, _pose(entry)))


def _engine_pose(state: BodyState, pose: Pose) -> Pose:
    """
    Return where the engine has a body with that pose.

    :param state: the body at the origin
    """
    assert state.motion is not None  # noqa: S101 - a world's own state
    x, y = rotated((state.motion.x, state.motion.y), pose[2])
    return pose[0] + x, pose[1] + y, pose[2]


def _is_same(
    saved: Sequence[float] | Sequence[Point], written: Sequence[float] | Sequence[Point]
) -> bool:
    """Tell whether numbers differ by no more than rounding."""
    return bool(np.allclose(saved, written, rtol=_ROUNDING, atol=_ROUNDING))


def _memory(value: object, state: WorldState) -> ContactMemory | None:
    """Return what the engine remembered; None where shapes have come or gone since."""
    memory = _mapping(value, 'memory', MEMORY)
    walls, following = (_count(memory.get(key), key) for key in ('walls', 'following'))
    ids = unpack(memory.get('ids'), 'ids', np.int64)
    pairs = unpack(memory.get('pairs'), 'pairs', np.int64, 2)
    hashes = unpack(memory.get('hashes'), 'hashes', np.uint64)
    impulses = unpack(memory.get('impulses'), 'impulses', np.float64, 2)
    # As large as the heaviest and fastest bodies make them.
    sound = bool(np.isfinite(impulses).all())
    if not (len(pairs) == len(hashes) == len(impulses) and sound):
        raise BadProperty('memory is not what was saved', field='memory')
    if len(ids) != len(state.bodies):
        return None
    # The shapes of a body, and the walls, have numbers in a row; no two shapes have the same.
    counts = [len(each.body.shape.form.pieces) for each in state.bodies]
    runs = [*zip(ids.tolist(), counts, strict=True), (following, 0)]
    if state.settings.bounds is not None:
        runs.append((walls, _WALLS))
    end = 0
    for first, count in sorted(runs):
        if first < end:
            return None
        end = first + count
    return ContactMemory(
        ids=ids, walls=walls, following=following, pairs=pairs, hashes=hashes, impulses=impulses
    )


def _count(value: object, name: str) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 2**62:
        raise BadProperty(f'{name} must be a whole number, not negative', field=name)
    return value


def _timed(state: BodyState, entry: Mapping[Any, Any], physics_rate: float) -> BodyState:
    """Let a wrench act for as long as the file says."""
    if 'wrench' not in entry:
        return state
    with _naming(state.body.name):
        return replace(state, wrench_steps=_wrench_steps(entry['wrench'], physics_rate))


def _wrench_steps(wrench: Mapping[Any, Any], physics_rate: float) -> int | None:
    """Return for how many steps a wrench still acts; None is for ever."""
    seconds, steps = wrench.get('seconds'), wrench.get('steps')
    if seconds is not None:
        return steps_in(Within(0.0, LONGEST, 's')(seconds, 'seconds'), physics_rate)
    # Files of before had steps, of whatever rate.
    if steps is None or _count(steps, 'steps') <= LONGEST * physics_rate:
        return steps
    raise BadProperty(f'steps are more than {LONGEST:g} s', field='steps')
