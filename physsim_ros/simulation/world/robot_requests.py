# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests for robots: they are driven; and the names of their topics and frames.

Law: no two robots have one topic or frame.
"""

from __future__ import annotations

from physsim_ros.engine.bodies import RigidBody
from physsim_ros.engine.space import Space
from physsim_ros.model.answer import Answer
from physsim_ros.model.body_description import check_namespaces
from physsim_ros.model.errors import BadProperty, UnknownBody
from physsim_ros.model.requests import DriveRobot
from physsim_ros.model.robots import Drive, Robot
from physsim_ros.model.scene import Body
from physsim_ros.model.states import DriveCommand, NEVER
from physsim_ros.model.translation import Text
from physsim_ros.simulation.world.live_space import LiveSpace

# Number of robots that a refusal names.
_MOST_NAMED = 10


def drive_robot(live: LiveSpace, request: DriveRobot) -> Answer:
    """
    Have a robot drive at a velocity.

    :raises UnknownBody: there is no such body
    :raises BadProperty: it is no robot, or has no drive
    """
    rigid, drive = drive_of_name(live.space, request.name)
    timeout = drive.timeout if request.timeout is None else request.timeout
    begun = live.begin_of_command(request.name, drive.latency, drive.command_rate)
    end = live.step_after(timeout)
    until = NEVER if end is None else end + begun - live.step_count
    command = DriveCommand(begun, drive.aim(request.velocity), until)
    live.space.commands.drive(rigid, command, live.step_count)
    return Answer(subject=request.name, message=Text('drives {body}', body=request.name))


def robot_of_name(space: Space, name: str) -> tuple[RigidBody, Robot]:
    """
    Return the body of a name, and the robot that it is.

    :raises UnknownBody: there is no such body
    :raises BadProperty: it is no robot
    """
    rigid = space.bodies.by_name.get(name)
    if rigid is not None and rigid.body.robot is not None:
        return rigid, rigid.body.robot
    robots = [each for each, found in space.bodies.by_name.items() if found.body.robot is not None]
    hint = Text('; robots: {names}', names=', '.join(robots[:_MOST_NAMED])) if robots else ''
    if rigid is None:
        raise UnknownBody('there is no robot {name!r}{hint}', field='name', name=name, hint=hint)
    raise BadProperty('{name} is not a robot{hint}', field='name', name=name, hint=hint)


def drive_of_name(space: Space, name: str) -> tuple[RigidBody, Drive]:
    """
    Return the body of a name, and the drive of the robot that it is.

    :raises UnknownBody: there is no such body
    :raises BadProperty: it is no robot, or has no drive
    """
    rigid, robot = robot_of_name(space, name)
    if robot.drive is None:
        raise BadProperty('{name} has no drive', field='name', name=name)
    return rigid, robot.drive


def is_driving(live: LiveSpace, request: DriveRobot, steps: int) -> bool:
    """
    Return whether a robot does what a command says for some steps.

    :param steps: from now on
    :raises UnknownBody: there is no such body
    :raises BadProperty: it is no robot, or has no drive
    """
    rigid, drive = drive_of_name(live.space, request.name)
    aim, until = live.space.commands.drive_of(rigid)
    if aim != drive.aim(request.velocity):
        return False
    # One that stands still does so after its timeout, too.
    return not any(aim) or until >= live.step_count + steps


def check_robot(space: Space, body: Body) -> None:
    """
    Refuse a robot that has a topic or frame of another one.

    :raises Exists: its namespace or another of its names is taken
    """
    if body.robot is None:
        return
    # Only of robots below one another, or of one namespace, can names be the same.
    below, related = _prefix_of(body.robot, body.name), [body]
    for name, rigid in space.bodies.by_name.items():
        if (robot := rigid.body.robot) is not None:
            prefix = _prefix_of(robot, name)
            if prefix.startswith(below) or below.startswith(prefix):
                related.append(rigid.body)
    check_namespaces(related)


def _prefix_of(robot: Robot, body: str) -> str:
    """Return the prefix of the names of topics and frames of a robot."""
    namespace = robot.namespace_of(body)
    return f'{namespace}/' if namespace else ''
