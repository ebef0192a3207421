# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The world of the core: its tables, its calls, and what is read of it after a step."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.core import dtype_of, ffi, lib, pointer
from physsim_ros.engine.layout import address_of, check_layout
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.checks import LOST
from physsim_ros.model.settings import WorldSettings
import pymunk
from pymunk._chipmunk_cffi import ffi as pymunk_ffi
from pymunk._chipmunk_cffi import lib as pymunk_lib

Table = NDArray[np.void]
# Functions of Chipmunk by the fields of `Chipmunk`.
_FUNCTIONS = {
    'space_step': 'cpSpaceStep',
    'body_activate': 'cpBodyActivate',
    'reindex_body': 'cpSpaceReindexShapesForBody',
    'shape_query': 'cpSpaceShapeQuery',
    'each_arbiter': 'cpSpaceEachCachedArbiter',
    'point_query': 'cpShapePointQuery',
    'remove_shape': 'cpSpaceRemoveShape',
}
# Structs of the tables that `CoreWorld.use` takes.
_STRUCTS = {
    'grips': 'Grip',
    'forces': 'AppliedForce',
    'motors': 'Motor',
    'regions': 'Region',
    'attractors': 'Attractor',
    'robots': 'Robot',
    'actors': 'Actor',
}
_CONTACT, _BEGUN = dtype_of('Contact'), dtype_of('Begun')
check_layout()


