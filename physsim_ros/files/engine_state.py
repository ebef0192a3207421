# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The exact state of a body in a world file: `motion`, `field_lead`, `wrench`, `driven`, `acting`.

Laws: numbers are loaded as they were saved, to the bit. The motion, the engine's own numbers,
counts while pose and velocity in the file are as they were saved. An entry that the node cannot
have written is refused.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
import itertools
from typing import Annotated, Any, TypeVar

import numpy as np
from physsim_ros.engine.core import sub_step_of
from physsim_ros.engine.saved_state import engine_motion, engine_pose
from physsim_ros.files.world_schema import MOST_COMING, ROUNDING
from physsim_ros.model.body_description import check_command
from physsim_ros.model.checkpoint import BodyState, Motion
from physsim_ros.model.checks import ListOf, LONGEST, LOST, number, Numbers, pair, Whole, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.requests import Command
from physsim_ros.model.robots import Robot
from physsim_ros.model.states import (
    ActorState,
    Covariance,
    DriveCommand,
    NEVER,
    RobotState,
    SPAWNED,
    WAITING,
)
from physsim_ros.model.transform import NO_WRENCH, ORIGIN, Point, Pose
from physsim_ros.simulation.world import steps_covering

# The state of a robot lies in the range of a motion; squares and products of such numbers.
_POSE = Numbers((Within(-LOST, LOST),) * 3)
_PRODUCTS = Numbers((Within(-(LOST**2), LOST**2),) * len(SPAWNED.covariance))
# Greatest number of points that an actor has reached, and of steps that a wrench acts.
_MOST_REACHED, _MOST_STEPS = 2**53, 10**14


def _covariance(value: object, name: str) -> Covariance:
    xx, xy, yy, x_yaw, y_yaw, yaw_yaw = _PRODUCTS(value, name)
    if min(xx, yy, yaw_yaw) < 0.0:
        raise BadProperty('a variance is not negative', field=name)
    return xx, xy, yy, x_yaw, y_yaw, yaw_yaw


