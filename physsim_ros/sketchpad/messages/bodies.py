# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Messages about bodies and joints: add, change, move, copy, delete, watch them, drive robots.

And what acts on all bodies: gravity, air.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from physsim_ros.files import spawn_from, with_shipped_robot
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checks import FASTEST, flag, HEAVIEST, pair, VELOCITY, Within
from physsim_ros.model.declarations import without_unset
from physsim_ros.model.errors import BadProperty, no_joint
from physsim_ros.model.joints import JointProperties
from physsim_ros.model.media import FLUID_DENSITY, GUSTS, VISCOSITY
from physsim_ros.model.motor_command import CommandPoint, MotorCommand
from physsim_ros.model.requests import (
    ChangeBody,
    Command,
    CommandMotors,
    Configure,
    DeleteBodies,
    DriveRobot,
    Join,
    MoveBodies,
    Spawn,
    Unjoin,
)
from physsim_ros.model.transform import Point, Pose, REST, Twist
from physsim_ros.model.translation import counted, Text
from physsim_ros.simulation.entries import Origin
from physsim_ros.sketchpad.message import message, Optional, request_of
from physsim_ros.sketchpad.messages import fields
from physsim_ros.sketchpad.page_session import PageSession
from physsim_ros.sketchpad.rights import Right


def _body(value: object, name: str) -> Spawn:
    """Return the request for a body, which is given as in a world file."""
    return spawn_from(fields.mapping(value, name))


def _changes(value: object, name: str) -> dict[str, Any]:
    """Return changed properties of a body as the fields of `ChangeBody`."""
    given, unset = without_unset(fields.mapping(value, name), Properties)
    changes: dict[str, Any] = {'unset': unset}
    if 'color' in given:
        changes['color'] = fields.color(given.pop('color'), 'color')
    if 'at' in given:
        changes['pose'] = fields.three(given.pop('at'), 'at', 'x', 'y', 'yaw')
    return changes | {'properties': Properties.from_mapping(with_shipped_robot(given, ['robot']))}


def _joint_changes(value: object, name: str) -> dict[str, Any]:
    """Return changed properties of a joint as the fields of `Join`."""
    given, unset = without_unset(fields.mapping(value, name), JointProperties)
    return {'properties': JointProperties.from_mapping(given), 'unset': unset}


def _velocity(value: object, name: str) -> Twist:
    """Return vx forward, vy to the left [m/s], turn counter-clockwise [rad/s]."""
    return fields.three(value, name, 'forward', 'left', 'turn')


def _poses(value: object, name: str) -> list[Pose]:
    if not isinstance(value, list) or not value:
        raise BadProperty('{field} must be a list of at least one pose', field=name)
    return [fields.three(each, name, 'x', 'y', 'yaw') for each in value]


def _followed(value: object, name: str) -> frozenset[str]:
    return frozenset(fields.names(value, name) if value != [] else ())


# Bodies


@message('spawn', '~/spawn', body=_body)
def spawn(page: PageSession, origin: Origin, body: Spawn) -> None:
    """Add a body."""
    page.submit(origin, (body,))


@message('change', '~/spawn', name=fields.text, properties=_changes)
def change(page: PageSession, origin: Origin, name: str, properties: dict[str, Any]) -> None:
    """Change the properties of a body that are given, its colour or its pose."""
    page.submit(origin, (ChangeBody(name=name, **properties),))


@message('move_bodies', '~/command', names=fields.names, by=fields.point)
def move_bodies(page: PageSession, origin: Origin, names: tuple[str, ...], by: Point) -> None:
    """Move bodies by a vector [m]."""
    page.submit(origin, (MoveBodies(names=names, by=by),))


@message('place', '~/command', names=fields.names, poses=_poses)
def place(page: PageSession, origin: Origin, names: tuple[str, ...], poses: list[Pose]) -> None:
    """Set the poses of several bodies, one for each name."""
    page.submit(origin, (Command(names=names, poses=np.array(poses)),))


