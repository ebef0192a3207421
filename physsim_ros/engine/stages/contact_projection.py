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
Contact projection: at a first touch, bodies are set back by what they overshot in the step.

The engine finds a contact where the step ends, up to a safe depth inside, and its position bias
takes many steps to push that out; law 7 bounds the overlap to 10 mm. The overlap beyond the slop
is taken back along the normal, by no more than the pair approached in this step, and shared by
inverse mass, so that the common centre of mass stays (Müller et al. 2007, Position Based Dynamics,
3.3). A fixed body gives nothing.

Where the step ends, the line of centres of two discs has turned, by v dt / (2 r) at most, and with
it the direction in which they part: by 9° for billiard balls at 4 m/s. Discs get the normal that
they have at their time of impact, the root of a quadratic (Ericson, Real-Time Collision Detection,
5.5.5). Cost: one callback for each contact that begins, and 1 us for each piece of the two bodies,
of which a body has a budget in a step: two lists of 1,000 spheres that meet would take that for a
million. The engine's own bias holds for what is left.
"""

from __future__ import annotations

from collections import Counter
import math

import numpy as np
from physsim_ros.engine.ccd.time_of_impact import SLOP
from physsim_ros.engine.step_context import StepContext
from physsim_ros.engine.work_correction import is_jointed, take_back_work
import pymunk
from pymunk import Circle, Vec2d


def contact_at_impact(arbiter: pymunk.Arbiter, context: StepContext) -> pymunk.ContactPointSet:
    """
    Return the contact of two shapes that begin to touch; that of two discs is set in the engine.

    Its normal is the line of centres at the time of impact, and the depth is along that.
    """
    contact, (disc_a, disc_b) = arbiter.contact_point_set, arbiter.shapes
    if not (contact.points and isinstance(disc_a, Circle) and isinstance(disc_b, Circle)):
        return contact
    body_a, body_b = arbiter.bodies
    rows = context.table.rows_of(np.array((body_a.id, body_b.id), np.uint64))
    row_a, row_b = rows.tolist()
    from_a, move_a = _way(disc_a.offset, context, row_a)
    from_b, move_b = _way(disc_b.offset, context, row_b)
    apart, move = from_b - from_a, move_b - move_a
    reach = disc_a.radius + disc_b.radius
    # The first root of |apart + share * move|² = reach².
    length, along, gap = move.dot(move), apart.dot(move), apart.dot(apart) - reach * reach
    root = along * along - length * gap
    if along >= 0.0 or gap < 0.0 or root < 0.0:
        return contact
    share = (-along - math.sqrt(root)) / length
    if share > 1.0:
        return contact
    normal = (apart + move * share) / reach
    point_a = body_a.local_to_world(disc_a.offset) + normal * disc_a.radius
    point_b = body_b.local_to_world(disc_b.offset) - normal * disc_b.radius
    point = pymunk.ContactPoint(point_a, point_b, (point_b - point_a).dot(normal))
    contact = pymunk.ContactPointSet(normal, (point,))
    arbiter.contact_point_set = contact
    return contact


def _way(center: Vec2d, context: StepContext, row: int) -> tuple[Vec2d, Vec2d]:
    """
    Return where a point of a body is as the step begins, and its way in the step [m].

    :param center: of a disc, in the frame of the engine's body [m]
    """
    x, y, yaw = context.poses[row].tolist()
    vx, vy, spin = context.twists[row].tolist()
    arm = center.rotated(yaw)
    velocity = Vec2d(vx, vy) + arm.perpendicular() * spin
    return Vec2d(x, y) + arm, velocity * context.dt


# Pieces of a body that are placed anew in a step, at most: those of a body of 40 for 100 contacts.
MOST_PIECES = 4000


def project_contact(
    arbiter: pymunk.Arbiter,
    contact: pymunk.ContactPointSet,
    space: pymunk.Space,
    placed: Counter[pymunk.Body],
) -> None:
    """
    Set two bodies apart that touch for the first time, along the contact normal.

    :param placed: pieces of each body that were placed anew in this step
    """
    point = min(contact.points, key=lambda point: point.distance, default=None)
    if point is None or -point.distance <= SLOP or any(it.sensor for it in arbiter.shapes):
        return
    if any(placed[body] >= MOST_PIECES for body in arbiter.bodies):
        return
    dt, normal = space.current_time_step, contact.normal
    sides = tuple(zip(arbiter.bodies, (1.0, -1.0), (point.point_a, point.point_b), strict=True))
    ahead = [
        sign * body.velocity_at_world_point(place).dot(normal) * dt for body, sign, place in sides
    ]
    inverse = [1.0 / body.mass if _may_move(body) else 0.0 for body, _, _ in sides]
    excess = min(-point.distance - SLOP, sum(ahead))
    if excess <= 0.0 or not any(inverse):
        return
    jointed = any(is_jointed(space, body) for body, _, _ in sides)
    for (body, sign, _), own, share in zip(sides, ahead, inverse, strict=True):
        if not share:
            continue
        back = excess * share / sum(inverse)
        body.position -= normal * sign * back
        if not jointed:
            # Its own share only: the rest of the way is that of the other body.
            own_back = math.copysign(min(back, max(own, 0.0)), -sign)
            take_back_work(space, body, normal * own_back, dt)
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
