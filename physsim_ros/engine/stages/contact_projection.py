# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Contact projection: at a first touch, bodies are set back by what they overshot in the step.

The engine finds a contact where the step ends, up to a safe depth inside, and its position bias
takes many steps to push that out; law 7 bounds the overlap to 10 mm. The overlap beyond the slop
is taken back along the normal, by no more than the pair approached in this step, and shared by
inverse mass, so that the common centre of mass stays (Müller et al. 2007, Position Based Dynamics,
3.3). A fixed body gives nothing.

Cost: one callback for each contact that begins, and 1 us for each piece of the two bodies, of
which a body has a budget in a step: two lists of 1,000 spheres that meet would take that for a
million. The engine's own bias holds for what is left.
"""

from __future__ import annotations

from collections import Counter
import math

from physsim_ros.engine.contacts.contact import Contact
from physsim_ros.engine.contacts.side import Side
from physsim_ros.engine.plane_vectors import coordinates, dot
from physsim_ros.engine.tolerances import COLLISION_SLOP
from physsim_ros.engine.work_correction import is_jointed, take_back_work
import pymunk

# Pieces of a body that are placed anew in a step, at most: those of a body of 40 for 100 contacts.
MOST_PIECES = 4000


def project_contact(
    contact: Contact,
    sides: tuple[Side, Side],
    space: pymunk.Space,
    placed: Counter[pymunk.Body],
) -> None:
    """
    Set two bodies apart that touch for the first time, along the contact normal.

    :param placed: pieces of each body that were placed anew in this step
    """
    point = min(contact.points, key=lambda point: point.distance)
    if -point.distance <= COLLISION_SLOP:
        return
    if any(placed[side.body] >= MOST_PIECES for side in sides):
        return
    dt, (a, b) = space.current_time_step, sides
    ahead = (
        dot(a.velocity_at(point.a), contact.normal) * dt,
        -dot(b.velocity_at(point.b), contact.normal) * dt,
    )
    excess = min(-point.distance - COLLISION_SLOP, sum(ahead))
    if excess <= 0.0:
        return
    inverse = [1.0 / side.body.mass if _may_move(side.body) else 0.0 for side in sides]
    if not any(inverse):
        return
    jointed = any(is_jointed(space, side.body) for side in sides)
    for side, sign, own, share in zip(sides, (1.0, -1.0), ahead, inverse, strict=True):
        if not share:
            continue
        body, back = side.body, excess * share / sum(inverse)
        body.position = coordinates(side.position - contact.normal * sign * back)
        if not jointed:
            # Its own share only: the rest of the way is that of the other body.
            own_back = math.copysign(min(back, max(own, 0.0)), -sign)
            take_back_work(space, body, contact.normal * own_back, dt)
        # Further shapes of it, and further contacts, are found where it is now.
        for shape in body.shapes:
            shape.cache_bb()
            placed[body] += 1


def _may_move(body: pymunk.Body) -> bool:
    """
    Return whether a body may be set back in the middle of a step.

    A sleeping one may not: Chipmunk (Munk2D as in Pymunk 7.3.1) wakes a body whose position is
    set, and `cpSpaceActivateBody` in the middle of a step threads its arbiters twice, so that
    `cpSpaceProcessComponents` never ends. It wakes by itself after this contact.
    """
    return body.body_type == pymunk.Body.DYNAMIC and not body.is_sleeping
