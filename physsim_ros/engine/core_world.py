# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The world of the core: its tables, its calls, and what is read of it after a step."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.core import ffi, lib
from physsim_ros.model.arrays import Flags, Floats
import pymunk
from pymunk._chipmunk_cffi import ffi as pymunk_ffi

Table = NDArray[np.void]


def address_of(it: pymunk.Space | pymunk.Body | pymunk.Shape | pymunk.Constraint) -> int:
    """Return the address of Chipmunk's struct of an object of Pymunk."""
    match it:
        case pymunk.Body():
            struct = it._body  # noqa: SLF001 - Pymunk has no public way to its structs
        case pymunk.Constraint():
            struct = it._constraint  # noqa: SLF001
        case pymunk.Shape():
            struct = it._shape  # noqa: SLF001
        case _:
            struct = it._space  # noqa: SLF001
    return int(pymunk_ffi.cast('uintptr_t', struct))


class CoreWorld:
    """
    The core's part of a space.

    :param pm_space: Pymunk's
    :param dt: of a step [s]
    """

    def __init__(self, pm_space: pymunk.Space, dt: float) -> None:
        space = ffi.cast('cpSpace *', address_of(pm_space))
        self._world = ffi.gc(lib.core_new(space, dt), lib.core_free)
        # The tables that the core uses, which have to live as long.
        self._bodies: Table | None = None
        self._joints: tuple[Table, ...] = ()

    def use_bodies(self, bodies: Table) -> None:
        """Have the core step these bodies, (n + 1,) `Body`; the last one is the background."""
        self.drop_joints()
        self._bodies = bodies
        lib.core_use_bodies(self._world, *_table(bodies, 'Body'))

    def use_joints(self, joints: Table, parts: Table, rows: Table) -> None:
        """Have the core step these joints: `Joint`, `Part` and `Row` of `core.h`."""
        self._joints = joints, parts, rows
        tables = _table(joints, 'Joint'), _table(parts, 'Part'), _table(rows, 'Row')
        lib.core_use_joints(self._world, *(each for table in tables for each in table))

    def drop_joints(self) -> None:
        """Have the core step no joints, before one of them comes or goes."""
        self._joints = ()
        lib.core_use_joints(self._world, ffi.NULL, 0, ffi.NULL, 0, ffi.NULL, 0)

    def prepare_joints(self) -> None:
        """Prepare constraints for the poses of the coming step."""
        lib.core_prepare_joints(self._world)

    def solve_joints(self) -> None:
        """Solve joints, after the step of Chipmunk."""
        lib.core_solve_joints(self._world)

    def read_impulses(self) -> Floats:
        """Return (p, 2) float64: impulses from which the next step starts, of all constraints."""
        impulses = np.zeros((self._world.part_count, 2))
        lib.core_read_impulses(self._world, _pointer(impulses, 'cpVect'))
        return impulses

    def write_impulses(self, impulses: Floats) -> None:
        """Set (p, 2) float64: impulses from which the next step starts, of all constraints."""
        impulses = np.ascontiguousarray(impulses)
        lib.core_write_impulses(self._world, _pointer(impulses, 'cpVect'))

    def read_joints(self) -> tuple[Floats, Floats, Flags]:
        """
        Return what joints did in the last step.

        :return: (j,) float64: greatest impulse of a constraint [N s, N m s]; (j, 2) float64:
            linear impulse on the second body [N s]; (j,) bool: pushed its bodies apart
        """
        count = self._world.joint_count
        impulses, pulls, pressing = (
            np.zeros(count),
            np.zeros((count, 2)),
            np.zeros(count, np.bool_),
        )
        lib.core_read_joints(
            self._world,
            _pointer(impulses, 'double'),
            _pointer(pulls, 'cpVect'),
            _pointer(pressing, 'uint8_t'),
        )
        return impulses, pulls, pressing


def _pointer(array: NDArray[Any], kind: str) -> Any:
    return ffi.cast(f'{kind} *', array.ctypes.data)


def _table(array: Table, kind: str) -> tuple[Any, int]:
    """Return the arguments of the core for a table: its pointer and its count."""
    return _pointer(array, kind), len(array)
