# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The joints of a space as arrays: target velocities before a step, positions after it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
import itertools

import numpy as np
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.graph_search import Rows
from physsim_ros.engine.joints import engine_memory
from physsim_ros.engine.joints.kind import Batch, EngineJoint, Kind, Motion
from physsim_ros.engine.joints.kinds import kind_of, KINDS
from physsim_ros.engine.joints.projection import Projection
from physsim_ros.model.arrays import Floats
import pymunk

# ruff: noqa: SLF001

# Share of its greatest force that a joint gives where it gives all of it, by rounding.
_ALL = 1.0 - 1e-9
# A faster turn in a step has no centripetal term [rad]: 60 rad/s at 240 Hz.
_FAST_TURN = 0.25


class JointTable:
    """
    All joints of a set as arrays, until one comes or goes.

    :param joints: of the set
    :param background: of the space
    :param dt: of a step [s]

    :ivar breakable: joints that can break, and the greatest impulse of each [N s]
    """

    def __init__(self, joints: Sequence[EngineJoint], background: pymunk.Body, dt: float) -> None:
        self._dt = dt
        placed = [(number, each) for number, each in enumerate(joints) if each.constraints]
        self.breakable = [
            (each, most * dt)
            for _, each in placed
            if (most := each.joint.properties.break_force) is not None
        ]
        exact = [(number, each) for number, each in placed if kind_of(each.joint).rows]
        self._yielding = [
            (number, each.limited, most * dt * _ALL)
            for number, each in exact
            if (most := each.joint.properties.max_force) is not None
        ]
        ends = (body for _, each in exact for body in (each.ends.a, each.ends.b))
        self._members = [each for each in dict.fromkeys(ends) if each is not background]
        dynamic = [each.body_type == pymunk.Body.DYNAMIC for each in self._members]
        self._pushed = np.flatnonzero(dynamic)
        self._numbers = engine_memory.numbers_of(itertools.compress(self._members, dynamic))
        inverse = np.zeros((len(self._members) + 1, 3))
        for row in self._pushed.tolist():
            body = self._members[row]
            inverse[row] = 1.0 / body.mass, 1.0 / body.mass, 1.0 / body.moment
        rows = {body: row for row, body in enumerate((*self._members, background))}
        self._batches = [*_batches(exact, rows)]
        projected = [(batch, kind.rows) for kind, batch in self._batches if kind.rows]
        self._projection = Projection(projected, inverse, dt)
        self._listed: Sequence[RigidBody] = ()
        self._places: Rows = np.empty(0, np.intp)

    def rows(self, listed: Sequence[RigidBody]) -> Rows:
        """Return the rows of the jointed bodies in the engine's listing, then the background."""
        if self._listed is not listed:
            places = {each.engine: place for place, each in enumerate(listed)}
            members = (places[body] for body in self._members)
            self._places, self._listed = np.array([*members, len(listed)], np.intp), listed
        return self._places

    def set_targets(self, states: Floats) -> None:
        """
        Set the velocities that constraints are solved for in the coming step.

        :param states: (b, 6) float64: x, y [m], yaw [rad] and their rates, of the jointed bodies
        """
        dt = self._dt
        # The engine moves bodies first.
        moved = states.copy()
        moved[:, :3] += states[:, 3:] * dt
        # The term is of first order in w dt: beyond it would be noise that feeds itself.
        moved[:, 5] = np.where(np.abs(states[:, 5] * dt) > _FAST_TURN, 0.0, states[:, 5])
        pull = (1.0 - np.cos(moved[:, 5] * dt)) / dt
        for kind, batch in self._batches:
            if kind.set_targets is not None:
                a, b = batch.a, batch.b
                both = np.stack((pull[a], pull[b]), axis=1)
                kind.set_targets(batch, Motion(moved[a], moved[b], both, dt))

    def correct(self, poses: Floats) -> None:
        """Correct (b, 3) float64 poses of the jointed bodies in place."""
        # As the next step would, so that it begins at the pose that targets were set for.
        poses[self._pushed] += engine_memory.take_pushes(self._numbers) * self._dt
        yielded = [
            number
            for number, limited, most in self._yielding
            if any(abs(constraint.impulse) >= most for constraint in limited)
        ]
        self._projection.close(poses, yielded)


def _batches(
    joints: Iterable[tuple[int, EngineJoint]], rows: Mapping[pymunk.Body, int]
) -> Iterable[tuple[Kind, Batch]]:
    """Yield joints by kind and number of rows, in an order that depends on these alone."""
    sorts: dict[tuple[int, int], list[tuple[int, EngineJoint]]] = {}
    order = list(KINDS.values())
    for number, joint in joints:
        kind = kind_of(joint.joint)
        sort = order.index(kind), len(kind.bounds(joint.joint))
        sorts.setdefault(sort, []).append((number, joint))
    for (kind_number, _), some in sorted(sorts.items()):
        kind = order[kind_number]
        group = [each for _, each in some]
        seats = [(each.joint.seat.ux, each.joint.seat.uy) for each in group]
        bounds = np.array([kind.bounds(each.joint) for each in group], np.float64)
        yield (
            kind,
            Batch(
                numbers=np.array([number for number, _ in some], np.intp),
                a=np.array([rows[each.ends.a] for each in group], np.intp),
                b=np.array([rows[each.ends.b] for each in group], np.intp),
                at_a=np.array([each.ends.at_a for each in group], np.float64),
                at_b=np.array([each.ends.at_b for each in group], np.float64),
                axis=np.array(seats, np.float64),
                ratio=np.array([each.joint.number('ratio') for each in group], np.float64),
                lower=bounds[:, :, 0],
                upper=bounds[:, :, 1],
                constraints=[each.constraints[0]._constraint for each in group],
            ),
        )
