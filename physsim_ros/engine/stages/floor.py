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
Cost: nothing where there is neither floor friction nor a robot; else 50 operations on arrays.
Without it: nothing stops, nothing drives (`test/laws/test_floor.py`).
"""

from __future__ import annotations

from functools import lru_cache
import math
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.graph_search import Rows
from physsim_ros.engine.memory import (
    BODY_FORCES,
    BODY_IDLE_TIME,
    BODY_TWIST,
    NUMBERS,
    words_at,
)
from physsim_ros.engine.robots.drives import Drives
from physsim_ros.engine.stages.limit_surface import friction_of, LimitSurface
from physsim_ros.engine.step_context import StepContext
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.checkpoint import NO_PUSHES
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import STANDARD_GRAVITY
from physsim_ros.model.shapes import contains, lever_of
from physsim_ros.model.transform import rotated_each, Twist

# The share of the push of the last step that the next one expects where the floor stands still.
# With all of it, bodies would stay pressed against each other by friction alone, for ever; so they
# lose a fiftieth in each step.
_RELAXED = 0.98
# The greatest push that is expected, by the limit of friction: more is an impact, which is over.
_MOST_EXPECTED = 2.0
# A push below this is none [m/s, rad/s], so that what rests is still to the last bit.
_LEAST = 1e-11
# Of a body in Pymunk's memory.
_TWIST_AND_FORCES = np.concatenate((BODY_TWIST, BODY_FORCES))


class FloorColumns(NamedTuple):
    """
    Columns that follow from the scene alone, for the k bodies that the floor acts on.

    :ivar acts: whether there is a body that the floor acts on, or a robot
    :ivar rows: (k,) intp: of the body table
    :ivar robots: places of robots among them
    :ivar driven: numbers of these robots among all of the scene
    :ivar surface: their limit surfaces
    :ivar response: (k, 3) float64: change of velocity and spin in a step by a force and a torque
    """

    acts: bool
    rows: Rows
    robots: Rows
    driven: Rows
    surface: LimitSurface
    response: Floats


@lru_cache(maxsize=2)
def _floor_columns(scene: Scene, dt: float) -> FloorColumns:
    found: list[tuple[int, float, float, Twist]] = []
    robots, driven = [], []
    friction, number = scene.floor_friction, 0
    for row, body in enumerate(scene.bodies):
        robot, form, acts = body.robot, body.shape.form, bool(friction[row] > 0.0)
        if acts and robot is not None:
            robots.append(len(found))
            driven.append(number)
        number += robot is not None
        if acts:
            lever = lever_of(form) if robot is None else robot.drive.lever
            mass = body.total_mass
            response = (1.0 / mass, 1.0 / mass, 1.0 / (mass * form.gyration))
            found.append((row, lever, form.gyration, response))
    rows, levers, gyrations, responses = zip(*found, strict=True) if found else ((),) * 4
    return FloorColumns(
        acts=bool(found) or number > 0,
        rows=np.array(rows, np.intp),
        robots=np.array(robots, np.intp),
        driven=np.array(driven, np.intp),
        surface=LimitSurface.of(
            friction[friction > 0.0] * (STANDARD_GRAVITY * dt),
            np.array(levers, np.float64),
            np.array(gyrations, np.float64),
        ),
        response=np.array(responses, np.float64).reshape(-1, 3) * dt,
    )


class Floor:
    """
    The floor under the bodies of a space.

    :param dt: of a step [s]

    :ivar drives: of the robots
    """

    def __init__(self, dt: float) -> None:
        self.drives = Drives()
        self._dt = dt
        # The table of the last step, and of the bodies that the floor acts on: their columns,
        # (k, 6) words of their velocities and forces, (k,) words of their idle times, and (k, 3)
        # changes of velocities and spins by contacts and joints, a running mean of the last steps.
        self._table: BodyTable | None = None
        self._columns: FloorColumns
        self._words: Ints
        self._idle_times: Ints
        self._pushes = NO_PUSHES
        # (k, 3) velocities and spins that they would have after this step without contacts.
        self._without = NO_PUSHES
        # (k, 3) mean velocities and spins of the floor under them in this step.
        self._under = NO_PUSHES

    def pushes(self, table: BodyTable) -> Floats:
        """
        Return what contacts and joints have changed in the last step.

        :return: (k, 3) float64: changes of velocity [m/s] and spin [rad/s] of the bodies that the
            floor acts on, in spawn order; not copied
        """
        if table is self._table:
            return self._pushes
        rows = _floor_columns(table.scene, self._dt).rows
        if not len(rows):
            return NO_PUSHES
        pushes = np.zeros((len(rows), 3))
        if self._table is not None and np.count_nonzero(self._pushes):
            before = self._columns.rows.tolist()
            places = {id(self._table.bodies[row]): place for place, row in enumerate(before)}
            for place, row in enumerate(rows.tolist()):
                old = places.get(id(table.bodies[row]))
                if old is not None:
                    pushes[place] = self._pushes[old]
        return pushes

    def begin(self, table: BodyTable, pushes: Floats) -> None:
        """Continue with what contacts and joints have changed in the last step; see `pushes`."""
        self._table, self._columns = table, _floor_columns(table.scene, self._dt)
        self._pushes = pushes if len(pushes) else np.zeros((len(self._columns.rows), 3))
        places = table.places.take(self._columns.rows)
        self._words = words_at(places, _TWIST_AND_FORCES)
        self._idle_times = words_at(places, BODY_IDLE_TIME)

    def pull_bodies(self, context: StepContext) -> None:
        """Bring bodies to the velocity of the floor under them, before the engine's step."""
        table, dt = context.table, context.dt
        if table is not self._table:
            self.begin(table, self.pushes(table))
        columns, words = self._columns, self._words
        if not columns.acts:
            return
        mean, end = self._floor_under(context)
        rows, now = columns.rows, NUMBERS[words]
        true, forces = now[:, :3], now[:, 3:]
        if np.count_nonzero(table.leads):
            true = true - np.where(table.free[rows, None], table.leads[rows], 0.0)
        # What the step brings without the floor: damping, gravity, forces of commands and hands.
        kept = (1.0 - context.settings.damping) ** dt
        after = true * kept + forces * columns.response
        if any(context.settings.gravity):
            after[:, :2] += np.array(context.settings.gravity) * dt
        expected = self._pushes
        if np.count_nonzero(expected):
            moves = mean.any(axis=1, keepdims=True)
            expected = _bounded(expected * np.where(moves, 1.0, _RELAXED), columns.surface)
        changes, slides = friction_of(after + expected - end, columns.surface)
        moved = mean
        if np.count_nonzero(slides):
            slid = (true + after + expected + changes) / 2
            moved = np.where(slides[:, None], slid, mean)
        added = ((true - moved) * kept + changes) / columns.response
        self._under, self._without = mean, after + changes
        then = np.concatenate((moved, forces + added), axis=1)
        if table.sleepers:
            awake = (~table.asleep[rows]).nonzero()[0]
            rows, words = rows.take(awake), words.take(awake, axis=0)
            then = then.take(awake, axis=0)
        NUMBERS[words] = then
        context.twists[rows] = then[:, :3]

    def end_step(self, context: StepContext) -> None:
        """Find what contacts and joints have changed, after the engine's step."""
        table, rows = context.table, self._columns.rows
        if not self._columns.acts:
            return
        twists = table.state.take(rows, axis=0)[:, 3:]
        # Half of what is expected is the newest push. With all of it, a robot at a wall and the
        # wall would push in turns.
        pushes = (twists - self._without + self._pushes) / 2.0
        if table.sleepers:
            pushes[table.asleep[rows]] = 0.0
        pushes[np.maximum.reduce(np.abs(pushes), axis=1) < _LEAST] = 0.0
        self._pushes = pushes
        if len(table.scene.robot_rows):
            self.drives.end_step(context)
        self._keep_awake(context)

    def _floor_under(self, context: StepContext) -> tuple[Floats, Floats]:
        """Return (k, 3) each: mean velocity of the floor in this step, and that at its end."""
        columns = self._columns
        under = np.zeros((2, len(columns.rows), 3))
        if len(context.table.scene.robot_rows):
            wheels = self.drives.begin_step(context)
            under[:, columns.robots] = wheels.take(columns.driven, axis=1)
        velocities = _conveyor_velocities(context)
        if velocities is not None:
            under += velocities[columns.rows]
        return under[0], under[1]

    def _keep_awake(self, context: StepContext) -> None:
        """Keep bodies awake that are slow on a floor that moves: robots, and bodies on belts."""
        table, idle = context.table, NUMBERS[self._idle_times] > 0.0
        if not np.count_nonzero(idle):
            return
        rows = self._columns.rows[idle & self._under.any(axis=1)]
        for row in rows[~table.asleep[rows]].tolist():
            table.bodies[row].pm_body.activate()


