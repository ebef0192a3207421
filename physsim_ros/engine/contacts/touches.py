# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Touches: contacts that begin, their shapes and bodies, as arrays in the middle of a step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.engine import memory
from physsim_ros.engine.batch_io import Ids
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.transform import cross, dots
import pymunk

# Number of the second point of a contact.
_BOTH = np.array((0, 1))


class Touches(NamedTuple):
    """
    Contacts that begin in this step; their normals and places are corrected in these arrays.

    Arrays of both sides begin with an axis of two, the engine's first shape and its second one.

    :ivar arbiters: (k,) places of `cpArbiter`
    :ivar points: (k, 2) places of `cpContact`; the second is the first where there is but one
    :ivar counts: (k,) of points
    :ivar normals: (k, 2) from the first shape to the second
    :ivar places: (2, k, 2, 2): of both points on either body [m]
    :ivar bodies: (2, k) places of `cpBody`
    :ivar ids: (k, 2) uint64: the engine's ids of the bodies
    :ivar rows: (2, k): of the bodies in the table
    :ivar states: (2, k, 24): numbers of `cpBody`
    :ivar shapes: their shapes
    """

    arbiters: Ints
    points: Ints
    counts: Ints
    normals: Floats
    places: Floats
    bodies: Ints
    ids: Ids
    rows: Ints
    states: Floats
    shapes: Shapes

    @property
    def distances(self) -> Floats:
        """Return (k, 2): of the points along the normal, < 0 where the shapes overlap [m]."""
        return dots(self.places[1] - self.places[0], self.normals[:, None])


class Shapes(NamedTuple):
    """
    The shapes of contacts, where the step ends; v corners, the last of each repeated.

    :ivar kinds: (2, k)
    :ivar boxes: (2, k, 4): left, bottom, right, top [m]
    :ivar radii: (2, k): of discs, and of the rounding of others [m]
    :ivar corners: (2, k, v, 2): the centre of a disc [m]
    :ivar begins: (2, k, v, 2): the corner before each, where the face begins that ends there [m]
    :ivar normals: (2, k, v, 2): outwards of that face; 0 of a disc
    :ivar offsets: (2, k, 2): of a disc's centre in its body's frame, 0 of others [m]
    """

    kinds: Ints
    boxes: Floats
    radii: Floats
    corners: Floats
    begins: Floats
    normals: Floats
    offsets: Floats


def read_touches(table: BodyTable, arbiters: Ints) -> Touches:
    """Return contacts by their places, with their shapes and bodies."""
    words = memory.read_words(arbiters, memory.ARBITER_WORDS)
    counts = memory.point_counts(arbiters)
    points = memory.places_in(words[:, memory.ARBITER_CONTACTS, None])
    points = points + memory.CONTACT_SIZE * (_BOTH & (counts[:, None] > 1))
    arms = memory.read_numbers(points, memory.CONTACT_ARMS)
    bodies = memory.places_in(words[:, memory.ARBITER_BODIES].T)
    states = memory.read_numbers(bodies, memory.BODY_WORDS)
    ids = states.view(np.uint64)[..., memory.BODY_ID]
    places = np.empty((2, *points.shape, 2))
    places[0], places[1] = arms[..., :2], arms[..., 2:]
    places += states[:, :, None, memory.BODY_POSITION]
    return Touches(
        arbiters=arbiters,
        points=points,
        counts=counts,
        normals=words.view(np.float64)[:, memory.ARBITER_NORMAL],
        places=places,
        bodies=bodies,
        ids=ids.T,
        rows=table.rows_of(ids),
        states=states,
        shapes=_read_shapes(memory.places_in(words[:, memory.ARBITER_SHAPES].T)),
    )


