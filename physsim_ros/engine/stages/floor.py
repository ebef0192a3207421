# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The floor of a world that is seen from above: it pulls every body towards its own velocity.

Problem: bodies on a floor slide to a stop, robots drive, stall and push, conveyors carry.
Method: one mechanism. Under a body the floor has a velocity: 0, that of a conveyor, and of a robot
besides that of its wheels against the floor. Friction brings the body to that velocity within its
limit surface (`limit_surface`): `floor_friction` m g, of a robot its traction m g.
It is solved before the engine's step, implicitly, with the push of contacts and joints that the
last step has had (warm start): so it bears what presses on a body, and a robot pushes at its full
speed. A body that the floor carries moves exactly as the floor; one that slips has the mean of its
velocities before and after as it is moved (velocity Verlet), the rest of friction as a force.
Cost: nothing where there is neither floor friction nor a robot; else 100 operations on arrays.
Without it: nothing stops, nothing drives (`test/laws/test_floor.py`).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.graph_search import Rows
from physsim_ros.engine.memory import (
    BODY_FORCES,
    BODY_INVERSES,
    BODY_TWIST,
    read_numbers,
    write_numbers,
)
from physsim_ros.engine.robots.drives import Drives
from physsim_ros.engine.robots.robot_columns import robot_columns
from physsim_ros.engine.settings import IDLE_SPEED
from physsim_ros.engine.stages.conveyors import conveyors_of, floor_velocities
from physsim_ros.engine.stages.limit_surface import friction_of
from physsim_ros.engine.step_context import StepContext
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import STANDARD_GRAVITY
from physsim_ros.model.shapes import lever_of

# The share of the push of the last step that the next one expects where the floor stands still.
# With all of it, bodies would stay pressed against each other by friction alone, for ever; so they
# lose a fiftieth in each step.
_RELAXED = 0.98
# The greatest push that is expected, by the limit of friction: more is an impact, which is over.
# A push below the least one is none, so that what rests is still to the last bit.
_MOST_EXPECTED, _LEAST_EXPECTED = 2.0, 1e-9
# The share of the newest push in the one that is expected. With all of it, a robot at a wall and
# the wall would push in turns.
_NEWEST = 0.5


class FloorColumns(NamedTuple):
    """
    Columns that follow from the scene alone, for the k bodies that the floor acts on.

    :ivar rows: (k,) intp: of the body table
    :ivar friction: (k,) float64: coefficient of friction with the floor
    :ivar lever: (k,) float64: mean distance of the points that bear it [m]
    :ivar gyration: (k,) float64: moment of inertia by mass [m²]
    """

    rows: Rows
    friction: Floats
    lever: Floats
    gyration: Floats


@lru_cache(maxsize=2)
def _floor_columns(scene: Scene) -> FloorColumns:
    mu, found = scene.settings.floor_friction, []
    for row, body in enumerate(scene.bodies):
        robot = body.robot
        friction = mu if robot is None else robot.drive.traction
        if body.dynamic and friction > 0.0:
            form = body.shape.form
            lever = lever_of(form) if robot is None else robot.drive.lever
            found.append((row, friction, lever, form.gyration))
    rows, frictions, levers, gyrations = zip(*found, strict=True) if found else ((),) * 4
    return FloorColumns(
        rows=np.array(rows, np.intp),
        friction=np.array(frictions, np.float64),
        lever=np.array(levers, np.float64),
        gyration=np.array(gyrations, np.float64),
    )


