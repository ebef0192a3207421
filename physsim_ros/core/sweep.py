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
Fast bodies: the engine looks only at where a step ends, this looks at the way there.

Law: a body that moves more than half of its own inner radius a step is swept along its way first;
where it would touch something, the step ends there. The engine then finds the contact and
resolves it with the full velocity. What a slower body overshoots at a first touch is taken back in
`relieve`. Neither changes a velocity.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.core.rigid_body import RigidBody
import pymunk

# A body that moves less than this share of its inner radius a step is safe without a sweep: its
# centre stays on the side it came from.
SAFE_SHARE = 0.5
# So deep a swept body is let in, for the engine to see the contact; well inside its slop of 5 mm.
TOUCH = 1e-3


def safe_depth(rigid: RigidBody) -> float:
    """Return how far a body may move in a step without a sweep [m]."""
    return rigid.body.shape.form.inner * SAFE_SHARE


def arrest(space: pymunk.Space, movers: list[RigidBody], dt: float) -> None:
    """
    Shorten the coming step of fast bodies so that it ends where they first touch something.

    :param movers: bodies that would move further than their safe depth
    :param dt: of the coming step [s]
    """
    # All ways are measured before the first body is put back, or two would miss each other.
    shares = [_clear_share(space, rigid.engine, safe_depth(rigid), dt) for rigid in movers]
    for rigid, share in zip(movers, shares, strict=True):
        if share < 1.0:
            # The engine will add the whole way; put the body back by what it may not go.
            rigid.engine.position += rigid.engine.velocity * (dt * (share - 1.0))


def relieve(arbiter: pymunk.Arbiter, space: pymunk.Space, slop: float) -> None:
    """
    At a first touch, take back what the bodies overshot in this step, along the normal.

    :param slop: overlap that the engine leaves standing [m]
    """
    one, other = arbiter.shapes
    if one.sensor or other.sensor:
        return
    depth = -min(point.distance for point in arbiter.contact_point_set.points)
    if depth <= slop:
        return
    a, b = one.body, other.body
    normal = arbiter.normal
    dt = space.current_time_step
    approach = (a.velocity - b.velocity).dot(normal) * dt
    excess = min(depth - slop, approach)
    if excess <= 0:
        return
    give_a = 1 / a.mass if a.body_type == pymunk.Body.DYNAMIC else 0.0
    give_b = 1 / b.mass if b.body_type == pymunk.Body.DYNAMIC else 0.0
    if give_a + give_b == 0.0:
        return
    shift = normal * (excess / (give_a + give_b))
    if give_a:
        a.position -= shift * give_a
    if give_b:
        b.position += shift * give_b


def _clear_share(space: pymunk.Space, body: pymunk.Body, depth: float, dt: float) -> float:
    """Return the share of the coming step that the body may go, 0 .. 1."""
    way = body.velocity * dt
    share = 1.0
    for own in body.shapes:
        if own.sensor:
            continue
        start = own.bb
        end = pymunk.BB(
            start.left + way.x, start.bottom + way.y, start.right + way.x, start.top + way.y
        )
        for other in space.bb_query(start.merge(end), own.filter):
            if other.sensor or other.body is body:
                continue
            relative = way - other.body.velocity * dt
            touch = _first_touch(own, other, relative)
            if touch is None:
                continue
            at, approach = touch
            # Grazing contacts that the engine sees in time are left to it: stopping for them
            # would brake a body that slides over tiles.
            if (1.0 - at) * approach > depth:
                share = min(share, at + TOUCH / approach)
    return share


def _first_touch(
    own: pymunk.Shape, other: pymunk.Shape, way: pymunk.Vec2d
) -> tuple[float, float] | None:
    """
    Return when shapes that are apart meet, if they do.

    :return: share of the way until they touch, and the length of the way along the normal there
    """
    if isinstance(own, pymunk.Circle):
        start = own.body.local_to_world(own.offset)
        hit = other.segment_query(start, start + way, own.radius)
    elif isinstance(other, pymunk.Circle):
        start = other.body.local_to_world(other.offset)
        hit = own.segment_query(start, start - way, other.radius)
    else:
        return _sweep_convex(_vertices(own), _vertices(other), np.array(way))
    if hit is None or hit.shape is None:
        return None
    return hit.alpha, abs(way.dot(hit.normal))


def _vertices(shape: pymunk.Shape) -> NDArray[np.float64]:
    """Return the corners of a polygon, or of the rectangle around a segment, in the world."""
    if isinstance(shape, pymunk.Poly):
        corners = shape.get_vertices()
    else:
        assert isinstance(shape, pymunk.Segment)  # noqa: S101 - the engine has no fourth kind
        along = (shape.b - shape.a).normalized() * shape.radius
        across = along.perpendicular()
        corners = [
            shape.a - along - across,
            shape.b + along - across,
            shape.b + along + across,
            shape.a - along + across,
        ]
    return np.array([shape.body.local_to_world(corner) for corner in corners])


def _sweep_convex(
    a: NDArray[np.float64], b: NDArray[np.float64], way: NDArray[np.float64]
) -> tuple[float, float] | None:
    """
    Move a convex outline towards another and find when they meet, by separating axes.

    Two convex outlines overlap when their shadows on every side's normal do, so they meet when
    the last pair of shadows does.
    """
    edges = np.concatenate((np.roll(a, -1, axis=0) - a, np.roll(b, -1, axis=0) - b))
    normals = np.column_stack((edges[:, 1], -edges[:, 0]))
    normals /= np.hypot(edges[:, 0], edges[:, 1])[:, None]
    shadow_a, shadow_b = a @ normals.T, b @ normals.T
    speed = normals @ way
    ahead = shadow_b.min(axis=0) - shadow_a.max(axis=0)
    behind = shadow_b.max(axis=0) - shadow_a.min(axis=0)
    still = speed == 0.0
    if (still & ((ahead > 0) | (behind < 0))).any():
        return None
    with np.errstate(divide='ignore', invalid='ignore'):
        first, last = ahead / speed, behind / speed
    enter = np.where(still, -math.inf, np.minimum(first, last))
    leave = np.where(still, math.inf, np.maximum(first, last))
    axis = int(enter.argmax())
    at = float(enter[axis])
    if not 0.0 <= at < 1.0 or at > leave.min():
        return None
    return at, abs(float(speed[axis]))
