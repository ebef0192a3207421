# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The commands of drives and motors in a space.

Law: a command is obeyed from the step on at which it begins, behind those that were given before.
"""

from __future__ import annotations

from dataclasses import replace
import math

from physsim_ros.engine.bodies import RigidBody
from physsim_ros.engine.body_set import BodySet
from physsim_ros.engine.coming import ComingCommands
from physsim_ros.engine.joints.joint_set import JointSet
from physsim_ros.model.motor_command import CommandPoint, MotorCommand, TimedCommand
from physsim_ros.model.names import WORLD
from physsim_ros.model.robots import Drive
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.states import DriveCommand
from physsim_ros.model.transform import Twist


class CommandSet:
    """
    What drives and motors obey, and are to obey.

    :param bodies: of the space
    :param joints: of the space, with the commands of their motors
    :param dt: length of a sub-step [s]

    :ivar coming: commands that drives do not obey yet, by the names of the bodies
    :ivar changes: count of changes other than by steps
    """

    def __init__(self, bodies: BodySet, joints: JointSet, dt: float) -> None:
        self.coming: ComingCommands[DriveCommand] = ComingCommands()
        self.changes = 0
        self._bodies = bodies
        self._joints = joints
        self._dt = dt

    def drive(self, rigid: RigidBody, command: DriveCommand, step: int) -> None:
        """
        Have a robot drive.

        :param step: count of steps that the world has made
        """
        name = rigid.body.name
        if command.begun > step or self.coming.of(name):
            self.coming.add(name, command)
            self.changes += 1
        else:
            self._obey(rigid, command.aim, command.until)

    def drive_of(self, rigid: RigidBody) -> tuple[Twist, int]:
        """Return the velocity of the last command [m/s, rad/s], and the step at which it ends."""
        if coming := self.coming.of(rigid.body.name):
            return coming[-1].aim, coming[-1].until
        return _obeyed_by(rigid)

    def drop_without_drive(self, body: Body) -> None:
        """Drop the commands that a body was to obey, if it has no drive now."""
        if _drive(body) is None:
            self.coming.put(body.name, ())

    def command_motor(self, command: TimedCommand, step: int) -> None:
        """
        Have the motor of a joint obey a command.

        :param step: count of steps that the world has made
        """
        name = command.command.joint
        if command.begun > step or self._joints.coming.of(name):
            self._joints.coming.add(name, command)
            self.changes += 1
        else:
            self._obey_by_motor(command.command, step)

    @property
    def are_coming(self) -> bool:
        """Return whether a command is on its way."""
        return bool(self.coming or self._joints.coming)

    @property
    def steps(self) -> list[int]:
        """Return the steps at which the next command of each drive and motor begins."""
        return [*self.coming.steps, *self._joints.coming.steps]

    def begin(self, step: int) -> None:
        """Have drives and motors obey the commands that begin at a step, or have begun."""
        for name, command in self.coming.take(step, self._bodies.by_name):
            rigid = self._bodies.by_name[name]
            # The drive may be another one than that of the command.
            drive = _drive(rigid.body)
            assert drive is not None  # noqa: S101 - by `drop_without_drive`
            self._obey(rigid, drive.aim(command.aim), command.until)
        for _, motor in self._joints.coming.take(step, self._joints.by_name):
            self._obey_by_motor(motor.command, step)

    def _obey(self, rigid: RigidBody, aim: Twist, until: int) -> None:
        """Have a robot drive at a velocity as seen from it [m/s, rad/s], up to a step."""
        self.changes += _obeyed_by(rigid) != (aim, until)
        rigid.driven['aim'], rigid.driven['until'] = aim, until
        rigid.pm_body.activate()

    def _obey_by_motor(self, command: MotorCommand, step: int) -> None:
        """Have a motor obey a command from a step on; a trajectory begins where the joint is."""
        joint = self._joints.by_name[command.joint].joint
        first = command.points[0]
        if command.mode == 'position' and first.time > 0.0:
            now, then = (self._position_after(joint, time) for time in (0.0, self._dt))
            rate = math.nan if math.isnan(first.rate) else (then - now) / self._dt
            start = CommandPoint(0.0, now, rate)
            command = replace(command, points=(start, *command.points))
        self.changes += self._joints.commands.get(command.joint) != (command, step)
        self._joints.command(command, step)
        for end in (joint.a, joint.b):
            if end != WORLD:
                self._bodies.by_name[end].pm_body.activate()

    def _position_after(self, joint: Joint, seconds: float) -> float:
        ends = (end for end in (joint.a, joint.b) if end != WORLD)
        return joint.position({end: self._bodies.by_name[end].pose_after(seconds) for end in ends})


def _drive(body: Body) -> Drive | None:
    return None if body.robot is None else body.robot.drive


def _obeyed_by(rigid: RigidBody) -> tuple[Twist, int]:
    """Return velocity [m/s, rad/s] and end of the command that the drive of a robot obeys."""
    ahead, aside, turn = rigid.driven['aim'].tolist()
    return (ahead, aside, turn), int(rigid.driven['until'])
