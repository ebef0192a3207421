# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Drives: from the last command of each robot to the velocity of the floor under its wheels.

Problem: a robot does not have its commanded velocity at once, and not for ever: motors accelerate
wheels by so much, and a command counts until its timeout.
Method: the velocity of the wheels goes to the commanded one on a straight line, as fast as the
rim of no wheel accelerates more than it can; a robot that starts on an arc stays on it.
The wheels turn as told whatever the body does: where the floor cannot move it, they slip.

Law: the way of the wheels is the integral of their velocity by the trapezoidal rule, and exact.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.robots.odometry import chord_by_arc, reckon
from physsim_ros.engine.robots.robot_columns import robot_columns, RobotColumns
from physsim_ros.engine.step_context import StepContext
from physsim_ros.model.arrays import Floats
from physsim_ros.model.robot_states import NO_ROBOTS, RobotStates
from physsim_ros.model.scene import Scene
from physsim_ros.model.transform import norms, rotated_each, Twist


class WheelMotion(NamedTuple):
    """
    The velocity that the wheels of r robots give to their centres of mass, relative to the floor.

    :ivar mean: (r, 3) float64: over the step, world axes [m/s, rad/s]
    :ivar end: (r, 3) float64: at its end, world axes [m/s, rad/s]
    """

    mean: Floats
    end: Floats


class Drives:
    """The drives of the robots in a space."""

    def __init__(self) -> None:
        self._scene: Scene | None = None
        self._names: dict[str, int] = {}
        self._states = NO_ROBOTS
        # Mean velocity of the wheels in this step, (r, 3).
        self._mean = np.empty((0, 3))

    def states(self, scene: Scene) -> RobotStates:
        """Return the states of the robots of a scene, in its order; they are not copied."""
        if scene is not self._scene:
            names = robot_columns(scene).names
            states = RobotStates.at_rest(len(names)) if names else NO_ROBOTS
            known = [
                (row, self._names[name]) for row, name in enumerate(names) if name in self._names
            ]
            if known:
                new, old = map(list, zip(*known, strict=True))
                for column, before in zip(states, self._states, strict=True):
                    column[new] = before[old]
            self._scene, self._states = scene, states
            self._names = {name: row for row, name in enumerate(names)}
        return self._states

    def put_states(self, scene: Scene, states: RobotStates) -> None:
        """Continue with the states of the robots of a scene."""
        names = robot_columns(scene).names
        self._scene, self._states = scene, states.copy()
        self._names = {name: row for row, name in enumerate(names)}

    def forget_body(self, name: str) -> None:
        """Drop the state of a removed body."""
        self._names.pop(name, None)

    def command(self, scene: Scene, name: str, velocity: Twist, until: int) -> bool:
        """
        Have a robot drive at a velocity.

        :param velocity: vx, vy [m/s], turn [rad/s] in its own frame, commanded
        :param until: step at which it stops, without another command
        :return: whether that changes anything
        """
        states = self.states(scene)
        number = self._names[name]
        aim = robot_columns(scene).robots[number].drive.aim(velocity)
        changed = bool((states.aim[number] != aim).any() or states.until[number] != until)
        states.aim[number], states.until[number] = aim, until
        return changed

    def begin_step(self, context: StepContext) -> WheelMotion:
        """Accelerate the wheels, and return what they do in this step."""
        columns, states = robot_columns(context.table.scene), self.states(context.table.scene)
        ended = states.until <= context.step
        if np.count_nonzero(ended):
            states.aim[ended] = 0.0
        before = states.wheels.copy()
        _accelerate(states, columns, context.dt)
        self._mean = (before + states.wheels) / 2
        yaw = context.poses[columns.rows, 2]
        turn = self._mean[:, 2] * context.dt
        mean = _at_centers(self._mean, columns, yaw + turn / 2)
        # The chord of the arc that they roll along.
        mean[:, :2] *= chord_by_arc(turn)[:, None]
        return WheelMotion(mean, _at_centers(states.wheels, columns, yaw + turn))

    def end_step(self, context: StepContext) -> None:
        """Add the step to the way of the wheels, and to the odometry."""
        columns, states = robot_columns(context.table.scene), self.states(context.table.scene)
        ways = self._mean * context.dt
        states.travel[:] += ways
        turns = context.table.state[columns.rows, 2] - context.poses[columns.rows, 2]
        states.path[:, 0] += norms(ways[:, :2])
        states.path[:, 1] += np.abs(turns)
        reckon(states.odometry, ways, turns, columns, context)

    def turning(self, scene: Scene) -> Sequence[int]:
        """Return the rows of the robots whose wheels turn, or are about to."""
        states = self.states(scene)
        moving = (states.aim != 0.0).any(axis=1) | (states.wheels != 0.0).any(axis=1)
        rows: list[int] = robot_columns(scene).rows[moving].tolist()
        return rows


def _accelerate(states: RobotStates, columns: RobotColumns, dt: float) -> None:
    changes = states.aim - states.wheels
    if not np.count_nonzero(changes):
        return
    rims = columns.rims
    speeds = np.abs(
        rims[..., 0] * changes[:, None, 0]
        + rims[..., 1] * changes[:, None, 1]
        + rims[..., 2] * changes[:, None, 2]
    ).max(axis=1)
    most = columns.acceleration * dt
    slow = speeds > most
    shares = np.where(slow, most, 1.0) / np.where(slow, speeds, 1.0)
    states.wheels[:] = np.where(
        slow[:, None], states.wheels + changes * shares[:, None], states.aim
    )
    steered = np.isfinite(columns.curvature)
    if np.count_nonzero(steered):
        most_turn = columns.curvature[steered] * np.abs(states.wheels[steered, 0])
        states.wheels[steered, 2] = np.clip(states.wheels[steered, 2], -most_turn, most_turn)


def _at_centers(velocities: Floats, columns: RobotColumns, yaw: Floats) -> Floats:
    """Return (r, 3) float64: velocities of wheels as those of centres of mass, world axes."""
    result = velocities.copy()
    result[:, 0] -= velocities[:, 2] * columns.centers[:, 1]
    result[:, 1] += velocities[:, 2] * columns.centers[:, 0]
    result[:, :2] = rotated_each(result[:, :2], yaw)
    return result
