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
Internal edges: a body that slides over a seam of two shapes is not stopped by the second one.

Where a body begins to overlap the next tile of a floor, it may have gone less far past the tile's
side than it lies below its top, and the engine, which parts two shapes by the shortest way, takes
the side for what was hit ("ghost collision": Catto, Ghost Collisions, box2d.org 2020; Bullet's
`btInternalEdgeUtility`). A contact that begins at a corner, while a face is entered by no more
than the slop and under no more than 10 degrees, is given the normal of that face.

Cost: some 30 us for each contact that begins (`make ablate` has its share of a step). Without it
`test/engine/stages/test_internal_edges.py` fails.
"""

from __future__ import annotations

from collections.abc import Iterator
import math

import numpy as np
from physsim_ros.engine.ccd.hulls import Hull, Hulls
from physsim_ros.engine.ccd.time_of_impact import SLOP
from physsim_ros.engine.shape_pair import body_of, ShapePair
from pymunk import Circle, ContactPoint, ContactPointSet, Vec2d

# Distance from a corner within which overlaps of the slop along two faces lie [m]: the diagonal
# of their rhombus, for faces that enclose 30 degrees or more.
_NEAR = 4.0 * SLOP
# Approach by speed up to which a body slides over a face [1]: the sine of 10 degrees.
_GRAZING = 0.17


class InternalEdges:
    """
    The rule for contacts at seams.

    :param hulls: of the shapes in the space
    """

    def __init__(self, hulls: Hulls) -> None:
        self._hulls = hulls

    def slide_over(self, contact: ContactPointSet, shapes: ShapePair) -> ContactPointSet | None:
        """
        Return the contact of two shapes that begin to touch at a seam.

        :param contact: with a point or two, of the engine or at the impact
        :return: along the face that the shapes approach slowest; None where they meet no seam
        """
        point, (body_a, body_b) = contact.points[0], (body_of(shape) for shape in shapes)
        velocity = body_b.velocity_at_world_point(point.point_b)
        velocity -= body_a.velocity_at_world_point(point.point_a)
        slowest, chosen = -velocity.dot(contact.normal), None
        if slowest <= 0.0 or not self._is_at_corners(shapes, point):
            return None
        slowest = min(slowest, _GRAZING * velocity.length)
        middles = [(it.point_a + it.point_b) / 2 for it in contact.points]
        a, b = (self._hulls.of_shape(shape).placed_on(body_of(shape)) for shape in shapes)
        for one, other, sign in ((a, b, 1.0), (b, a, -1.0)):
            for normal, depth in _shallow_faces(one, other):
                approach = -velocity.dot(normal) * sign
                if approach < slowest:
                    slowest, chosen = approach, (normal * sign, depth)
                    if len(other.corners) == 1:
                        # A disc is touched below its centre.
                        middles = [Vec2d(*other.corners[0].tolist()) - normal * other.radius]
        if chosen is None:
            return None
        normal, depth = chosen
        half = normal * (depth / 2)
        points = tuple(ContactPoint(it + half, it - half, -depth) for it in middles)
        return ContactPointSet(normal, points)

    def _is_at_corners(self, shapes: ShapePair, point: ContactPoint) -> bool:
        """Return whether a contact lies near a corner of each shape that has some."""
        places = zip(shapes, (point.point_a, point.point_b), strict=True)
        cornered = [(shape, place) for shape, place in places if not isinstance(shape, Circle)]
        for shape, place in cornered:
            x, y = body_of(shape).world_to_local(place)
            local = self._hulls.of_shape(shape)
            near = _NEAR + local.radius
            if all(math.hypot(x - u, y - v) > near for u, v in local.corners.tolist()):
                return False
        return bool(cornered)


def _shallow_faces(one: Hull, other: Hull) -> Iterator[tuple[Vec2d, float]]:
    """Return the faces of a hull behind which another is no deeper than the slop, with depths."""
    if len(one.corners) < 2:
        return
    faces = (one.corners * one.normals).sum(axis=1)
    depths = faces - (one.normals @ other.corners.T).min(axis=1) + one.radius + other.radius
    for face in np.flatnonzero((depths >= 0.0) & (depths <= SLOP)).tolist():
        yield Vec2d(*one.normals[face].tolist()), float(depths[face])
