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
from physsim_ros.engine import memory
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.graph_search import ranges, Rows
from physsim_ros.engine.joints.constraint_rows import across, along
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.transform import dots


class ContactRows(NamedTuple):
    """
    Points in which jointed bodies touch others, or each other.

    :ivar points: (c,) int64: places of `cpContact`
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
        return -memory.read_numbers(self.points, memory.CONTACT_BOUNCE)

    @property
    def impulses(self) -> Floats:
        """Return (2, c) float64: impulses along and across the normal [N s]."""
        return memory.read_numbers(self.points, memory.CONTACT_IMPULSES).T

    @property
    def bias(self) -> Floats:
        """Return (c,) float64: impulses by which the engine pushes them out [N s]."""
        return memory.read_numbers(self.points, memory.CONTACT_BIAS)

    def write_impulses(self, impulses: Floats) -> None:
        """Set the impulses along and across the normal, (2, c) float64 [N s]."""
        memory.write_numbers(self.points, memory.CONTACT_IMPULSES, impulses.T)


NO_CONTACT_ROWS = ContactRows(
    points=np.empty(0, np.int64),
    ends=np.empty((0, 2), np.intp),
    normals=np.empty((0, 2, 3)),
    tangents=np.empty((0, 2, 3)),
    friction=np.empty(0),
    slide=np.empty(0),
    distance=np.empty(0),
)


def read_contacts(table: BodyTable, jointed: Rows) -> ContactRows:
    """
    Return the contacts of some bodies, in an order that depends on bodies and places alone.

    :param jointed: (k,) intp: rows of the bodies in the table
    """
    arbiters = _arbiters_of(table.places[jointed])
    if not len(arbiters):
        return NO_CONTACT_ROWS
    counts = memory.point_counts(arbiters)
    words = memory.read_words(np.repeat(arbiters, counts), memory.ARBITER_WORDS)
    number = ranges(np.zeros_like(counts), counts)
    points = memory.places_in(words[:, memory.ARBITER_CONTACTS]) + number * memory.CONTACT_SIZE
    ends = table.rows_at(memory.places_in(words[:, memory.ARBITER_BODIES]))
    arms = memory.read_numbers(points, memory.CONTACT_ARMS)
    # By bodies, shapes and points: a disc can touch two segments of a chain in one point.
    shapes = memory.places_in(words[:, memory.ARBITER_SHAPES])
    shapes = memory.read_words(shapes, memory.SHAPE_NUMBER)
    order = np.lexsort((*arms[:, :2].T, *shapes.T, *ends.T))
    points, ends, arms, numbers = points[order], ends[order], arms[order], words[order].view(float)
    arm_a, arm_b, normal = arms[:, :2], arms[:, 2:], numbers[:, memory.ARBITER_NORMAL]
    tangent = across(normal)
    state = table.state_with_background
    apart = state[ends[:, 1], :2] + arm_b - (state[ends[:, 0], :2] + arm_a)
    return ContactRows(
        points=points,
        ends=ends,
        normals=along(-normal, arm_a, arm_b).reshape(-1, 2, 3),
        tangents=along(-tangent, arm_a, arm_b).reshape(-1, 2, 3),
        friction=numbers[:, memory.ARBITER_FRICTION],
        slide=dots(numbers[:, memory.ARBITER_SURFACE], tangent),
        distance=dots(apart, normal),
    )


def _arbiters_of(bodies: Ints) -> Ints:
    """Return (a,) int64: places of the `cpArbiter` in the lists of bodies, each of them once."""
    found = []
    arbiters = memory.places_in(memory.read_words(bodies, memory.BODY_ARBITERS))
    while np.count_nonzero(listed := arbiters >= 0):
        arbiters, bodies = arbiters[listed], bodies[listed]
        found.append(arbiters)
        is_second = (memory.bodies_of(arbiters)[:, 1] == bodies).astype(np.intp)
        following = arbiters + memory.ARBITER_NEXT[is_second]
        arbiters = memory.places_in(memory.read_words(following, 0))
    return np.unique(np.concatenate(found)) if found else bodies[:0]