def _read_shapes(shapes: Ints) -> Shapes:
    """Return shapes by their places, (2, k)."""
    numbers = memory.read_numbers(shapes, memory.SHAPE_WORDS)
    kinds = memory.shape_kinds(shapes)
    first, size, count = memory.corner_places(shapes, kinds)
    last = np.minimum(np.arange(count.max()), count[..., None] - 1)
    before = (last - 1) % count[..., None]
    places, before = (first[..., None] + size[..., None] * each for each in (last, before))
    corners = memory.read_numbers(places, memory.VECTOR)
    normals, polygons = np.zeros(corners.shape), kinds == memory.POLYGON
    normals[polygons] = memory.read_numbers(places[polygons] + 2, memory.VECTOR)
    segments = kinds == memory.SEGMENT
    if segments.any():
        ahead = memory.read_numbers(shapes[segments] + memory.SEGMENT_NORMAL, memory.VECTOR)
        normals[segments] = ahead[:, None]
        normals[segments, 0] *= -1.0
    return Shapes(
        kinds=kinds,
        boxes=numbers[..., memory.SHAPE_BOX],
        radii=memory.shape_radii(shapes, kinds),
        corners=corners,
        begins=memory.read_numbers(before, memory.VECTOR),
        normals=normals,
        offsets=numbers[..., memory.CIRCLE_OFFSET] * (kinds == memory.CIRCLE)[..., None],
    )


def velocities_at(touches: Touches, arms: Floats) -> Floats:
    """
    Return (2, k, ..., 2): the velocities of points on both bodies of contacts [m/s].

    :param arms: (2, k, 2), or (2, k, p, 2) for p points of each: from the bodies [m]
    """
    states = touches.states
    if arms.ndim == 4:
        states = states[:, :, None]
    velocities = np.empty(arms.shape)
    spins = states[..., memory.BODY_SPIN]
    velocities[..., 0] = states[..., memory.BODY_VELOCITY.start] - spins * arms[..., 1]
    velocities[..., 1] = states[..., memory.BODY_VELOCITY.start + 1] + spins * arms[..., 0]
    return velocities


def prepare_contacts(pm_space: pymunk.Space, arbiters: Ints) -> None:
    """
    Make effective masses, bias and bounce of contacts anew, as `cpArbiterPreStep` does.

    Chipmunk makes them before the stages in the middle of a step can change a contact.

    :param arbiters: (k,) places of `cpArbiter`
    """
    words = memory.read_words(arbiters, memory.ARBITER_WORDS)
    # All points, contact after contact.
    counts = memory.point_counts(arbiters)
    each = np.repeat(np.arange(len(arbiters)), counts)
    words, second = words[each], np.append(False, each[1:] == each[:-1])[: len(each)]
    points = memory.places_in(words[:, memory.ARBITER_CONTACTS]) + memory.CONTACT_SIZE * second
    arms = memory.read_numbers(points, memory.CONTACT_ARMS)
    bodies = memory.places_in(words[:, memory.ARBITER_BODIES].T)
    a, b = memory.read_numbers(bodies, memory.BODY_WORDS)
    numbers = words.view(np.float64)
    normals = numbers[:, memory.ARBITER_NORMAL]
    tangents = normals[:, ::-1] * (-1.0, 1.0)
    gaps, parting = np.zeros((2, len(each)))
    inverse = np.zeros((2, len(each)))
    for body, arm, sign in ((a, arms[:, :2], -1.0), (b, arms[:, 2:], 1.0)):
        levers = np.stack((cross(arm, normals), cross(arm, tangents)))
        turns = body[:, memory.BODY_INVERSE_MOMENT] * levers**2
        inverse += body[:, memory.BODY_INVERSE_MASS] + turns
        gaps += sign * dots(body[:, memory.BODY_POSITION] + arm, normals)
        speed = dots(body[:, memory.BODY_VELOCITY], normals)
        parting += sign * (speed + body[:, memory.BODY_SPIN] * levers[0])
    share = 1.0 - pm_space.collision_bias**pm_space.current_time_step
    push = share / pm_space.current_time_step
    bias = -push * np.minimum(gaps + pm_space.collision_slop, 0.0)
    bounce = parting * numbers[:, memory.ARBITER_ELASTICITY]
    found = (1.0 / inverse[0], 1.0 / inverse[1], bounce, np.zeros(len(each)), bias)
    memory.write_numbers(points, memory.CONTACT_PREPARED, np.column_stack(found))
