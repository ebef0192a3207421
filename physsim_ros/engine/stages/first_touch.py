# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
First touch: contacts that begin are those of their impact, not of the end of the step.

**Problem.** Chipmunk finds a contact where the step ends, up to a safe depth inside. Until then
the line of centres of two discs has turned, by v dt / (2 r) at most; a disc that hits a corner has
come past it; a body that slides over the seam of two tiles has gone less far past the side of the
next one than it lies below its top ("ghost collision": Catto, Ghost Collisions, box2d.org 2020);
the position bias takes many steps to push out what has been overshot. And its GJK (`GJKRecurse` in
`src/cpCollision.c`) tests with rounded numbers whether the origin is in a triangle: one pair in
ten thousand of polygons that face each other exactly is said to have entered each other from the
far sides, though they are apart.

**Method.** Between the engine's narrow phase and its solver, for all contacts that begin at once:

1. *False contacts*: polygons whose normal points from the second to the first, and which a face
   separates (separating axis theorem; Ericson, Real-Time Collision Detection, 5.2.1). The engine
   ignores the contact in this step, and in the next one takes what it finds for a first touch.
2. *Impact*: the way of a disc in the step, as the other body sees it, is a line. Where a circle of
   its radius first meets the other shape on that (Ericson, 5.5.7), the contact gets the normal and
   the arms of that moment. Pairs that overlap where the step begins keep those of the engine, and
   so do polygons among themselves, and segments, of which it knows the neighbours in a chain.
3. *Internal edges*: a contact at a corner, while a face is entered by no more than the slop and
   under no more than 10 degrees, gets the normal of that face (`btInternalEdgeUtility` in Bullet).
4. *Projection*: the overlap beyond the slop is taken back along the normal, by no more than the
   pair approached in this step, and shared by inverse mass, so that the common centre of mass
   stays (Müller et al. 2007, Position Based Dynamics, 3.3). Of two bodies the deepest contact
   counts. A body that has no joints gets the velocity of the place where it is set back to.
5. What `cpArbiterPreStep` had made of the old contacts is made anew.

**Cost.** Some 0.25 ms in a step in which contacts begin, and 5 us for each of these.

Without part 1 law 3 (head-on impacts of squares) fails; without part 2 laws 6 (discs part along
the normal of their impact) and 35 (a fast bar hits all discs); without part 3 a body stumbles over
seams (`test/engine/stages/test_internal_edges.py`); without part 4 law 7 (penetration). Part 1 can
go when GJK is exact.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine import memory
from physsim_ros.engine.contacts.touches import (
    prepare_contacts,
    read_touches,
    Shapes,
    Touches,
    velocities_at,
)
from physsim_ros.engine.settings import COLLISION_SLOP
from physsim_ros.engine.step_context import StepContext
from physsim_ros.engine.work_correction import are_jointed, corrected_twists
from physsim_ros.model.arrays import Flags, Floats, Ints
from physsim_ros.model.transform import cross, dot, dots, norms, rotated_each
import pymunk

# Distance from a corner within which overlaps of the slop along two faces lie [m]: the diagonal
# of their rhombus, for faces that enclose 30 degrees or more.
_NEAR = 4.0 * COLLISION_SLOP
# Approach by speed up to which a body slides over a face [1]: the sine of 10 degrees.
_GRAZING = 0.17
# Products of corners that are compared at once: some 30 MB.
_PART = 200_000
# Sign of the normal of a contact where it points out of the one and of the other shape.
_OUTWARDS = np.array((1.0, -1.0))


def correct_first_touches(pm_space: pymunk.Space, context: StepContext) -> Touches | None:
    """
    Correct the contacts that begin in this step, between the engine's narrow phase and its solver.

    :return: these; None where there are none
    """
    arbiters = memory.contacts_of_step(pm_space)
    if not len(arbiters):
        return None
    begun = arbiters[memory.begins(arbiters)]
    if not len(begun):
        return None
    memory.begin(begun)
    touches = read_touches(context.table, begun)
    false = find_false(touches)
    if false.any():
        memory.ignore(begun[false])
        if false.all():
            return None
        touches = read_touches(context.table, begun[~false])
    move_to_impact(touches, context)
    slide_over_edges(touches)
    _write(touches)
    moved = project_contacts(touches, context)
    changed = touches.arbiters
    if len(moved):
        touched = np.isin(memory.bodies_of(arbiters), moved).any(axis=1)
        changed = np.union1d(changed, arbiters[touched])
    prepare_contacts(pm_space, changed)
    return touches


