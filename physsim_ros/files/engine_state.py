# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
What the node alone writes of a body and of a world: states of robots and actors, impulses.

A robot has its state under the key `driven` of its body, an actor under `acting`, a world the
impulses of its contacts under `memory`.

Law: impulses are loaded as they were saved, to the bit, from arrays as compressed base64 text.
They are not loaded where shapes have been added or removed since, and refused where a text is not
that of an array.
"""

from __future__ import annotations

import base64
import binascii
from dataclasses import fields
from typing import Any
import zlib

import numpy as np
from numpy.typing import DTypeLike, NDArray
from physsim_ros.engine.boundary import wall_count
from physsim_ros.files.world_schema import count_from
from physsim_ros.model.actors import ActorState, WAITING
from physsim_ros.model.checkpoint import ImpulseCache, WorldState
from physsim_ros.model.checks import check_finite, LONGEST, number, pair, shown, Whole, Within
from physsim_ros.model.declarations import known_mapping
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.robot_states import Covariance, NEVER, RobotState, SPAWNED
from physsim_ros.model.robots import Robot
from physsim_ros.model.scene import Body, Scene
from physsim_ros.model.transform import Pose

_POSES = ('aim', 'wheels', 'travel', 'odometry')
# Greatest number in them, as of a motion [m, rad, m/s, rad/s].
_GREATEST = 1e12
_MOST_REACHED = 2**53
_LENGTH = Within(0.0, _GREATEST)
# Squares and products of them.
_VARIANCE = Within(-(_GREATEST**2), _GREATEST**2)


def driven_entry(driven: RobotState, physics_rate: float) -> dict[str, object]:
    """Return the entry of the state of a robot."""
    entry: dict[str, object] = {key: list(getattr(driven, key)) for key in _POSES}
    seconds = None if driven.until == NEVER else driven.until / physics_rate
    return {**entry, 'covariance': list(driven.covariance), 'seconds': seconds}


def driven_from(entry: object, body: Body, physics_rate: float) -> RobotState:
    """
    Return the state of a robot from its entry.

    :param body: of the robot
    :param physics_rate: of the world [Hz]
    :raises Refusal: the body is no robot, or the entry is not what `driven_entry` has returned
    """
    values = known_mapping(entry, 'driven', [*_POSES, 'covariance', 'path', 'seconds'])
    if body.robot is None:
        raise BadProperty(f'{body.name} is not a robot; nothing has driven it', field='driven')
    seconds = values.get('seconds')
    until = NEVER
    if seconds is not None:
        until = round(Within(0.0, LONGEST, 's')(seconds, 'seconds') * physics_rate)
    poses = [_three(values.get(key, [0.0, 0.0, 0.0]), key) for key in _POSES]
    aim, wheels, travel, odometry = poses
    if 'covariance' in values:
        covariance = _covariance(values['covariance'])
    else:
        covariance = _covariance_of_path(values.get('path', [0.0, 0.0]), body.robot)
    return RobotState(aim, until, wheels, travel, odometry, covariance)


def acting_entry(acting: ActorState, physics_rate: float) -> dict[str, object]:
    """Return the entry of the state of an actor: for how long it has moved [s], points reached."""
    seconds = None if acting.begun == NEVER else -acting.begun / physics_rate
    return {'seconds': seconds, 'reached': acting.reached}


def acting_from(entry: object, body: Body, physics_rate: float) -> ActorState:
    """
    Return the state of an actor from its entry.

    :param body: of the actor
    :param physics_rate: of the world [Hz]
    :raises Refusal: the body is no actor, or the entry is not what `acting_entry` has returned
    """
    values = known_mapping(entry, 'acting', ['seconds', 'reached'])
    if body.actor is None:
        raise BadProperty(f'{body.name} is not an actor', field='acting')
    reached = Whole(0, _MOST_REACHED)(values.get('reached', 0), 'reached')
    seconds = values.get('seconds')
    if seconds is None:
        return WAITING._replace(reached=reached)
    moved = Within(-LONGEST, LONGEST, 's')(seconds, 'seconds')
    return ActorState(-round(moved * physics_rate), reached)


def _covariance(value: object) -> Covariance:
    if not isinstance(value, list) or len(value) != len(SPAWNED.covariance):
        raise BadProperty(
            f'covariance must be a list of six numbers, not {shown(value)}', field='covariance'
        )
    xx, xy, yy, x_yaw, y_yaw, yaw_yaw = (_VARIANCE(each, 'covariance') for each in value)
    if min(xx, yy, yaw_yaw) < 0.0:
        raise BadProperty('a variance is not negative', field='covariance')
    return xx, xy, yy, x_yaw, y_yaw, yaw_yaw


def _covariance_of_path(value: object, robot: Robot) -> Covariance:
    """Return the covariance by the way and the turns in a file that has no covariance."""
    way, turned = (_LENGTH(each, 'path') for each in pair(value, 'path'))
    ahead, heading = (deviation**2 for deviation in robot.odometry.slip)
    return ahead * way, 0.0, ahead * way, 0.0, 0.0, heading * (way + turned)


def _three(value: object, name: str) -> Pose:
    if not isinstance(value, list):
        raise BadProperty(
            f'{name} must be a list of three numbers, not {shown(value)}', field=name
        )
    numbers = tuple(number(each, name) for each in value)
    check_finite(numbers, 3, name)
    if max(map(abs, numbers)) > _GREATEST:
        raise BadProperty(f'{name} is out of range', field=name)
    x, y, turn = numbers
    return x, y, turn


# Greatest size of an array [bytes], far more than any world needs: a few lines of compressed text
# can expand to all the memory.
MOST_BYTES = 64 * 2**20
_KEYS = [each.name for each in fields(ImpulseCache)]


def cache_entry(cache: ImpulseCache) -> dict[str, object]:
    """Return the entry of an impulse cache: numbers, and packed arrays."""
    values = {key: getattr(cache, key) for key in _KEYS}
    for key in ('totals', 'pushes'):
        if not len(values[key]):
            del values[key]
    return {
        key: pack(value) if isinstance(value, np.ndarray) else value
        for key, value in values.items()
    }


def cache_from(entry: object, state: WorldState) -> ImpulseCache | None:
    """
    Return the impulse cache of an entry; None if it does not fit the bodies.

    :param state: the bodies and settings of the file
    :raises Refusal: the entry is not what `cache_entry` has returned
    """
    values = known_mapping(entry, 'memory', _KEYS)
    walls, following = (count_from(values.get(key), key) for key in ('walls', 'following'))
    ids = unpack(values.get('ids'), 'ids', np.int64)
    pairs = unpack(values.get('pairs'), 'pairs', np.int64, 2)
    hashes = unpack(values.get('hashes'), 'hashes', np.uint64)
    impulses = unpack(values.get('impulses'), 'impulses', np.float64, 2)
    joints = unpack(values.get('joints'), 'joints', np.float64, 2)
    # Older files have none of these.
    totals, pushes = (
        unpack(values[key], key, np.float64, width) if key in values else np.empty((0, width))
        for key, width in (('totals', 2), ('pushes', 3))
    )
    # No other bound: the heaviest and fastest bodies make impulses of any size.
    sound = all(bool(np.isfinite(each).all()) for each in (impulses, joints, totals, pushes))
    if not (len(pairs) == len(hashes) == len(impulses) and sound):
        raise BadProperty('memory is not what was saved', field='memory')
    scene = Scene(bodies=tuple(each.body for each in state.bodies), settings=state.settings)
    on_floor = np.count_nonzero(scene.floor_friction)
    if len(ids) != len(state.bodies) or len(pushes) not in (0, on_floor):
        return None
    # The shapes of a body, and the walls, have consecutive numbers; each number occurs once.
    counts = [len(each.body.shape.form.pieces) for each in state.bodies]
    runs = [*zip(ids.tolist(), counts, strict=True), (following, 0)]
    if state.settings.bounds is not None:
        runs.append((walls, wall_count(state.settings)))
    end = 0
    for first, count in sorted(runs):
        if first < end:
            return None
        end = first + count
    return ImpulseCache(
        ids=ids,
        walls=walls,
        following=following,
        pairs=pairs,
        hashes=hashes,
        impulses=impulses,
        joints=joints,
        totals=totals,
        pushes=pushes,
    )


def pack(array: NDArray[Any]) -> str:
    """Return the numbers of an array as text, little-endian, without type and shape."""
    little = array.astype(array.dtype.newbyteorder('<'))
    return base64.b64encode(zlib.compress(little.tobytes())).decode()


def unpack(text: object, name: str, dtype: DTypeLike, width: int = 1) -> NDArray[Any]:
    """
    Return the (n,) or (n, width) array of a text.

    :param name: of the field, for the refusal
    :param dtype: of the numbers
    :param width: numbers in a row
    :raises BadProperty: the text is not that of such an array
    """
    kind = np.dtype(dtype)
    if not isinstance(text, str):
        raise BadProperty(f'{name} is not what was saved: it is not text', field=name)
    try:
        packed = base64.b64decode(text.encode('ascii'), validate=True)
        inflater = zlib.decompressobj()
        data = inflater.decompress(packed, MOST_BYTES)
        array = np.frombuffer(data, dtype=kind.newbyteorder('<')).astype(kind)
        array = array if width == 1 else array.reshape(-1, width)
    except (ValueError, binascii.Error, zlib.error) as error:
        raise BadProperty(f'{name} is not what was saved: {error}', field=name) from error
    if not inflater.eof:
        raise BadProperty(f'{name} is not what was saved: it has no end', field=name)
    return array
