# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Contact normal at impact: discs part along the normal that they have where they first touch.

**Problem.** The engine finds a contact where the step ends. Until then the line of centres of two
discs has turned, by v dt / (2 r) at most: by 9 degrees for billiard balls at 4 m/s. A disc that
hits a corner has come past it.

**Method.** The way of the disc in the step, as the other body sees it, is a line. Where a circle
of its radius first meets the other shape on that is a query of the engine
(`cpShapeSegmentQuery`; Ericson, Real-Time Collision Detection, 5.5.7). The contact gets the normal
and the arms of that moment. Pairs that overlap where the step begins keep that of the engine, and
so do polygons among themselves, and segments, of which it knows the neighbours in a chain.

**Cost.** Some 20 us for each disc that begins to touch.

Without it law 6 (discs part along the normal of their impact, from discs and from corners) fails.
"""

from __future__ import annotations

from physsim_ros.engine.contacts.contact import Contact, ContactPoint
from physsim_ros.engine.contacts.side import Side
from physsim_ros.engine.plane_vectors import coordinates, dot, rotation
from physsim_ros.engine.step_context import StepContext
from pymunk import Circle, Segment

# Origin of a shape in the world [m], and its angle [rad].
_Place = tuple[complex, float]


def contact_at_impact(
    contact: Contact, sides: tuple[Side, Side], context: StepContext
) -> Contact | None:
    """
    Return the contact of two shapes that begin to touch as it is at their impact.

    :param contact: of the engine, where the step ends
    :return: None leaves that
    """
    a, b = sides
    disc, other, sign = (a, b, -1.0) if isinstance(a.shape, Circle) else (b, a, 1.0)
    if not isinstance(disc.shape, Circle) or isinstance(other.shape, Segment):
        return None
    if _overlapped(contact, sides, context.dt):
        return None
    (start, _), (stop, _), (center, _) = _places(disc, context)
    (begin, begin_yaw), (end, end_yaw), (now, yaw) = _places(other, context)
    hit = other.shape.segment_query(
        coordinates(now + (start - begin) * rotation(yaw - begin_yaw)),
        coordinates(now + (stop - end) * rotation(yaw - end_yaw)),
        disc.shape.radius,
    )
    if hit is None or hit.alpha == 0.0:
        return None
    # From the yaw that the other shape has now to that of the impact.
    turn = rotation(begin_yaw + (end_yaw - begin_yaw) * hit.alpha - yaw)
    outwards = complex(*hit.normal) * turn
    on_disc = center - outwards * disc.shape.radius
    on_other = now + (complex(*hit.point) - now) * turn
    place_a, place_b = (on_disc, on_other) if disc is a else (on_other, on_disc)
    normal = outwards * sign
    return Contact(normal, (ContactPoint(place_a, place_b, dot(place_b - place_a, normal)),))


def _overlapped(contact: Contact, sides: tuple[Side, Side], dt: float) -> bool:
    """Return whether a contact is deeper than the two bodies can have approached in a step."""
    (point,) = contact.points
    way = 0.0
    for side in sides:
        way += (abs(side.velocity) + abs(side.spin) * abs(point.a - side.position)) * dt
    return -point.distance > way


def _places(side: Side, context: StepContext) -> tuple[_Place, _Place, _Place]:
    """Return where a shape is as the step begins, where it would end freely, and where it is."""
    now, row, dt = (side.position, side.yaw), context.table.row_of(side.body), context.dt
    begin = end = now
    if row is not None:
        (x, y, yaw), (vx, vy, spin) = context.poses[row].tolist(), context.twists[row].tolist()
        begin, end = (complex(x, y), yaw), (complex(x + vx * dt, y + vy * dt), yaw + spin * dt)
    if not isinstance(side.shape, Circle):
        return begin, end, now
    # The place of a disc is its centre; that it turns does not matter.
    offset = complex(*side.shape.offset)
    first, second, third = (
        (position + offset * rotation(yaw), 0.0) for position, yaw in (begin, end, now)
    )
    return first, second, third
