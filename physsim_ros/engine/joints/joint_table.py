# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The joints of a space as the tables of the core, until one comes or goes."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.core import dtype_of, lib
from physsim_ros.engine.joints.kinds import EngineGuide, EngineJoint
from physsim_ros.engine.joints.stiffness import dampings_of
from physsim_ros.engine.layout import address_of
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.motor_command import MODES, MotorCommand
from physsim_ros.model.scene import Body, Joint
import pymunk

_JOINT, _PART, _ROW, _GUIDE = map(dtype_of, ('Joint', 'Part', 'Row', 'Guide'))
_MOTOR, _POINT = dtype_of('Motor'), dtype_of('CommandPoint')
# Kinds whose part may push their bodies apart.
_PRESSING = {JointKind.ROD, JointKind.SPRING}


class JointTable:
    """
    Tables of the core, whose declarations say what is in each field.

    :param joints: of the set
    :param unstepped: names of joints whose first step is to come
    :param totals: (k, 2) float64 of each joint: impulses of its constraints in the last step
    :param soft: damping of the springs that Chipmunk does not solve, by name [N s/m, N m s/rad]
    :param dt: of a sub-step [s]

    :ivar joints: (j,) `Joint`
    :ivar parts: (p,) `Part`: the constraints, joint by joint
    :ivar rows: (r,) `Row`: joint by joint
    :ivar motors: (m,) `Motor`: joint by joint
    :ivar guides: (g,) `Guide`: row by row
    """

    def __init__(
        self,
        joints: Sequence[EngineJoint],
        unstepped: Collection[str],
        totals: Mapping[str, Floats],
        soft: Mapping[str, float],
        dt: float,
    ) -> None:
        self.names = [each.joint.name for each in joints]
        self._ends = [each.ends for each in joints]
        parts = [part for each in joints for part in each.parts]
        counts = [len(each.parts) for each in joints]
        firsts = np.cumsum(counts) - counts
        self.joints = np.zeros(len(joints), _JOINT)
        rows = [
            _rows_of(each, first, soft.get(each.joint.name, 0.0), dt)
            for each, first in zip(joints, firsts, strict=True)
        ]
        known = [
            _joint_fields(each, dt, unstepped=each.joint.name in unstepped) for each in joints
        ]
        _fill(self.joints, known)
        for first, count, counts in (
            ('first_part', 'part_count', [len(each.parts) for each in joints]),
            ('first_row', 'row_count', [len(each) for each in rows]),
        ):
            self.joints[count] = counts
            self.joints[first] = np.cumsum(counts) - counts
        self.parts = np.zeros(len(parts), _PART)
        _fill(self.parts, [(part.kind, address_of(part.constraint)) for part in parts])
        for name, of_joint in zip(self.names, self._totals, strict=True):
            # A joint of two anchored bodies has no constraints.
            if 0 < len(former := totals.get(name, ())) == len(of_joint):
                of_joint[:] = former
        self.rows = np.zeros(sum(map(len, rows)), _ROW)
        _fill(self.rows, [row for each in rows for row, _ in each])
        self._guides = [guide for each in rows for _, guides in each for guide in guides]
        self.rows['guide_count'] = counts = [len(guides) for each in rows for _, guides in each]
        self.rows['first_guide'] = np.cumsum(counts) - counts
        self.guides = np.zeros(len(self._guides), _GUIDE)
        _fill(self.guides, [(-1, *guide[1:6]) for guide in self._guides])
        laws, motors = self.rows['law'].tolist(), []
        for number, each in enumerate(joints):
            if each.joint.properties.effort:
                motors += [
                    _motor_fields(each.joint, number, row)
                    for row in self._rows_of(number)
                    if laws[row] == lib.LAW_DRIVE
                ]
        self.motors = np.zeros(len(motors), _MOTOR)
        _fill(self.motors, motors)
        numbers = self.motors['joint'].tolist()
        self._motor_of = {self.names[number]: place for place, number in enumerate(numbers)}
        # The points of the last commands, which the records refer to.
        self._points: dict[str, NDArray[np.void]] = {}

    def _rows_of(self, number: int) -> range:
        """Return the numbers of the rows of a joint."""
        first, count = self.joints[number][['first_row', 'row_count']].tolist()
        return range(first, first + count)

    def command(self, command: MotorCommand, begun: int) -> None:
        """
        Have a motor obey a command; nothing happens where its joint has none.

        :param begun: step at which the command began
        """
        place = self._motor_of.get(command.joint)
        if place is None:
            return
        points = np.array([tuple(each) for each in command.points], _POINT)
        self._points[command.joint] = points
        record = self.motors[place]
        record['mode'], record['begun'] = MODES.index(command.mode), begun
        record['points'], record['point_count'] = points.ctypes.data, len(points)

    def place_ends(self, places: Mapping[pymunk.Body, int]) -> None:
        """Set the places of bodies in the table of bodies, the background among them."""
        self.joints['a'] = [places[ends.a] for ends in self._ends]
        self.joints['b'] = [places[ends.b] for ends in self._ends]
        self.guides['body'] = [places[guide.body] for guide in self._guides]

    @property
    def broken(self) -> list[int]:
        """Return the numbers of the joints that broke in the last step."""
        numbers: list[int] = np.flatnonzero(self.joints['broken']).tolist()
        return numbers

    @property
    def totals(self) -> dict[str, Floats]:
        """Return (k, 2) float64 of each joint: impulses of its constraints in the last step."""
        return dict(zip(self.names, self._totals, strict=True))

    def set_bounds(self, bounds: Mapping[str, NDArray[np.void]]) -> None:
        """Set `lower` and `upper` of the rows of joints, by name."""
        for name, rows in zip(self.names, self._bounds, strict=True):
            former = bounds.get(name)
            if former is not None and len(former) == len(rows):
                rows[['lower', 'upper']] = former

    @property
    def bounds(self) -> dict[str, NDArray[np.void]]:
        """Return `lower` and `upper` of the rows of each joint that has one which moves."""
        pairs = zip(self.names, self._bounds, strict=True)
        return {
            name: rows[['lower', 'upper']].copy()
            for name, rows in pairs
            if (rows['rate'][rows['law'] == lib.LAW_BOUNDS] != 0.0).any()
        }

    @property
    def _bounds(self) -> list[NDArray[np.void]]:
        return np.split(self.rows, self.joints['first_row'][1:])

    @property
    def _totals(self) -> list[Floats]:
        return np.split(self.parts['total'], self.joints['first_part'][1:])

    @property
    def unstepped(self) -> set[str]:
        """Return the names of the joints whose first step is to come."""
        return {self.names[number] for number in np.flatnonzero(self.joints['unstepped'])}


