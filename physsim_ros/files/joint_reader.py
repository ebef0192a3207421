# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The joints of a world file.

Laws: joints are made by requests to a world, so that files obey the rules of messages. A saved
seat is kept to the bit where nobody has edited the joint or moved its bodies.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
import itertools
import math
from typing import Annotated, Any

from physsim_ros.files.world_schema import (
    is_same,
    MOST_COMING,
    naming,
    OWN_JOINT_KEYS,
    ROUNDING,
)
from physsim_ros.model.checkpoint import TimedCommands, WorldState
from physsim_ros.model.checks import ListOf, LONGEST, LOST, point_list, text, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.joints import joined_from, MOST_RATIO
from physsim_ros.model.motor_command import CommandPoint, MotorCommand, points_from, TimedCommand
from physsim_ros.model.names import check_name, WORLD
from physsim_ros.model.requests import join_from, Restore
from physsim_ros.model.scene import Guide, Joint, Seat
from physsim_ros.model.spelling import canonical
from physsim_ros.model.transform import Point, Pose, REST
from physsim_ros.simulation.world import World

# Range of the numbers of a seat: the yaw of a body that is not lost, times the ratio of a gear,
# less that of another one.
_IN_SEAT = Within(-(MOST_RATIO + 1.0) * LOST, (MOST_RATIO + 1.0) * LOST)


def joints_from(
    state: WorldState, entries: list[dict[Any, Any]], unmoved: set[str], physics_rate: float
) -> tuple[Joint, ...]:
    """
    Return the joints of a file.

    :param state: the bodies and settings of the file
    :param unmoved: names of the bodies that are where they were saved
    :param physics_rate: [Hz]
    :raises BadWorldFile: a joint is refused
    """
    world, dynamic = (World(physics_rate=physics_rate, settings=state.settings) for _ in range(2))
    world.apply(Restore(state=state))
    # Both bodies of a saved joint may have been anchored after it was made.
    bodies = tuple(
        replace(
            each, body=replace(each.body, anchored=False, kinematic=False), motion=None, twist=REST
        )
        for each in state.bodies
    )
    dynamic.apply(Restore(state=replace(state, bodies=bodies, memory=None)))
    poses = {saved.body.name: saved.pose for saved in state.bodies}
    # By name; None where the seat is that of the newly made joint.
    joints: dict[str, Joint | None] = {}
    for count, entry in enumerate(entries, 1):
        with naming(entry, 'joint', count):
            name = entry.get('name')
            if not isinstance(name, str):
                raise BadProperty('a joint needs a name', field='name')
            name = canonical(name)
            if name in joints:
                raise BadProperty('the name appears twice', field='name')
            terms = {key: entry[key] for key in entry if key not in OWN_JOINT_KEYS}
            points = point_list(entry.get('points'), 'points')
            joints[name] = None
            if 'seat' in entry:
                joint = _saved_joint(name, terms, entry['seat'])
                if _is_unedited(joint, points, poses, unmoved):
                    joints[name] = joint
                    continue
            join = join_from(terms, name=name, points=points)
            if 'seat' not in entry:
                world.apply(join)
            dynamic.apply(join)
    made = {joint.name: joint for joint in dynamic.save().joints}
    return tuple(joint or made[name] for name, joint in joints.items())


@dataclass(frozen=True, slots=True, kw_only=True)
class _Command(Checked):
    """The command of a motor, as of `MotorCommand`."""

    mode: Annotated[str, text, 'of the values']
    points: Annotated[tuple[CommandPoint, ...], points_from, 'of a trajectory']
    seconds: Annotated[
        float, Within(-LONGEST, LONGEST, 's'), 'since it began; below 0 of one on its way'
    ] = 0.0


_COMING = ListOf(_Command.from_value, 'mappings', MOST_COMING)