def _bounded(pushes: Floats, surface: LimitSurface) -> Floats:
    """Return expected pushes, none of them far beyond the limit of friction."""
    size = np.sqrt(surface.squares(pushes)) / _MOST_EXPECTED
    result: Floats = pushes / np.maximum(size, 1.0)[:, None]
    return result


@lru_cache(maxsize=2)
def _conveyors_of(scene: Scene) -> tuple[int, ...]:
    """Return the rows of the conveyors of a scene."""
    return tuple(row for row, body in enumerate(scene.bodies) if any(body.surface_velocity))


def _conveyor_velocities(context: StepContext) -> Floats | None:
    """
    Return the velocity of the conveyors under each body.

    A body is on a conveyor where its centre of mass is inside of it; of several, the one that was
    spawned last counts.

    :return: (n, 3) float64: at the centre of mass, world axes [m/s], turn [rad/s]; None where the
        floor stands still
    """
    table, rows = context.table, _conveyors_of(context.table.scene)
    if not rows:
        return None
    velocities = np.zeros((len(table.bodies), 3))
    centers = context.poses[:, :2]
    for row in rows:
        body, yaw = table.scene.bodies[row], context.poses[row, 2]
        # The engine's origin of a body is its centre of mass; of an anchored one, its own.
        around = centers - context.poses[row, :2]
        local = rotated_each(around, -yaw) + table.columns.offsets[row]
        on = contains(body.shape.form.pieces, *local.T)
        on[row] = False
        vx, vy, spin = context.twists[row].tolist()
        sx, sy = body.surface_velocity
        cos, sin = math.cos(yaw), math.sin(yaw)
        velocities[on, 0] = vx + cos * sx - sin * sy - spin * around[on, 1]
        velocities[on, 1] = vy + sin * sx + cos * sy + spin * around[on, 0]
        velocities[on, 2] = spin
    return velocities