@dataclass(frozen=True, slots=True, kw_only=True)
class _Wrench(Checked):
    """The wrench on a body; `Command` has its range."""

    force: Annotated[Point, pair, 'at the centre of mass [N]']
    torque: Annotated[float, number, '[N m]']
    seconds: Annotated[float | None, Within(0.0, LONGEST, 's'), 'until its end'] = None
    steps: Annotated[int | None, Whole(0, _MOST_STEPS), 'until its end, in earlier versions'] = (
        None
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Coming(Checked):
    """A command that a drive does not obey yet, as of `DriveCommand`."""

    begins: Annotated[float, Within(0.0, LONGEST, 's'), 'until the drive obeys it']
    aim: Annotated[Pose, _POSE, 'commanded velocity'] = ORIGIN
    # Its way to the drive, and then the time for which it counts.
    seconds: Annotated[float | None, Within(0.0, 2.0 * LONGEST, 's'), 'until it ends'] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Driven(Checked):
    """The state of a robot, as of `RobotState`."""

    aim: Annotated[Pose, _POSE, 'commanded velocity'] = ORIGIN
    wheels: Annotated[Pose, _POSE, 'velocity of the wheels'] = ORIGIN
    travel: Annotated[Pose, _POSE, 'travel of the wheels'] = ORIGIN
    odometry: Annotated[Pose, _POSE, 'pose by odometry'] = ORIGIN
    covariance: Annotated[Covariance, _covariance, 'of that pose'] = SPAWNED.covariance
    drawn: Annotated[float, Within(-LOST, LOST, 'A s'), 'from its battery'] = 0.0
    seconds: Annotated[float | None, Within(0.0, LONGEST, 's'), 'until the command ends'] = None
    coming: Annotated[
        tuple[_Coming, ...],
        ListOf(lambda value, name: _saved(_Coming, value, name), 'mappings', MOST_COMING),
        'commands on their way',
    ] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class _Acting(Checked):
    """The state of an actor, as of `ActorState`."""

    seconds: Annotated[float | None, Within(-LONGEST, LONGEST, 's'), 'since it started'] = None
    reached: Annotated[int, Whole(0, _MOST_REACHED), 'number of points'] = 0


_Saved = TypeVar('_Saved', bound=Checked)


def _saved(kind: type[_Saved], value: object, name: str) -> _Saved:
    """Return the value of an entry; null is as good as a key that is left out."""
    if isinstance(value, dict):
        value = {key: each for key, each in value.items() if each is not None}
    return kind.from_value(value, name)


def state_entry(state: BodyState, physics_rate: float) -> dict[str, object]:
    """Return the entries of a body that the node alone writes."""
    entry: dict[str, object] = {}
    if state.wrench != NO_WRENCH:
        steps = state.wrench_steps
        entry['wrench'] = {
            'force': list(state.wrench[:2]),
            'torque': state.wrench[2],
            'seconds': None if steps is None else steps / physics_rate,
        }
    if state.driven is not None:
        driven = state.driven._asdict()
        until, drawn = driven.pop('until'), driven.pop('drawn')
        entry['driven'] = {
            **{key: list(each) for key, each in driven.items()},
            **({'drawn': drawn} if drawn else {}),
            'seconds': _seconds_to(until, physics_rate),
            **_coming_entry(state.coming, physics_rate),
        }
    if state.acting is not None:
        begun, reached = state.acting
        seconds = None if begun == NEVER else -begun / physics_rate
        entry['acting'] = {'seconds': seconds, 'reached': reached}
    if state.motion is not None:
        entry['motion'] = [*state.motion[:6], state.motion.free]
    if state.field_lead is not None:
        entry['field_lead'] = list(state.field_lead)
    return entry


def _seconds_to(step: int, physics_rate: float) -> float | None:
    """Return the time up to the end of a command [s]; None where it has none."""
    return None if step == NEVER else step / physics_rate


def _step_in(seconds: float | None, physics_rate: float) -> int:
    """Return the step at which a command ends after a time [s]; None is never."""
    return NEVER if seconds is None else round(seconds * physics_rate)


def _coming_entry(coming: tuple[DriveCommand, ...], physics_rate: float) -> dict[str, object]:
    """Return the key of the commands that a drive does not obey yet; nothing where none is."""
    commands = [
        {
            'begins': begun / physics_rate,
            'aim': list(aim),
            'seconds': _seconds_to(until, physics_rate),
        }
        for begun, aim, until in coming
    ]
    return {'coming': commands} if commands else {}


def _coming(
    robot: Robot, commands: tuple[_Coming, ...], physics_rate: float
) -> tuple[DriveCommand, ...]:
    """
    Return the commands that the drive of a robot does not obey yet.

    :raises BadProperty: it has no drive, or they are out of order
    """
    coming = tuple(
        DriveCommand(
            round(each.begins * physics_rate), each.aim, _step_in(each.seconds, physics_rate)
        )
        for each in commands
    )
    if coming and robot.drive is None:
        raise BadProperty('commands are on their way to no drive', field='driven')
    if any(b.begun < a.begun for a, b in itertools.pairwise(coming)):
        raise BadProperty('commands on their way begin one after another', field='driven')
    return coming


def with_saved_state(state: BodyState, entry: Mapping[Any, Any], physics_rate: float) -> BodyState:
    """
    Return a body with the wrench of its entry, and the state of its robot or actor.

    :param entry: the body in the file
    :param physics_rate: of the world [Hz]
    :raises Refusal: the body has no such role, or a value is not what `state_entry` has returned
    """
    body = state.body
    if 'wrench' in entry:
        wrench = _saved(_Wrench, entry['wrench'], 'wrench')
        fx, fy, torque = *wrench.force, wrench.torque
        check_command(body, Command(names=(body.name,), wrenches=np.array(((fx, fy, torque),))))
        # Files of earlier versions have steps, of the rate at which they were saved. A wrench that
        # ends at the step at which it was saved acts no more.
        steps = wrench.steps
        if wrench.seconds is not None:
            steps = steps_covering(wrench.seconds, physics_rate) if wrench.seconds > 0.0 else 0
        if (fx, fy, torque) != NO_WRENCH:
            state = replace(state, wrench=(fx, fy, torque), wrench_steps=steps)
    if 'driven' in entry:
        driven = _saved(_Driven, entry['driven'], 'driven')
        if body.robot is None:
            raise BadProperty(
                '{body} is not a robot; nothing has driven it', field='driven', body=body.name
            )
        kept = {key: getattr(driven, key) for key in RobotState._fields if key != 'until'}
        until = _step_in(driven.seconds, physics_rate)
        state = replace(
            state,
            driven=RobotState(until=until, **kept),
            coming=_coming(body.robot, driven.coming, physics_rate),
        )
    if 'acting' in entry:
        acting = _saved(_Acting, entry['acting'], 'acting')
        if body.actor is None:
            raise BadProperty('{body} is not an actor', field='acting', body=body.name)
        seconds = acting.seconds
        begun = WAITING.begun if seconds is None else -round(seconds * physics_rate)
        state = replace(state, acting=ActorState(begun, acting.reached))
    return state


def with_saved_motion(
    state: BodyState,
    entry: Mapping[Any, Any],
    pose: Pose,
    gravity: Point,
    physics_rate: float,
) -> BodyState | None:
    """
    Return a body with the pose, twist and motion of its entry.

    :param entry: the body in the file
    :param pose: of that entry
    :param gravity: of the world [m/s²]
    :param physics_rate: of the world [Hz]
    :return: None where pose or velocity were edited since
    :raises Refusal: the motion is not what `state_entry` has returned
    """
    motion = _motion(entry['motion'])
    velocity = pair(entry.get('velocity', [0.0, 0.0]), 'velocity')
    twist = (*velocity, number(entry.get('spin', 0.0), 'spin'))
    if state.body.anchored and any(twist):
        return None
    field_lead = _POSE(entry['field_lead'], 'field_lead') if 'field_lead' in entry else None
    state = replace(state, pose=pose, twist=twist, motion=motion, field_lead=field_lead)
    if not _is_motion(motion, engine_motion(state, gravity, sub_step_of(physics_rate))[:6]):
        return None
    if max(map(abs, motion[:6])) > LOST:
        raise BadProperty('motion is out of range', field='motion')
    return state


def is_where_saved(state: BodyState, entry: Mapping[Any, Any]) -> bool:
    """Return whether a body is at the pose of the motion of its entry."""
    return _is_motion(_motion(entry['motion']), engine_pose(state))


def _motion(values: object) -> Motion:
    if not isinstance(values, list) or len(values) != 7 or not isinstance(values[6], bool):
        raise BadProperty('motion must be six numbers and true or false', field='motion')
    x, y, yaw, vx, vy, spin = (number(each, 'motion') for each in values[:6])
    return Motion(x, y, yaw, vx, vy, spin, values[6])


def _is_motion(motion: Motion, written: tuple[float, ...]) -> bool:
    """Tell whether numbers are those of a motion; `is_same` takes ten times as long for so few."""
    return all(
        abs(one - other) <= ROUNDING + ROUNDING * abs(other)
        for one, other in zip(motion, written, strict=False)
    )