def _write(touches: Touches) -> None:
    """Write normals and points of contacts to the engine."""
    normal = memory.ARBITER_WORDS[memory.ARBITER_NORMAL]
    memory.write_numbers(touches.arbiters, normal, touches.normals)
    arms = touches.places - touches.states[:, :, None, memory.BODY_POSITION]
    arms = np.concatenate((arms[0], arms[1]), axis=-1)
    # The second point first: where there is but one, it is a copy of the first.
    for point in (1, 0):
        memory.write_numbers(touches.points[:, point], memory.CONTACT_ARMS, arms[:, point])


def find_false(touches: Touches) -> Flags:
    """Return (k,) bool: contacts of shapes that a face separates, and with their normal turned."""
    shapes = touches.shapes
    centers = shapes.boxes[..., :2] + shapes.boxes[..., 2:]
    false = dots(centers[1] - centers[0], touches.normals) < 0.0
    false &= (shapes.kinds != memory.CIRCLE).all(axis=0)
    if false.any():
        rows = np.flatnonzero(false)
        false[rows] = (face_depths(shapes, rows) < 0.0).any(axis=(0, 2))
    return false


def face_depths(shapes: Shapes, rows: Ints) -> Floats:
    """
    Return (2, m, v) how deep the other shape is behind each face [m].

    :param rows: (m,) of the contacts in question
    """
    corners, normals = shapes.corners[:, rows], shapes.normals[:, rows]
    depths = dots(normals, corners)
    step = max(1, _PART // depths.shape[2] ** 2)
    for first in range(0, len(rows), step):
        part = slice(first, first + step)
        others = dots(normals[:, part, :, None], corners[::-1, part, None])
        depths[:, part] -= others.min(axis=3)
    depths += shapes.radii[:, rows].sum(axis=0)[:, None]
    return depths


def move_to_impact(touches: Touches, context: StepContext) -> None:
    """Replace normals and places of the contacts of discs by those of their impact."""
    shapes, dt = touches.shapes, context.dt
    arms = touches.places[:, :, 0] - touches.states[..., memory.BODY_POSITION]
    velocities = touches.states[..., memory.BODY_VELOCITY]
    ways = norms(velocities) + np.abs(touches.states[..., memory.BODY_SPIN]) * norms(arms)
    # Pairs that are deeper than they can have approached overlapped before.
    discs = -touches.distances[:, 0] <= ways.sum(axis=0) * dt
    # The engine has the disc first.
    discs &= (shapes.kinds[0] == memory.CIRCLE) & (shapes.kinds[1] != memory.SEGMENT)
    rows = np.flatnonzero(discs)
    if not len(rows):
        return
    places, yaws = _moments(touches, rows, context)
    (begin, end, now), radii = places[:, 1], shapes.radii[:, rows]
    # The way of the disc in the frame that the other shape has where the step ends.
    turns = yaws[2] - yaws[:2]
    start, stop = now + rotated_each(places[:2, 0] - (begin, end), turns)
    shares, normals = _first_hits(start, stop, shapes, rows)
    hit = np.isfinite(shares) & (shares > 0.0)
    shares = np.where(hit, shares, 0.0)
    on_other = start + (stop - start) * shares[:, None] - normals * radii[0, :, None]
    # To the yaw of the impact.
    turn = yaws[0] + (yaws[1] - yaws[0]) * shares - yaws[2]
    outwards = rotated_each(normals, turn)
    on_disc = places[2, 0] - outwards * radii[0, :, None]
    on_other = now + rotated_each(on_other - now, turn)
    touches.normals[rows[hit]] = -outwards[hit]
    touches.places[0, rows[hit]], touches.places[1, rows[hit]] = (
        each[hit, None] for each in (on_disc, on_other)
    )


def _moments(touches: Touches, rows: Ints, context: StepContext) -> tuple[Floats, Floats]:
    """
    Return where shapes are as the step begins, where they would end freely, and where they are.

    :return: (3, 2, m, 2) float64: centres of discs and origins of others [m], and (3, m) float64:
        yaws of the second shape, 0 of a disc
    """
    shapes = touches.shapes
    now = touches.states[:, rows][..., memory.BODY_POSE]
    known = touches.rows[:, rows] < len(context.poses)
    table_rows = np.where(known, touches.rows[:, rows], 0)
    begin = np.where(known[..., None], context.poses[table_rows], now)
    twists = np.where(known[..., None], context.twists[table_rows], 0.0)
    poses = np.empty((3, *now.shape))
    poses[0], poses[1], poses[2] = begin, begin + twists * context.dt, now
    places = poses[..., :2] + rotated_each(shapes.offsets[:, rows], poses[..., 2])
    # That a disc turns does not matter.
    return places, np.where(shapes.kinds[1, rows] == memory.CIRCLE, 0.0, poses[:, 1, :, 2])


def _first_hits(start: Floats, stop: Floats, shapes: Shapes, rows: Ints) -> tuple[Floats, Floats]:
    """
    Return where the first of two shapes, a disc, first meets the second on straight ways.

    :param start: (m, 2) float64: centres where the ways begin [m]
    :param stop: (m, 2) float64: where they end [m]
    :return: (m,) shares of the ways, infinite for never; and (m, 2) normals of the second shape
    """
    corners, normals = shapes.corners[1, rows], shapes.normals[1, rows]
    radii, way = shapes.radii[:, rows].sum(axis=0)[:, None], (stop - start)[:, None]
    ahead = start[:, None] - corners
    with np.errstate(divide='ignore'):
        # Faces, moved outwards by the radius: t of n . (ahead + way t) = r, between their corners.
        height = dots(normals, ahead) - radii
        faces = height / -dots(normals, way)
        along = cross(normals, ahead + way * faces[..., None])
        meets = (height >= 0.0) & (faces >= 0.0) & (along <= 0.0)
        meets &= along >= cross(normals, shapes.begins[1, rows] - corners)
        faces[~meets] = np.inf
        # Corners: t of |ahead + way t| = r.
        a, b = dots(way, way), dots(ahead, way)
        points = (-b - np.sqrt(b * b - a * (dots(ahead, ahead) - radii**2))) / a
        points[~(points >= 0.0)] = np.inf
    shares = np.concatenate((faces, points), axis=1)
    shares[~(shares <= 1.0)] = np.inf
    best, number = shares.argmin(axis=1), np.arange(len(rows))
    first = shares[number, best]
    count = faces.shape[1]
    corner = best % count
    outwards = ahead[number, corner] + way[:, 0] * np.where(first <= 1.0, first, 0.0)[:, None]
    outwards /= radii
    outwards[best < count] = normals[number, corner][best < count]
    return first, outwards


def slide_over_edges(touches: Touches) -> None:
    """Replace contacts at seams by those with the face that the shapes approach slowest."""
    shapes, normals = touches.shapes, touches.shapes.normals
    points, reach = touches.places[:, :, :1], (_NEAR + shapes.radii)[..., None]
    near = norms(shapes.corners - points) <= reach
    # At a corner of both; a disc is one.
    rows = np.flatnonzero(near.any(axis=2).all(axis=0) & normals.any(axis=(0, 2, 3)))
    if not len(rows):
        return
    near |= norms(shapes.begins - points) <= reach
    # The spin of a disc does not move its surface along a face.
    discs = shapes.kinds == memory.CIRCLE
    centers = touches.states[..., memory.BODY_POSITION]
    arms = np.where(discs[..., None], shapes.corners[:, :, 0], points[:, :, 0]) - centers
    a, b = velocities_at(touches, arms)[:, rows]
    velocity = b - a
    approach = -dots(velocity, touches.normals[rows])
    slowest = np.minimum(approach, _GRAZING * norms(velocity))[:, None]
    approaches = -dots(normals[:, rows], velocity[:, None]) * _OUTWARDS[:, None, None]
    slides = near[:, rows] & normals[:, rows].any(axis=3) & (approaches < slowest)
    slides &= approach[:, None] > 0.0
    if not slides.any():
        return
    depths = face_depths(shapes, rows)
    slides &= (depths >= 0.0) & (depths <= COLLISION_SLOP)
    approaches = np.concatenate(np.where(slides, approaches, np.inf), axis=1)
    best, chosen = approaches.argmin(axis=1), np.isfinite(approaches.min(axis=1))
    rows, best = rows[chosen], best[chosen]
    side, face = np.divmod(best, normals.shape[2])
    outwards, depth = normals[side, rows, face], depths[side, chosen, face][:, None]
    middles = touches.places[:, rows].sum(axis=0) / 2.0
    # A disc is touched below its centre.
    others = shapes.corners[1 - side, rows, 0] - outwards * shapes.radii[1 - side, rows, None]
    middles = np.where(discs[1 - side, rows, None, None], others[:, None], middles)
    along = outwards * _OUTWARDS[side, None]
    half = (along * depth / 2.0)[:, None]
    touches.normals[rows] = along
    touches.places[0, rows], touches.places[1, rows] = middles + half, middles - half


def project_contacts(touches: Touches, context: StepContext) -> Ints:
    """
    Set bodies apart that touch for the first time, along the normals of their contacts.

    :return: places of the bodies that were moved
    """
    every, distances = np.arange(len(touches.arbiters)), touches.distances
    if not (distances < -COLLISION_SLOP).any():
        return every[:0]
    deepest = distances.argmin(axis=1)
    points = touches.places[:, every, deepest]
    velocities = velocities_at(touches, points - touches.states[..., memory.BODY_POSITION])
    # By how far each body has come towards the other one in the step.
    ahead = dots(velocities, touches.normals) * _OUTWARDS[:, None] * context.dt
    excess = np.minimum(-distances[every, deepest] - COLLISION_SLOP, ahead.sum(axis=0))
    inverse = touches.states[..., memory.BODY_INVERSE_MASS]
    rows = np.flatnonzero((excess > 0.0) & (inverse.sum(axis=0) > 0.0))
    if not len(rows):
        return rows
    # The deepest contact of each two bodies.
    rows = rows[np.argsort(-excess[rows], kind='stable')]
    (low, high), count = np.sort(touches.rows[:, rows], axis=0), len(context.table.ids)
    rows = rows[np.sort(np.unique(low * count + high, return_index=True)[1])]
    _, first, numbers = np.unique(touches.rows[:, rows], return_index=True, return_inverse=True)
    inverse = inverse[:, rows]
    shifts, backs = _set_apart(
        numbers.reshape(2, -1),
        excess[rows],
        touches.normals[rows],
        inverse / inverse.sum(axis=0),
        np.where(are_jointed(context, touches.rows[:, rows]).any(axis=0), 0.0, ahead[:, rows]),
    )
    states = touches.states[:, rows].reshape(-1, touches.states.shape[2])[first]
    places = touches.bodies[:, rows].ravel()[first]
    moved = shifts.any(axis=1)
    shifts, states, places = shifts[moved], states[moved], places[moved]
    twists = corrected_twists(context, states, backs[moved])
    motion = states[:, memory.BODY_MOTION]
    motion[:, :2] += shifts
    motion[:, 2:5] = twists
    motion[:, 5:] += shifts
    memory.write_numbers(places, memory.BODY_MOTION, motion)
    return places


def _set_apart(
    bodies: Ints, excess: Floats, normals: Floats, shares: Floats, ahead: Floats
) -> tuple[Floats, Floats]:
    """
    Return the ways by which bodies are set apart, contact by contact (Gauss-Seidel).

    :param bodies: (2, m): numbers of the bodies of each contact
    :param excess: (m,) by how far each is too deep [m]
    :param normals: (m, 2)
    :param shares: (2, m): of each body in that
    :param ahead: (2, m): by how far each body may be set back against what moves it [m]
    :return: (b, 2): of each body; and (b, 2): the part that is its own way of the step [m]
    """
    shifts, backs = ([0j] * (int(bodies.max()) + 1) for _ in range(2))
    columns = (
        bodies.T.tolist(),
        excess.tolist(),
        normals.view(np.complex128).ravel().tolist(),
        shares.T.tolist(),
        ahead.T.tolist(),
    )
    for pair, deep, normal, part, own in zip(*columns, strict=True):
        left = deep - dot(shifts[pair[1]] - shifts[pair[0]], normal)
        if left <= 0.0:
            continue
        for body, share, way, sign in zip(pair, part, own, (-1.0, 1.0), strict=True):
            shifts[body] += normal * (sign * left * share)
            # The rest of the way is that of the other body.
            backs[body] += normal * (sign * min(left * share, max(way, 0.0)))
    moved, against = (np.array(each).view(np.float64).reshape(-1, 2) for each in (shifts, backs))
    return moved, against
