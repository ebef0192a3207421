# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Drives: from the last command of each robot to the velocity of the floor under its wheels.

Problem: a robot does not have its commanded velocity at once, and not for ever: motors accelerate
wheels by so much, and a command counts until its timeout.
Method: the velocity of the wheels goes to the commanded one on a straight line, as fast as the
rim of no wheel accelerates more than it can; a robot that starts on an arc stays on it.
The wheels turn as told whatever the body does: where the floor cannot move it, they slip.

Cost: with the odometry, some 4 µs a robot and step, in floats. On arrays it would be 70 µs, and
1 µs a robot, as a call of NumPy takes 1 µs before it begins; few worlds have 25 robots.
Law: the way of the wheels is the integral of their velocity by the trapezoidal rule, and exact.
"""

from __future__ import annotations

from collections.abc import Iterable
import math

import numpy as np
from physsim_ros.engine.robots.odometry import chord_by_arc, noise_of_step, reckoned, slips
from physsim_ros.engine.robots.robot_columns import robot_columns
from physsim_ros.engine.step_context import StepContext
from physsim_ros.model.arrays import Floats
from physsim_ros.model.robot_states import RobotState, SPAWNED
from physsim_ros.model.robots.drives.drive import within
from physsim_ros.model.scene import Scene
from physsim_ros.model.transform import Point, Pose, REST, rotated, Twist


class Drives:
    """The drives of the robots in a space."""

    def __init__(self) -> None:
        self._scene: Scene | None = None
        # Of each robot of that scene by name, in its order.
        self._states: dict[str, RobotState] = {}
        # Of each robot the yaw at which this step begins, and the mean velocity of its wheels.
        self._yaws: list[float] = []
        self._means: list[Twist] = []

    def states(self, scene: Scene) -> dict[str, RobotState]:
        """Return the states of the robots of a scene by name, in its order; not copied."""
        if scene is not self._scene:
            names = robot_columns(scene).names
            self._states = {name: self._states.get(name, SPAWNED) for name in names}
            self._scene = scene
        return self._states

    def put_states(self, scene: Scene, states: Iterable[RobotState]) -> None:
        """Continue with the states of the robots of a scene."""
        names = robot_columns(scene).names
        self._scene, self._states = scene, dict(zip(names, states, strict=True))

    def forget_body(self, name: str) -> None:
        """Drop the state of a removed body."""
        if self._states.pop(name, None) is not None:
            self._scene = None

    def command(self, scene: Scene, name: str, velocity: Twist, until: int) -> bool:
        """
        Have a robot drive at a velocity.

        :param velocity: vx, vy [m/s], turn [rad/s] in its own frame, commanded
        :param until: step at which it stops, without another command
        :return: whether that changes anything
        """
        columns, states = robot_columns(scene), self.states(scene)
        robot, before = columns.robots[columns.names.index(name)], states[name]
        states[name] = before._replace(aim=robot.drive.aim(velocity), until=until)
        return states[name] != before

    def begin_step(self, context: StepContext) -> Floats:
        """
        Accelerate the wheels.

        :return: (2, r, 3) float64: the velocity that they give to the centre of mass of each of r
            robots, relative to the floor: the mean over this step, and that at its end; world axes
            [m/s, rad/s]
        """
        columns, states = robot_columns(context.table.scene), self.states(context.table.scene)
        self._yaws = context.poses[columns.rows, 2].tolist()
        self._means = []
        means: list[float] = []
        ends: list[float] = []
        for (name, state), robot, rims, curvature, center, yaw in zip(
            states.items(),
            columns.robots,
            columns.rims,
            columns.curvatures,
            columns.centers,
            self._yaws,
            strict=True,
        ):
            aim = state.aim if context.step < state.until else REST
            mean = after = before = state.wheels
            if not before == aim == state.aim:
                most = robot.drive.acceleration * context.dt
                after = _accelerated(before, aim, rims, most, curvature)
                mean = _middle(before, after)
                states[name] = state._replace(aim=aim, wheels=after)
            turn = mean[2] * context.dt
            vx, vy, spin = _at_center(mean, center, yaw + turn / 2)
            # The chord of the arc that they roll along.
            chord = chord_by_arc(turn)
            means += vx * chord, vy * chord, spin
            ends += _at_center(after, center, yaw + turn)
            self._means.append(mean)
        return np.array(means + ends).reshape(2, -1, 3)

    def end_step(self, context: StepContext) -> None:
        """Add the step to the way of the wheels, and to the odometry."""
        columns, states = robot_columns(context.table.scene), self.states(context.table.scene)
        dt, yaws = context.dt, context.table.state[columns.rows, 2].tolist()
        for (name, state), robot, mean, before, after in zip(
            states.items(), columns.robots, self._means, self._yaws, yaws, strict=True
        ):
            aim, until, wheels, (x, y, around), odometry, (length, turned) = state
            ahead, aside, turn = mean[0] * dt, mean[1] * dt, after - before
            way = abs(complex(ahead, aside))
            told = ahead, aside, turn
            if any(robot.odometry.slip):
                noise = noise_of_step(context.settings.seed, name, context.step)
                share, drift = slips(way, turn, robot.odometry.slip, noise)
                told = ahead * share, aside * share, turn + drift
            travel = x + ahead, y + aside, around + mean[2] * dt
            path = length + way, turned + abs(turn)
            states[name] = RobotState(aim, until, wheels, travel, reckoned(odometry, told), path)


def _accelerated(
    before: Twist, aim: Twist, rims: tuple[Pose, ...], most: float, curvature: float
) -> Twist:
    """
    Return the velocity of wheels after a step.

    :param before: velocity that they have
    :param aim: velocity that is commanded
    :param rims: speed of the rim of each wheel, by the velocity
    :param most: greatest change of the speed of a rim [m/s]
    :param curvature: greatest of the way [1/m]
    """
    dx, dy, dturn = aim[0] - before[0], aim[1] - before[1], aim[2] - before[2]
    speed = max(abs(x * dx + y * dy + turn * dturn) for x, y, turn in rims)
    vx, vy, turn = aim
    if speed > most:
        share = most / speed
        vx, vy = before[0] + dx * share, before[1] + dy * share
        turn = before[2] + dturn * share
    if math.isfinite(curvature):
        turn = within(turn, curvature * abs(vx))
    return vx, vy, turn


def _middle(a: Twist, b: Twist) -> Twist:
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2


def _at_center(velocity: Twist, center: Point, yaw: float) -> Twist:
    """Return the velocity of wheels as that of the centre of mass, world axes."""
    vx, vy, turn = velocity
    vx, vy = rotated((vx - turn * center[1], vy + turn * center[0]), yaw)
    return vx, vy, turn
