# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The joints of a space as the tables of the core, until one comes or goes."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
import math
from typing import Any, NamedTuple, TypeAlias

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
# Constraints whose records are made at once [1]: some 10 ms.
_SLICE = 1000
# Values of the fields of a record, by name.
_Fields: TypeAlias = dict[str, Any]


class _Slice(NamedTuple):
    """
    The records of some joints, with numbers that count from the first of these.

    :ivar joints: (j,) `Joint`
    :ivar parts: (p,) `Part`
    :ivar rows: (r,) `Row`
    :ivar motors: (m,) `Motor`
    :ivar guides: row by row
    """

    joints: NDArray[np.void]
    parts: NDArray[np.void]
    rows: NDArray[np.void]
    motors: NDArray[np.void]
    guides: tuple[EngineGuide, ...]


def slices_of_records(
    joints: Sequence[EngineJoint],
    unstepped: Collection[str],
    soft: Mapping[str, float],
    dt: float,
) -> Iterator[_Slice]:
    """
    Make the records of joints, and yield those of some joints at once.

    :param unstepped: names of joints whose first step is to come
    :param soft: damping of the springs that Chipmunk does not solve, by name [N s/m, N m s/rad]
    :param dt: of a sub-step [s]
    """
    sizes = [1 + len(each.parts) for each in joints]
    begin = 0
    for count in np.unique(np.cumsum(sizes) // _SLICE, return_counts=True)[1].tolist():
        end = begin + count
        some = joints[begin:end]
        rows = [_rows_of(each, soft.get(each.joint.name, 0.0), dt) for each in some]
        known = [_joint_fields(each, dt, unstepped=each.joint.name in unstepped) for each in some]
        yield _slice_of(some, known, rows)
        begin = end


def _slice_of(
    joints: Sequence[EngineJoint], known: Sequence[_Fields], rows: Sequence[Sequence[_Fields]]
) -> _Slice:
    """
    Return the records of some joints, with numbers that count from the first of them.

    :param known: fields of each joint
    :param rows: of each joint
    """
    parts = [part for each in joints for part in each.parts]
    all_rows = [row for each in rows for row in each]
    motors = [
        _motor_fields(each.joint, number, begin + row)
        for number, (each, own, begin) in enumerate(
            zip(joints, rows, _begins([len(own) for own in rows]), strict=True)
        )
        if each.joint.properties.effort
        for row, fields in enumerate(own)
        if fields['law'] == lib.LAW_DRIVE
    ]
    of_joints, of_rows = np.zeros(len(joints), _JOINT), np.zeros(len(all_rows), _ROW)
    of_parts, of_motors = np.zeros(len(parts), _PART), np.zeros(len(motors), _MOTOR)
    _fill(of_joints, known)
    of_parts['kind'] = [part.kind for part in parts]
    of_parts['constraint'] = [address_of(part.constraint) for part in parts]
    _fill(of_rows, all_rows)
    _fill(of_motors, motors)
    of_joints['part_count'] = counts = [len(each.parts) for each in joints]
    of_joints['row_count'] = [len(each) for each in rows]
    of_rows['part'] += np.repeat(_begins(counts), [len(each) for each in rows])
    of_rows['guide_count'] = [len(each['guides']) for each in all_rows]
    guides = tuple(guide for each in all_rows for guide in each['guides'])
    return _Slice(of_joints, of_parts, of_rows, of_motors, guides)


class JointTable:
    """
    Tables of the core, whose declarations say what is in each field.

    :param joints: of the set
    :param slices: their records (`slices_of_records`)
    :param totals: (k, 2) float64 of each joint: impulses of its constraints in the last step

    :ivar joints: (j,) `Joint`
    :ivar parts: (p,) `Part`: the constraints, joint by joint
    :ivar rows: (r,) `Row`: joint by joint
    :ivar motors: (m,) `Motor`: joint by joint
    :ivar guides: (g,) `Guide`: row by row
    """

    def __init__(
        self,
        joints: Sequence[EngineJoint],
        slices: Sequence[_Slice],
        totals: Mapping[str, Floats],
    ) -> None:
        self.names = [each.joint.name for each in joints]
        self._ends = [each.ends for each in joints]
        self._guides = [guide for each in slices for guide in each.guides]
        self.joints = _joined([each.joints for each in slices], _JOINT)
        self.parts = _joined([each.parts for each in slices], _PART)
        self.rows = _joined([each.rows for each in slices], _ROW)
        self.motors = _joined([each.motors for each in slices], _MOTOR)
        for own, before, of in (
            ('rows', 'parts', 'part'),
            ('motors', 'joints', 'joint'),
            ('motors', 'rows', 'row'),
        ):
            lengths = [len(getattr(each, before)) for each in slices]
            times = [len(getattr(each, own)) for each in slices]
            getattr(self, own)[of] += np.repeat(_begins(lengths), times)
        self.joints['first_part'] = _begins(self.joints['part_count'])
        self.joints['first_row'] = _begins(self.joints['row_count'])
        self.rows['first_guide'] = _begins(self.rows['guide_count'])
        for name, of_joint in zip(self.names, self._totals, strict=True):
            # A joint of two anchored bodies has no constraints.
            if 0 < len(former := totals.get(name, ())) == len(of_joint):
                of_joint[:] = former
        self.guides = np.zeros(len(self._guides), _GUIDE)
        _fill(self.guides, [guide._asdict() for guide in self._guides])
        numbers = self.motors['joint'].tolist()
        self._motor_of = {self.names[number]: place for place, number in enumerate(numbers)}
        # The points of the last commands, which the records refer to.
        self._points: dict[str, NDArray[np.void]] = {}

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
        self.guides['body'] = [places[guide.pm_body] for guide in self._guides]

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
        moves = (self.rows['law'] == lib.LAW_BOUNDS) & (self.rows['rate'] != 0.0)
        if not moves.any():
            return {}
        joints = np.repeat(np.arange(len(self.names)), self.joints['row_count'])
        bounds = self._bounds
        return {
            self.names[number]: bounds[number][['lower', 'upper']].copy()
            for number in np.unique(joints[moves]).tolist()
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
    _rows_of(each, damping, dt)
    _joint_fields(each, dt, unstepped=True)


def _joint_fields(each: EngineJoint, dt: float, *, unstepped: bool) -> _Fields:
    joint, seat, most = each.joint, each.joint.seat, each.joint.properties.break_force
    return {
        'anchor_a': each.ends.at_a,
        'anchor_b': each.ends.at_b,
        'axis': (seat.ux, seat.uy),
        'most': math.inf if most is None else most * dt * lib.SUB_STEPS,
        'has_axis': joint.kind.schema.has_axis,
        'presses': joint.kind in _PRESSING,
        'unstepped': unstepped,
    }


def _motor_fields(joint: Joint, number: int, row: int) -> _Fields:
    return {
        'joint': number,
        'row': row,
        'effort': joint.properties.effort,
        'speed': joint.number('max_speed'),
        'gain': joint.number('gain'),
        'zero': 0.0 if joint.kind.schema.has_axis else joint.seat.phase,
    }


def _rows_of(each: EngineJoint, damping: float, dt: float) -> list[_Fields]:
    """
    Return the rows of a joint, with their guides.

    :param damping: of a spring that Chipmunk does not solve [N s/m, N m s/rad]; 0 is none
    """
    force = each.joint.holding_force
    rows: list[_Fields] = []
    for number, part in enumerate(each.parts):
        if part.kind == lib.PART_SPRING:
            # One of the two gives its force.
            part.constraint.stiffness = 0.0 if damping else each.joint.stiffness
            if not damping:
                continue
        for component, row in enumerate(part.rows):
            strongest = force if row.most is None else row.most
            of_table = {
                'part': number,
                'component': component,
                'most': math.inf if strongest is None else strongest * dt * abs(row.above),
                'damping': damping if row.law == lib.LAW_SPRING else 0.0,
            }
            rows.append(row._asdict() | of_table)
    return rows


def _fill(table: NDArray[np.void], records: Sequence[_Fields]) -> None:
    """Set the fields of a table that records have."""
    for name in table.dtype.names or ():
        if records and name in records[0]:
            table[name] = [each[name] for each in records]


def _begins(counts: Sequence[int] | NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the number of the first of some records, by their counts."""
    ends = np.cumsum(counts, dtype=np.int32)
    return ends - np.asarray(counts, np.int32)


def _joined(tables: Sequence[NDArray[np.void]], dtype: np.dtype[np.void]) -> NDArray[np.void]:
    """Return tables as one; NumPy's own concatenation goes through the fields."""
    return np.frombuffer(bytearray().join(table.tobytes() for table in tables), dtype)