class Floor:
    """
    The floor under the bodies of a space.

    :ivar drives: of the robots
    """

    def __init__(self) -> None:
        self.drives = Drives()
        # The bodies of the last step, and (n, 3) changes of their velocities and spins by contacts
        # and joints: a running mean of the last steps.
        self._bodies: Sequence[RigidBody] = ()
        self._pushes: Floats = np.empty((0, 3))
        # Velocities and spins that the bodies would have after this step without contacts.
        self._without: Floats = np.empty((0, 3))

    def pushes(self, table: BodyTable) -> Floats:
        """
        Return what contacts and joints have changed in the last step.

        :return: (n, 3) float64: changes of velocity [m/s] and spin [rad/s]; (0, 3) where there
            are none
        """
        if self._bodies is not table.bodies and len(self._pushes):
            rows = {id(rigid): row for row, rigid in enumerate(self._bodies)}
            pushes = np.zeros((len(table.bodies), 3))
            for row, rigid in enumerate(table.bodies):
                if id(rigid) in rows:
                    pushes[row] = self._pushes[rows[id(rigid)]]
            self._pushes = pushes
        self._bodies = table.bodies
        return self._pushes

    def put_pushes(self, table: BodyTable, pushes: Floats) -> None:
        """Continue with what contacts and joints have changed in the last step; see `pushes`."""
        self._bodies, self._pushes = table.bodies, pushes.copy()

    def pull_bodies(self, context: StepContext) -> None:
        """Bring bodies to the velocity of the floor under them, before the engine's step."""
        table = context.table
        columns = _floor_columns(table.scene)
        robots = robot_columns(table.scene)
        if not len(columns.rows) and not len(robots.rows):
            self._pushes = self._without = np.empty((0, 3))
            return
        mean, end = self._floor_under(context)
        pushes = self.pushes(table)
        if not len(pushes):
            pushes = np.zeros((len(table.bodies), 3))
        rows, awake = columns.rows, ~table.asleep[columns.rows]
        places = table.places[rows]
        forces, inverses = read_numbers(places, BODY_FORCES), read_numbers(places, BODY_INVERSES)
        true = context.twists[rows] - np.where(table.free[rows, None], table.leads[rows], 0.0)
        dt, kept = context.dt, (1.0 - context.settings.damping) ** context.dt
        # What the step brings without the floor: damping, gravity, forces of commands and hands.
        after = true * kept + forces * (inverses * dt)
        after[:, :2] += np.array(context.settings.gravity) * dt
        most = columns.friction * (STANDARD_GRAVITY * dt)
        moves = mean[rows].any(axis=1, keepdims=True)
        expected = _bounded(pushes[rows] * np.where(moves, 1.0, _RELAXED), most, columns)
        slips = after + expected - end[rows]
        changes, sticks = friction_of(slips, most, columns.lever, columns.gyration)
        moved = np.where(sticks[:, None], mean[rows], (true + after + expected + changes) / 2)
        added = ((true - moved) * kept + changes) / (inverses * dt)
        # A body at rest is not written, and so is not woken up.
        changed = awake & ((moved != context.twists[rows]) | (added != 0.0)).any(axis=1)
        self._without = context.twists.copy()
        self._without[rows] = after + changes
        if np.count_nonzero(changed):
            write_numbers(places[changed], BODY_TWIST, moved[changed])
            write_numbers(places[changed], BODY_FORCES, (forces + added)[changed])
            context.twists[rows[changed]] = moved[changed]

    def end_step(self, context: StepContext) -> None:
        """Find what contacts and joints have changed, after the engine's step."""
        table = context.table
        if not len(self._without):
            return
        state, rows = table.state, _floor_columns(table.scene).rows
        before = self.pushes(table)
        self._pushes = np.zeros((len(table.bodies), 3))
        rows = rows[~table.asleep[rows]]
        self._pushes[rows] = _NEWEST * (state[rows, 3:] - self._without[rows])
        if len(before):
            self._pushes[rows] += (1.0 - _NEWEST) * before[rows]
        if len(robot_columns(table.scene).rows):
            self.drives.end_step(context)
        self._keep_awake(context)

    def _floor_under(self, context: StepContext) -> tuple[Floats, Floats]:
        """Return (n, 3) each: mean velocity of the floor in this step, and that at its end."""
        still = floor_velocities(context)
        mean = np.zeros((len(context.table.bodies), 3)) if still is None else still
        end = mean.copy()
        robots = robot_columns(context.table.scene).rows
        if len(robots):
            motion = self.drives.begin_step(context)
            mean[robots] += motion.mean
            end[robots] += motion.end
        return mean, end

    def _keep_awake(self, context: StepContext) -> None:
        """Keep bodies awake that move as slowly as what falls asleep: robots, bodies on belts."""
        table = context.table
        rows = list(self.drives.turning(table.scene))
        if conveyors_of(table.scene):
            velocities = floor_velocities(context)
            if velocities is not None:
                carried: Flags = velocities.any(axis=1) & table.columns.dynamic[:-1]
                rows += np.flatnonzero(carried & ~table.asleep).tolist()
        for row in rows:
            if table.asleep[row] or (table.sizes[row, 3:] < IDLE_SPEED).all():
                table.bodies[row].pm_body.activate()


def _bounded(pushes: Floats, most: Floats, columns: FloorColumns) -> Floats:
    """Return expected pushes, none of them far beyond the limit of friction, or next to none."""
    around = np.abs(pushes[:, 2]) * (columns.gyration / columns.lever)
    size = np.hypot(np.hypot(pushes[:, 0], pushes[:, 1]), around) / most
    share = np.where(size < _LEAST_EXPECTED, 0.0, 1.0 / np.maximum(size / _MOST_EXPECTED, 1.0))
    result: Floats = pushes * share[:, None]
    return result