def commands_from(
    entries: list[dict[Any, Any]], joints: tuple[Joint, ...], physics_rate: float
) -> TimedCommands:
    """
    Return the commands of the motors of a file, whose steps count from now.

    :param entries: of the joints
    :param joints: of these entries
    :param physics_rate: [Hz]
    :raises BadWorldFile: a command is refused
    """
    commands = []
    for count, (entry, joint) in enumerate(zip(entries, joints, strict=True), 1):
        with naming(entry, 'joint', count):
            saved = _COMING([entry['command']] if 'command' in entry else [], 'command')
            saved += _COMING(entry.get('coming', []), 'coming')
            if saved and not joint.properties.effort:
                raise BadProperty('{joint} has no motor', field='command', joint=joint.name)
            if any(b.seconds > a.seconds for a, b in itertools.pairwise(saved)):
                raise BadProperty('commands on their way begin one after another', field='coming')
            for each in saved:
                command = MotorCommand(joint=joint.name, mode=each.mode, points=each.points)
                commands.append(TimedCommand(command, -round(each.seconds * physics_rate)))
    return tuple(commands)


def command_entries(commands: Sequence[TimedCommand], physics_rate: float) -> dict[str, object]:
    """
    Return the keys of the commands of a motor that `commands_from` makes them of.

    :param commands: in their order, whose steps count from now
    """
    entries = [_command_entry(*each, physics_rate) for each in commands]
    begun = {'command': entries.pop(0)} if commands and commands[0].begun <= 0 else {}
    return {**begun, **({'coming': entries} if entries else {})}


def _command_entry(command: MotorCommand, begun: int, physics_rate: float) -> dict[str, object]:
    points = [
        [each.time, each.value] + [each.rate] * math.isfinite(each.rate) for each in command.points
    ]
    return {'mode': command.mode, 'points': points, 'seconds': -begun / physics_rate}


def _saved_joint(name: str, terms: Mapping[Any, Any], saved: object) -> Joint:
    """Return a joint with its saved seat, which no request might be able to draw."""
    check_name(name)
    kind, a, b, properties = joined_from(terms)
    properties.check_kind(kind)
    seat, guides = _seat(saved, properties.guides)
    return Joint(name=name, kind=kind, a=a, b=b, seat=seat, properties=properties, guides=guides)


def _is_unedited(
    joint: Joint, points: tuple[Point, ...], poses: Mapping[str, Pose], unmoved: set[str]
) -> bool:
    """Return whether the points of a saved joint and the poses of its bodies are unedited."""
    seat, phase = joint.seat, joint.properties.phase
    # The background is never among the bodies.
    if joint.a == joint.b or not unmoved.issuperset({*joint.bodies} - {WORLD}) or joint.a == WORLD:
        return False
    schema = joint.kind.schema
    has_axis = schema.has_axis or schema.rolls
    if has_axis and abs(math.hypot(seat.ux, seat.uy) - 1.0) > ROUNDING:
        return False
    if phase is not None:
        difference = abs(math.remainder(seat.phase - phase, math.tau))
        if difference > ROUNDING + 4.0 * math.ulp(seat.phase):
            return False
    drawn = joint.drawn_points(poses)
    return len(drawn) == len(points) and is_same(drawn, points)


def _seat(value: object, names: tuple[str, ...]) -> tuple[Seat, tuple[Guide, ...]]:
    """
    Return the seat of a joint, and its guides.

    :param value: numbers of the seat, then those of each guide
    :param names: of the bodies of its guides
    """
    own, each = len(Seat._fields), len(Guide._fields) - 1
    count = own + each * len(names)
    if not isinstance(value, list) or len(value) != count:
        raise BadProperty('seat must be {count} numbers', field='seat', count=count)
    numbers = [_IN_SEAT(each, 'seat') for each in value]
    firsts, ends = range(own, count, each), range(own + each, count + 1, each)
    guides = zip(names, firsts, ends, strict=True)
    return Seat(*numbers[:own]), tuple(
        Guide(name, *numbers[first:end]) for name, first, end in guides
    )