@message('copy_machine', '~/spawn', names=fields.names, by=fields.point)
def copy_machine(page: PageSession, origin: Origin, names: tuple[str, ...], by: Point) -> None:
    """Add bodies like others, of a part the whole robot, with their joints, at a distance [m]."""
    requests = page.person.drawing.copy_machine(names, by, page.control.loop.bring_up_to_date())
    if len(requests) == 1:
        page.submit(origin, requests)
        return
    # Before several answers stands one for all.
    robots = [each.properties.robot is not None for each in requests if isinstance(each, Spawn)]
    copied = Text('a robot') if robots == [True] else counted(len(robots), 'body')
    message = Text('copied {bodies}', bodies=copied)
    page.submit(origin, requests, message=message)


@message('delete', '~/spawn', names=fields.names)
def delete(page: PageSession, origin: Origin, names: tuple[str, ...]) -> None:
    """Delete bodies."""
    page.submit(origin, (DeleteBodies(names=names),))


@message('watch', 'page', Right.LOOK, name=fields.text, forces=Optional(flag))
def watch(page: PageSession, origin: Origin, name: str, *, forces: bool = False) -> None:
    """
    Send the page the motion of a body in this course, also beyond now; '' is no body.

    :param forces: whether the forces on it are sent, too
    """
    page.shared.pasts.ask(page.number, name, request_of(origin))
    if name and forces:
        page.shared.past_contacts.ask_forces(page.number, name)


@message('follow', 'page', Right.LOOK, names=_followed)
def follow(page: PageSession, origin: Origin, names: frozenset[str]) -> None:
    """Tell the page when other bodies began to touch these, and begin to; none is no body."""
    page.shared.past_contacts.ask_touches(page.number, names)
    page.followed = names
    page.answer_page(origin, Text('following {bodies}', bodies=counted(len(names), 'body')))


@message('drive', 'cmd_vel', name=fields.text, velocity=_velocity)
def drive(page: PageSession, origin: Origin, name: str, velocity: Twist) -> None:
    """Drive a robot at a velocity; all commands up to one of rest are undone together."""
    driven, gesture = page.driven
    request = DriveRobot(name=name, velocity=velocity)
    gesture = page.submit(origin, (request,), gesture=gesture if driven == name else None)
    page.driven = ('', 0) if velocity == REST else (name, gesture)


# Joints


@message('change_joint', '~/join', name=fields.text, properties=_joint_changes)
def change_joint(page: PageSession, origin: Origin, name: str, properties: dict[str, Any]) -> None:
    """Change the properties of a joint that are given, where the joint is."""
    snapshot = page.control.loop.bring_up_to_date()
    scene = snapshot.scene
    joint = next((each for each in scene.joints if each.name == name), None)
    if joint is None:
        raise no_joint(name, (each.name for each in scene.joints), 'name')
    poses = dict(zip(scene.names, snapshot.poses.tolist(), strict=True))
    request = Join(
        name=name,
        kind=joint.kind,
        # A joint that is drawn where it is keeps its seat.
        points=joint.drawn_points(poses),
        a=joint.a,
        b=joint.b,
        **properties,
    )
    page.submit(origin, (request,))


@message('motor', '~/join', name=fields.text, position=Within(-FASTEST, FASTEST))
def motor(page: PageSession, origin: Origin, name: str, position: float) -> None:
    """Have the motor of a joint with an `effort` go to a position [rad, m], and stay there."""
    command = MotorCommand(joint=name, mode='position', points=(CommandPoint(0.0, position),))
    page.submit(origin, (CommandMotors(commands=(command,)),))


@message('unjoin', '~/join', name=fields.text)
def unjoin(page: PageSession, origin: Origin, name: str) -> None:
    """Delete a joint."""
    page.submit(origin, (Unjoin(name=name),))


# The world


@message('gravity', 'gravity', gravity=pair)
def gravity(page: PageSession, origin: Origin, gravity: Point) -> None:
    """Set the gravity [m/s²]."""
    page.submit(origin, (Configure(changes={'gravity': gravity}),))


@message(
    'air',
    '~/set_parameters',
    damping=Optional(Within(0.0, 1.0)),
    air_density=Optional(FLUID_DENSITY),
    air_viscosity=Optional(VISCOSITY),
    wind=Optional(VELOCITY),
    gusts=Optional(GUSTS),
    gravitation=Optional(Within(0.0, HEAVIEST)),
    coulomb=Optional(Within(0.0, HEAVIEST)),
)
def air(page: PageSession, origin: Origin, **changes: Any) -> None:
    """Set the air and the attraction of the world, by the names of its settings."""
    page.submit(origin, (Configure(changes=changes),))
