# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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

**Cost.** Some 50 us for each disc that begins to touch.

Without it law 6 (discs part along the normal of their impact, from discs and from corners) fails.
"""

from __future__ import annotations

from typing import NamedTuple

from physsim_ros.engine.shape_pair import body_of, ShapePair
from physsim_ros.engine.step_context import StepContext
import pymunk
from pymunk import Circle, Vec2d


class _Place(NamedTuple):
    """Origin of a shape [m], and its angle [rad]; of a disc its centre, since it does not turn."""

    origin: Vec2d
    yaw: float


def contact_at_impact(
    contact: pymunk.ContactPointSet, shapes: ShapePair, context: StepContext
) -> pymunk.ContactPointSet | None:
    """
    Return the contact of two shapes that begin to touch as it is at their impact.

    :param contact: of the engine, where the step ends
    :return: None leaves that
    """
    a, b = shapes
    disc, other, sign = (a, b, -1.0) if isinstance(a, Circle) else (b, a, 1.0)
    if not isinstance(disc, Circle) or isinstance(other, pymunk.Segment):
        return None
    if _overlapped(contact, shapes, context.dt):
        return None
    start, stop, center = (place.origin for place in _places(disc, context))
    begin, end, now = _places(other, context)
    hit = other.segment_query(
        now.origin + (start - begin.origin).rotated(now.yaw - begin.yaw),
        now.origin + (stop - end.origin).rotated(now.yaw - end.yaw),
        disc.radius,
    )
    if hit is None or hit.alpha == 0.0:
        return None
    # From the yaw that the other shape has now to that of the impact.
    turn = begin.yaw + (end.yaw - begin.yaw) * hit.alpha - now.yaw
    outwards = hit.normal.rotated(turn)
    arms = center - outwards * disc.radius, now.origin + (hit.point - now.origin).rotated(turn)
    (point_a, point_b), normal = arms if disc is a else arms[::-1], outwards * sign
    point = pymunk.ContactPoint(point_a, point_b, (point_b - point_a).dot(normal))
    return pymunk.ContactPointSet(normal, (point,))


def _overlapped(contact: pymunk.ContactPointSet, shapes: ShapePair, dt: float) -> bool:
    """Return whether a contact is deeper than the two bodies can have approached in a step."""
    (point,) = contact.points
    way = 0.0
    for shape in shapes:
        body = body_of(shape)
        arm = point.point_a.get_distance(body.position)
        way += (body.velocity.length + abs(body.angular_velocity) * arm) * dt
    return -point.distance > way


def _places(shape: pymunk.Shape, context: StepContext) -> tuple[_Place, _Place, _Place]:
    """Return where a shape is as the step begins, where it would end freely, and where it is."""
    body, dt = body_of(shape), context.dt
    now = _place(shape, body.position, body.angle)
    row = context.table.row_of(body)
    if row is None:
        return now, now, now
    (x, y, yaw), (vx, vy, spin) = context.poses[row].tolist(), context.twists[row].tolist()
    begin = _place(shape, Vec2d(x, y), yaw)
    return begin, _place(shape, Vec2d(x + vx * dt, y + vy * dt), yaw + spin * dt), now


def _place(shape: pymunk.Shape, position: Vec2d, yaw: float) -> _Place:
    """Return the place of a shape on a body."""
    if isinstance(shape, Circle):
        return _Place(position + shape.offset.rotated(yaw), 0.0)
    return _Place(position, yaw)
