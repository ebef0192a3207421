# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The joints of a space by column, until one comes or goes: constraint rows and their impulses."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
import math
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.graph_search import Rows
from physsim_ros.engine.joints.build_joint import kind_of, KINDS
from physsim_ros.engine.joints.constraint_rows import Batch, Kind
from physsim_ros.engine.joints.engine_joint import EngineJoint
from physsim_ros.engine.memory import impulse_places, NUMBERS
from physsim_ros.model.arrays import Flags, Floats
import pymunk

# ruff: noqa: SLF001


class JointRows(NamedTuple):
    """
    The constraint rows of all joints at some poses.

    :ivar excess: (r,) float64: distance of x from its bounds, < 0 below the lower one [m, rad]
    :ivar jacobian: (r, 2, 3) float64: J, of the first and the second body
    """

    excess: Floats
    jacobian: Floats


class JointTable:
    """
    All joints of a set as arrays.

    :param joints: of the set
    :param background: of the space
    :param dt: of a step [s]

    :ivar breakable: joints that can break, and the greatest impulse of each [N s]
    :ivar ends: (r, 2) intp: the two bodies of each row, as places among the jointed bodies
    :ivar equal: (r,) bool: rows of equalities; the others are limits
    :ivar most: (r,) float64: greatest absolute value of λ in a step [N s, N m s]
    """

    def __init__(self, joints: Sequence[EngineJoint], background: pymunk.Body, dt: float) -> None:
        self._dt, self._count = dt, len(joints)
        placed = [(number, each) for number, each in enumerate(joints) if each.constraints]
        self.breakable = [
            (each, most * dt)
            for _, each in placed
            if (most := each.joint.properties.break_force) is not None
        ]
        exact = [(number, each) for number, each in placed if kind_of(each.joint).rows]
        ends = (body for _, each in exact for body in (each.ends.a, each.ends.b))
        self._members = [each for each in dict.fromkeys(ends) if each is not background]
        rows = {body: row for row, body in enumerate((*self._members, background))}
        self._batches = [*_batches(exact, rows)]
        batches = [batch for _, batch in self._batches]
        counts = [batch.lower.shape[1] for batch in batches]
        self._owners = _repeated((batch.numbers for batch in batches), counts)
        self.ends = np.stack(
            (
                _repeated((batch.ends[0] for batch in batches), counts),
                _repeated((batch.ends[1] for batch in batches), counts),
            ),
            axis=1,
        )
        bounds = [
            np.stack((batch.lower, batch.upper), axis=-1).reshape(-1, 2) for batch in batches
        ]
        self._lower, self._upper = np.concatenate([np.empty((0, 2)), *bounds]).T
        self.equal = self._lower == self._upper
        numbers = [number for batch in batches for number in batch.numbers.tolist()]
        flat = [each for number in numbers for each in _row_impulses(joints[number])]
        self._places = np.array([place for place, _, _ in flat], np.int64)
        self._signs = np.array([[below, above] for _, below, above in flat]).reshape(-1, 2)
        forces = (joints[number].joint.properties.max_force for number in self._owners.tolist())
        limits = np.array([math.inf if force is None else force * dt for force in forces])
        self.most = limits * np.abs(self._signs[:, 1])
        self._listed: Sequence[RigidBody] = ()
        self._rows: Rows = np.empty(0, np.intp)

    def rows(self, listed: Sequence[RigidBody]) -> Rows:
        """Return the rows of the jointed bodies in the body table, then that of the background."""
        if self._listed is not listed:
            places = {each.pm_body: place for place, each in enumerate(listed)}
            members = (places[body] for body in self._members)
            self._rows, self._listed = np.array([*members, len(listed)], np.intp), listed
        return self._rows

    def prepare(self, poses: Floats) -> None:
        """Prepare constraints for a step in which the jointed bodies come to (b, 3) poses."""
        for kind, batch in self._batches:
            if kind.prepare is not None:
                kind.prepare(batch, poses.take(batch.ends, axis=0))

    def read(self, poses: Floats) -> JointRows:
        """Return the rows at (b, 3) float64: poses of the jointed bodies and the background."""
        values, jacobians = [], []
        for kind, batch in self._batches:
            if kind.rows is not None:
                value, jacobian = kind.rows(batch, poses.take(batch.ends, axis=0))
                values.append(value.ravel())
                jacobians.append(jacobian.reshape(-1, 2, 3))
        x = np.concatenate(values)
        excess = np.maximum(x - self._upper, 0.0) + np.minimum(x - self._lower, 0.0)
        return JointRows(excess, np.concatenate(jacobians))

    def holding(self, yielded: Flags) -> Flags:
        """Return (r,) bool: rows of joints of which no row has yielded, (r,) bool."""
        holding = np.ones(self._count, np.bool_)
        holding[self._owners[yielded]] = False
        return holding[self._owners]

    def impulses(self, rows: JointRows) -> Floats:
        """Return (r,) float64: λ of the last step [N s, N m s]."""
        impulses: Floats = NUMBERS[self._places] * self._sign(rows)
        return impulses

    def write_impulses(self, rows: JointRows, impulses: Floats) -> None:
        """Set λ, (r,) float64 [N s, N m s]."""
        NUMBERS[self._places] = impulses / self._sign(rows)

    def _sign(self, rows: JointRows) -> Floats:
        """Return (r,) float64: λ by the impulse that the engine stores."""
        return np.where(rows.excess < 0.0, self._signs[:, 0], self._signs[:, 1])


def _repeated(columns: Iterable[Rows], counts: Iterable[int]) -> Rows:
    """Return the values of some columns, each as often as its batch has rows a joint."""
    parts = [np.repeat(column, count) for column, count in zip(columns, counts, strict=True)]
    return np.concatenate([np.empty(0, np.intp), *parts])


def _row_impulses(joint: EngineJoint) -> list[tuple[int, float, float]]:
    """
    Return where the engine stores the impulses of the rows of a joint.

    :return: of each row the index in its memory, and λ by that impulse where x is below its
        bounds, and where it is not
    """
    found = []
    for constraint in joint.constraints:
        below = above = 1.0
        if isinstance(constraint, pymunk.SimpleMotor):
            # The engine alone solves it.
            continue
        if isinstance(constraint, pymunk.PivotJoint):
            # It pushes the second body.
            below = above = -1.0
        elif isinstance(constraint, pymunk.GearJoint):
            # It turns the first body by a share of the impulse.
            below = above = 1.0 / constraint.ratio
        elif isinstance(constraint, pymunk.SlideJoint):
            # It only holds back, from its least length on too.
            below = -1.0
        found += [(place, below, above) for place in impulse_places(constraint)]
    return found


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
                ends=np.array(
                    [[rows[each.ends.a], rows[each.ends.b]] for each in group], np.intp
                ).T,
                anchors=np.array([[each.ends.at_a, each.ends.at_b] for each in group]).swapaxes(
                    0, 1
                ),
                axis=np.array(seats, np.float64),
                ratio=np.array([each.joint.number('ratio') for each in group], np.float64),
                lower=bounds[:, :, 0],
                upper=bounds[:, :, 1],
                constraints=[each.constraints[0]._constraint for each in group],
            ),
        )