class CoreWorld:
    """
    The core's part of a space.

    :param pm_space: Pymunk's
    :param dt: of a sub-step [s]

    :cvar left_out: stages that new worlds leave out, a sum of `STAGE_...` of
        `engine/core/core.h`; to measure what fails without them
    :cvar longest_call: time in which a call of the core is to end, within a step too, in new
        worlds [s]: no signal ends a call, and a person hardly notices so long. One sub-step is
        made in any case
    """

    left_out = 0
    longest_call = 0.05

    def __init__(self, pm_space: pymunk.Space, dt: float) -> None:
        # A massive body outside the space, whose angle stays 0 and within the limits.
        body = pymunk.Body(1.0, 1.0)
        hook = pymunk.RotaryLimitJoint(pm_space.static_body, body, -1.0, 1.0)
        pm_space.add(hook)
        pointers = (
            ffi.cast('cpSpace *', address_of(pm_space)),
            _chipmunk(),
            dt,
            ffi.cast('cpConstraint *', address_of(hook)),
        )
        self._world = ffi.gc(lib.core_new(*pointers), lib.core_free)
        self._world.stages = lib.STAGE_ALL & ~self.left_out
        self._world.longest_call, self._world.farthest = self.longest_call, LOST
        # Kept while the core uses them: what it calls, and its tables.
        self._pm_space = pm_space
        self._tables: dict[str, tuple[Table, ...]] = {}

    # Before a step

    def use_bodies(self, bodies: Table, former: Sequence[int]) -> None:
        """
        Have the core step these bodies; the tables that `use` takes are next, but for motors.

        :param bodies: (n + 1,) `Body`; the last one is the background
        :param former: place of each in the table before; -1 for those that are new
        """
        self.drop_joints()
        places = np.array(former, np.int32)
        lib.core_use_bodies(
            self._world, *_pointer_and_count(bodies, 'Body'), pointer(places, 'int32_t')
        )
        self._tables['bodies'] = (bodies,)

    def use_joints(self, joints: Table, parts: Table, rows: Table, guides: Table) -> None:
        """Have the core step these joints, by structs of their names in `engine/core/core.h`."""
        structs = 'Joint', 'Part', 'Row', 'Guide'
        tables = zip((joints, parts, rows, guides), structs, strict=True)
        pointers = (each for table in tables for each in _pointer_and_count(*table))
        lib.core_use_joints(self._world, *pointers)
        self._tables['joints'] = joints, parts, rows, guides

    def drop_joints(self) -> None:
        """Have the core step no joints, before one of them comes or goes."""
        if 'joints' not in self._tables:
            return
        self._world.motor_count = 0
        lib.core_use_joints(self._world, *(ffi.NULL, 0) * 4)
        del self._tables['joints']

    def use(self, **tables: Table) -> None:
        """
        Have the core use tables, each in place of the one of its name.

        :param tables: `motors` in the order of their joints, and in that of their bodies `grips`,
            `forces`, `regions`, `attractors`, `robots` and `actors`; of the structs of `_STRUCTS`
        """
        for name, table in tables.items():
            setattr(self._world, name, pointer(table, _STRUCTS[name]))
            setattr(self._world, f'{name[:-1]}_count', len(table))
            self._tables[name] = (table,)

    def note_moved_static(self) -> None:
        """Note that an anchored body or a wall has been moved."""
        self._world.statics_moved = True

    def use_settings(self, settings: WorldSettings, *, has_fields: bool) -> None:
        """
        Have the core use the force of hands and the constants of attraction.

        :param settings: of the world, which have them
        :param has_fields: whether fields act on the bodies, or velocities lead by them
        """
        self._world.has_fields = has_fields
        self._world.drag_acceleration = settings.drag_force * settings.reference_gravity
        for name in ('gravitation', 'coulomb', 'attraction_power', 'softening'):
            setattr(self._world, name, getattr(settings, name))

    def remove_shapes(self, bodies: Sequence[int]) -> None:
        """
        Remove the shapes of bodies from the engine, outside of a step.

        What touched them is awake then, and may have lost its support.

        :param bodies: addresses of the structs of Chipmunk
        """
        if bodies:
            addresses = np.array(bodies, np.uintp)
            lib.core_remove_shapes(self._world, pointer(addresses, 'cpBody *'), len(bodies))

    # Steps

    def step(self, count: int, *, step: int, age: int, reports_contacts: bool) -> int:
        """
        Make steps.

        :param count: of them
        :param step: count of steps that the world has made
        :param age: count of steps since the space was built; stages that act every n steps count
            by it, so that a space restored from a checkpoint goes on alike
        :return: count of the steps that were made: fewer where a joint breaks, a body is lost, or
            the time of a call is over
        """
        world = self._world
        world.step, world.age, world.reports_contacts = step, age, reports_contacts
        made: int = lib.core_step(world, count)
        return made

    @property
    def is_within_step(self) -> bool:
        """Return whether a step is begun and not ended, which the next call goes on with."""
        return bool(self._world.within_step)

    @property
    def has_lost(self) -> bool:
        """Return whether a body has left the range of numbers in the last step."""
        return bool(self._world.has_lost)

    @property
    def swept(self) -> int:
        """Return the count of pairs whose time of impact was looked for until now."""
        return int(self._world.swept)

    @property
    def has_broken(self) -> bool:
        """Return whether a joint has broken in the last step."""
        return bool(self._world.has_broken)

    # State

    def read_state(self) -> tuple[Floats, Flags, Flags]:
        """
        Return the state that the next step begins with, after all requests until now.

        :return: (n, 6) float64: poses and velocities of the engine's origins; (n,) bool: in free
            flight, so that the velocity leads; (n,) bool: falls since its support was removed
        """
        count = self._count
        state = np.zeros((count, 6))
        free, unsupported = np.zeros((2, count), np.bool_)
        flags = pointer(free, 'uint8_t'), pointer(unsupported, 'uint8_t')
        lib.core_read_state(self._world, pointer(state, 'Motion'), *flags)
        return state, free, unsupported

    def write_state(self, state: Floats) -> None:
        """Set the poses and velocities of all bodies, (n, 6) float64; no body may sleep."""
        state = np.ascontiguousarray(state)
        lib.core_write_state(self._world, pointer(state, 'Motion'))

    def observe(self) -> tuple[Floats, Floats]:
        """
        Return poses of the bodies' origins and true velocities of their centres of mass.

        :return: (n, 3) float64 each: x, y [m], yaw [rad]; velocity [m/s], spin [rad/s]
        """
        poses, twists = np.zeros((2, self._count, 3))
        lib.core_observe(self._world, pointer(poses, 'Pose'), pointer(twists, 'Twist'))
        return poses, twists

    # Joints

    def read_impulses(self) -> Floats:
        """Return (p, 2) float64: impulses from which the next step starts, of all constraints."""
        impulses = np.zeros((self._world.part_count, 2))
        lib.core_read_impulses(self._world, pointer(impulses, 'cpVect'))
        return impulses

    def write_impulses(self, impulses: Floats) -> None:
        """Set (p, 2) float64: impulses from which the next step starts, of all constraints."""
        impulses = np.ascontiguousarray(impulses)
        lib.core_write_impulses(self._world, pointer(impulses, 'cpVect'))

    def read_joints(self) -> tuple[Floats, Floats, Flags]:
        """
        Return what joints did in the last step.

        :return: (j,) float64: greatest impulse of a constraint [N s, N m s]; (j, 2) float64:
            linear impulse on the second body [N s]; (j,) bool: pushed its bodies apart
        """
        count = self._world.joint_count
        impulses, pulls = np.zeros(count), np.zeros((count, 2))
        pressing = np.zeros(count, np.bool_)
        lib.core_read_joints(
            self._world,
            pointer(impulses, 'double'),
            pointer(pulls, 'cpVect'),
            pointer(pressing, 'uint8_t'),
        )
        return impulses, pulls, pressing

    # Contacts

    def take_contacts(self) -> tuple[Table, Table, int]:
        """
        Return the contacts since the last call, and begin the next sums.

        :return: (m,) `Contact`; (k,) `Begun`; count of steps
        """
        world = self._world
        lib.core_take_contacts(world)
        contacts = _copy(world.contacts, world.contact_count, _CONTACT)
        begun = _copy(world.begun, world.begun_count, _BEGUN)
        steps: int = world.reported_steps
        lib.core_clear_contacts(world)
        return contacts, begun, steps

    def clear_contacts(self) -> None:
        """Drop the sums since the last call of `take_contacts`."""
        lib.core_clear_contacts(self._world)

    def copy_contacts(self, old: CoreWorld) -> None:
        """Continue with the sums of a world of the same bodies."""
        lib.core_copy_contacts(self._world, old._world)

    @property
    def _count(self) -> int:
        """Return the count of bodies, without the background."""
        return int(self._world.body_count) - 1


@cache
def _chipmunk() -> Any:
    """Return the functions of Chipmunk that the core calls, in Pymunk's own library."""
    functions = ffi.new('Chipmunk *')
    kinds = dict(ffi.typeof('Chipmunk').fields)
    for field, name in _FUNCTIONS.items():
        address = int(pymunk_ffi.cast('uintptr_t', pymunk_ffi.addressof(pymunk_lib, name)))
        setattr(functions, field, ffi.cast(kinds[field].type, address))
    return functions[0]


def _pointer_and_count(table: Table, kind: str) -> tuple[Any, int]:
    return pointer(table, kind), len(table)


def copy_of(table: Table) -> Table:
    """Return a copy of a table; NumPy's own takes 20 µs, since it goes through the fields."""
    return np.frombuffer(bytearray(table.tobytes()), table.dtype)


def _copy(memory: Any, count: int, dtype: np.dtype[np.void]) -> Table:
    """Return a copy of values in the memory of the core."""
    if not count:
        return np.empty(0, dtype)
    return np.frombuffer(bytearray(ffi.buffer(memory, count * dtype.itemsize)), dtype)
