# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Internal edges: a body that slides over a seam of two shapes is not stopped by the second one.

Where a body begins to overlap the next tile of a floor, it may have gone less far past the tile's
side than it lies below its top, and the engine, which parts two shapes by the shortest way, takes
the side for what was hit ("ghost collision": Catto, Ghost Collisions, box2d.org 2020; Bullet's
`btInternalEdgeUtility`). A contact that begins at a corner, while a face is entered by no more
than the slop and under no more than 10 degrees, is given the normal of that face.

Cost: some 20 us for each contact that begins (`make ablate` has its share of a step). Without it
`test/engine/stages/test_internal_edges.py` fails.
"""

from __future__ import annotations

from typing import NamedTuple

from physsim_ros.engine.ccd.hulls import Hulls
from physsim_ros.engine.contacts.contact import Contact, ContactPoint
from physsim_ros.engine.contacts.side import Side
from physsim_ros.engine.plane_vectors import dot, rotation, vectors
from physsim_ros.engine.tolerances import COLLISION_SLOP
from pymunk import Circle

# Distance from a corner within which overlaps of the slop along two faces lie [m]: the diagonal
# of their rhombus, for faces that enclose 30 degrees or more.
_NEAR = 4.0 * COLLISION_SLOP
# Approach by speed up to which a body slides over a face [1]: the sine of 10 degrees.
_GRAZING = 0.17


class InternalEdges:
    """
    The rule for contacts at seams.

    :param hulls: of the shapes in the space
    """

    def __init__(self, hulls: Hulls) -> None:
        self._hulls = hulls

    def slide_over(self, contact: Contact, sides: tuple[Side, Side]) -> Contact | None:
        """
        Return the contact of two shapes that begin to touch at a seam.

        :param contact: with a point or two, of the engine or at the impact
        :return: along the face that the shapes approach slowest; None where they meet no seam
        """
        point, (side_a, side_b) = contact.points[0], sides
        velocity = _velocity_at(side_b, point.b) - _velocity_at(side_a, point.a)
        slowest, chosen = -dot(velocity, contact.normal), None
        if slowest <= 0.0:
            return None
        slowest = min(slowest, _GRAZING * abs(velocity))
        if (a := self._corner_at(side_a, point.a)) is None:
            return None
        if (b := self._corner_at(side_b, point.b)) is None:
            return None
        middles = [(it.a + it.b) / 2 for it in contact.points]
        for one, other, sign in ((a, b, 1.0), (b, a, -1.0)):
            for corner, normal in one.faces:
                approach = -dot(velocity, normal) * sign
                deepest = min(dot(normal, each) for each in other.corners)
                depth = dot(normal, corner) - deepest + one.radius + other.radius
                if approach < slowest and 0.0 <= depth <= COLLISION_SLOP:
                    slowest, chosen = approach, (normal * sign, depth)
                    if len(other.corners) == 1:
                        # A disc is touched below its centre.
                        middles = [other.corners[0] - normal * other.radius]
        if chosen is None:
            return None
        normal, depth = chosen
        half = normal * (depth / 2)
        points = tuple(ContactPoint(it + half, it - half, -depth) for it in middles)
        return Contact(normal, points)

    def _corner_at(self, side: Side, place: complex) -> _Corner | None:
        """Return the corner of a shape at a place in the world; None where it has none there."""
        hull, turn = self._hulls.of_shape(side.shape), rotation(side.yaw)
        local, corners = (place - side.position) / turn, vectors(hull.corners)
        near = [abs(local - corner) <= _NEAR + hull.radius for corner in corners]
        if True not in near:
            return None
        corners = [side.position + turn * corner for corner in corners]
        # The face of each normal goes from its corner to the next one. That of a disc is 0.
        faces = [
            (corner, turn * normal)
            for corner, normal, begins, ends in zip(
                corners, vectors(hull.normals), near, near[1:] + near[:1], strict=True
            )
            if normal and (begins or ends)
        ]
        return _Corner(faces, corners, hull.radius)


def _velocity_at(side: Side, place: complex) -> complex:
    """Return the velocity at which a shape moves at a place [m/s]; the spin of a disc is none."""
    if isinstance(side.shape, Circle):
        place = side.position + complex(*side.shape.offset) * rotation(side.yaw)
    return side.velocity_at(place)


class _Corner(NamedTuple):
    """
    A corner of a shape, in the world; a disc is a rounded one.

    :ivar faces: beginning and normal of those that meet there
    :ivar corners: all of the shape [m]
    :ivar radius: of their rounding [m]
    """

    faces: list[tuple[complex, complex]]
    corners: list[complex]
    radius: float