def check_joint(each: EngineJoint, bodies: Mapping[str, Body], dt: float) -> None:
    """
    Make the records of a joint, so that an error in them refuses its request, and ends no step.

    :param bodies: by name
    :param dt: of a sub-step [s]
    """
    damping = dampings_of([each.joint], bodies, dt)[0] if each.joint.is_elastic else 0.0
    _rows_of(each, 0, damping, dt)
    _joint_fields(each, dt, unstepped=True)


def _joint_fields(each: EngineJoint, dt: float, *, unstepped: bool) -> tuple[object, ...]:
    """Return the first fields of a joint, in their order."""
    joint, seat, most = each.joint, each.joint.seat, each.joint.properties.break_force
    return (
        each.ends.at_a,
        each.ends.at_b,
        (seat.ux, seat.uy),
        seat.length if joint.kind.schema.rolls else joint.number('ratio'),
        math.inf if most is None else most * dt * lib.SUB_STEPS,
        joint.kind.schema.has_axis,
        joint.kind in _PRESSING,
        unstepped,
    )


def _motor_fields(joint: Joint, number: int, row: int) -> tuple[object, ...]:
    """Return the first fields of a motor, in their order."""
    zero = 0.0 if joint.kind.schema.has_axis else joint.seat.phase
    numbers = joint.number('max_speed'), joint.number('gain'), zero
    return number, row, joint.properties.effort, *numbers


def _rows_of(
    each: EngineJoint, first: int, damping: float, dt: float
) -> list[tuple[tuple[object, ...], tuple[EngineGuide, ...]]]:
    """
    Return the rows of a joint, each with its guides.

    :param first: number of its first part
    :param damping: of a spring that Chipmunk does not solve [N s/m, N m s/rad]; 0 is none
    """
    force = each.joint.holding_force
    rows: list[tuple[tuple[object, ...], tuple[EngineGuide, ...]]] = []
    for number, part in enumerate(each.parts, first):
        if part.kind == lib.PART_SPRING:
            # One of the two gives its force.
            part.constraint.stiffness = 0.0 if damping else each.joint.stiffness
            if not damping:
                continue
        for component, row in enumerate(part.rows):
            greatest = force if row.most is None else row.most
            most = math.inf if greatest is None else greatest * dt * abs(row.above)
            spring = (each.joint.stiffness, damping) if row.law == lib.LAW_SPRING else (0.0, 0.0)
            bounds = row.lower, row.upper, row.below, row.above, most, row.rate, *row.reach
            fields = (row.kind, row.law, number, component, *bounds, row.offset, *spring)
            rows.append((fields, row.guides))
    return rows


def _fill(table: NDArray[np.void], records: Sequence[tuple[object, ...]]) -> None:
    """Set the first fields of a table, field by field."""
    for name, column in zip(table.dtype.names or (), zip(*records, strict=True), strict=False):
        table[name] = column
