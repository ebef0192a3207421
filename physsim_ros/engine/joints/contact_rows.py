# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The contacts of jointed bodies as constraint rows, read from the engine after its step.

A row of a contact point is the velocity, or way, of the second body against the first along the
normal, which points from the first to the second; a second row is that across it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.graph_search import Rows
from physsim_ros.engine.joints.rows import across, along, dot
from physsim_ros.engine.memory import (
    ARBITERS,
    follow,
    integers,
    NUMBERS,
    SHAPE_NUMBER,
    vectors,
    words,
)
from physsim_ros.model.arrays import Floats, Ints
from pymunk._chipmunk_cffi import ffi


def _places(struct: str, *names: str) -> list[int]:
    """Return the places of fields of a struct, in words."""
    return [ffi.offsetof(struct, name) // 8 for name in names]


(
    _FRICTION,
    _SURFACE,
    _SHAPE_A,
    _SHAPE_B,
    _BODY_A,
    _BODY_B,
    _THREAD_A,
    _THREAD_B,
    _CONTACTS,
    _NORMAL,
) = _places(
    'struct cpArbiter',
    *('u', 'surface_vr', 'a', 'b', 'body_a', 'body_b', 'thread_a', 'thread_b', 'contacts', 'n'),
)
_COUNT = ffi.offsetof('struct cpArbiter', 'count')
_ARM_A, _ARM_B, _BOUNCE, _ALONG, _ACROSS, _BIAS = _places(
    'struct cpContact', 'r1', 'r2', 'bounce', 'jnAcc', 'jtAcc', 'jBias'
)
_SIZE = ffi.sizeof('struct cpContact') // 8


class ContactRows(NamedTuple):
    """
    Points in which jointed bodies touch others, or each other.

    :ivar points: (c,) int64: index of each `cpContact` in the engine's memory
    :ivar ends: (c, 2) intp: rows of the two bodies in the body table
    :ivar normals: (c, 2, 3) float64: J of the velocity along the normal
    :ivar tangents: (c, 2, 3) float64: J of the velocity across it
    :ivar friction: (c,) float64: coefficient of the pair
    :ivar slide: (c,) float64: velocity across of the surfaces against their bodies [m/s]
    :ivar distance: (c,) float64: of the second body from the first, < 0 where they overlap [m]
    """

    points: Ints
    ends: Rows
    normals: Floats
    tangents: Floats
    friction: Floats
    slide: Floats
    distance: Floats

    def __len__(self) -> int:
        return len(self.points)

    @property
    def bounce(self) -> Floats:
        """Return (c,) float64: least velocity along the normal that the engine seeks [m/s]."""
        return -NUMBERS[self.points + _BOUNCE]

    @property
    def impulses(self) -> tuple[Floats, Floats]:
        """Return (c,) float64 each: impulses along and across the normal [N s]."""
        return NUMBERS[self.points + _ALONG], NUMBERS[self.points + _ACROSS]

    @property
    def bias(self) -> Floats:
        """Return (c,) float64: impulses by which the engine pushes them out [N s]."""
        return NUMBERS[self.points + _BIAS]

    def write_impulses(self, normal: Floats, tangent: Floats) -> None:
        """Set the impulses along and across the normal, (c,) float64 each [N s]."""
        NUMBERS[self.points + _ALONG], NUMBERS[self.points + _ACROSS] = normal, tangent


def read_contacts(table: BodyTable, jointed: Rows) -> ContactRows:
    """
    Return the contacts of some bodies, in an order that depends on bodies and places alone.

    :param jointed: (k,) intp: rows of the bodies in the table
    """
    arbiters = _arbiters_of(table.memory[jointed])
    if not len(arbiters):
        return _NONE
    counts = integers(arbiters, _COUNT)
    arbiters = np.repeat(arbiters, counts)
    place = np.arange(len(arbiters)) - np.repeat(np.cumsum(counts) - counts, counts)
    points = follow(arbiters + _CONTACTS) + place * _SIZE
    bodies = [follow(arbiters + body) for body in (_BODY_A, _BODY_B)]
    ends = np.stack([table.rows_in_memory(each) for each in bodies], axis=1)
    arms = vectors(points + _ARM_A), vectors(points + _ARM_B)
    # By bodies, shapes and points: a disc can touch two segments of a chain in one point.
    shapes = [words(follow(arbiters + shape) + SHAPE_NUMBER) for shape in (_SHAPE_A, _SHAPE_B)]
    order = np.lexsort((*arms[0].T, *shapes, *ends.T))
    arbiters, points, ends = arbiters[order], points[order], ends[order]
    arm_a, arm_b = (arm[order] for arm in arms)
    normal = vectors(arbiters + _NORMAL)
    tangent = across(normal)
    state = table.state_with_background
    apart = state[ends[:, 1], :2] + arm_b - (state[ends[:, 0], :2] + arm_a)
    return ContactRows(
        points=points,
        ends=ends,
        normals=along(-normal, arm_a, arm_b).reshape(-1, 2, 3),
        tangents=along(-tangent, arm_a, arm_b).reshape(-1, 2, 3),
        friction=NUMBERS[arbiters + _FRICTION],
        slide=dot(vectors(arbiters + _SURFACE), tangent),
        distance=dot(apart, normal),
    )


def _arbiters_of(bodies: Ints) -> Ints:
    """Return (a,) int64: indices of the `cpArbiter` in the lists of bodies, each of them once."""
    found = [np.empty(0, np.int64)]
    arbiters = follow(bodies + ARBITERS)
    while True:
        listed = arbiters >= 0
        arbiters, bodies = arbiters[listed], bodies[listed]
        if not len(arbiters):
            return np.unique(np.concatenate(found))
        found.append(arbiters)
        first = follow(arbiters + _BODY_A) == bodies
        arbiters = follow(arbiters + np.where(first, _THREAD_A, _THREAD_B))


_NONE = ContactRows(
    points=np.empty(0, np.int64),
    ends=np.empty((0, 2), np.intp),
    normals=np.empty((0, 2, 3)),
    tangents=np.empty((0, 2, 3)),
    friction=np.empty(0),
    slide=np.empty(0),
    distance=np.empty(0),
)
