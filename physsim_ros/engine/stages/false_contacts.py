# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
False contacts: polygons that the engine finds deep in each other, though they are apart.

Problem: GJK of Chipmunk (Munk2D as in Pymunk 7.3.1) tests with rounded numbers whether a triangle
of the Minkowski difference has the origin inside (`GJKRecurse` in `src/cpCollision.c`). Where two
polygons face each other exactly, three corners of the difference and the origin are on one line.
One pair in ten thousand that are parallel and centred, up to a width apart, is then said to have
entered each other from the far sides: bodies that part after a square impact hit each other again
in mid-air.
Method: a contact whose normal points from the second shape to the first is no shallow one. If an
edge separates the two shapes (separating axis theorem; Ericson, Real-Time Collision Detection,
5.2.1), the engine ignores the contact in this step, and in the next one takes what it finds
for a first touch.
Cost: 5 us for each contact of polygons that begins.

Without it law 3 (head-on impacts) fails where the boxes do not turn. It can go when GJK is exact.
"""

from __future__ import annotations

from typing import Any

from physsim_ros.engine.ccd.hulls import Hull, Hulls
from physsim_ros.engine.contacts.contact import Contact
from physsim_ros.engine.contacts.side import Side
from physsim_ros.engine.plane_vectors import coordinates
from physsim_ros.model.transform import dots
import pymunk
from pymunk._chipmunk_cffi import lib


class FalseContacts:
    """
    Rejects false contacts.

    :param hulls: of the shapes in the space
    """

    def __init__(self, hulls: Hulls) -> None:
        self._hulls = hulls
        # `cpArbiter` of the contacts that the last step has rejected.
        self._rejected: list[Any] = []

    def begin_step(self) -> None:
        """Let the engine count the rejected contacts of the last step as parted."""
        for arbiter in self._rejected:
            arbiter.state = lib.CP_ARBITER_STATE_CACHED
        self._rejected.clear()

    def reject(self, arbiter: pymunk.Arbiter, contact: Contact, sides: tuple[Side, Side]) -> bool:
        """
        Let the engine ignore a contact that is false.

        :param contact: of two shapes that begin to touch
        :return: whether it is
        """
        a, b = (side.shape for side in sides)
        if isinstance(a, pymunk.Circle) or isinstance(b, pymunk.Circle):
            return False
        if (b.bb.center() - a.bb.center()).dot(coordinates(contact.normal)) >= 0.0:
            return False
        one, other = (self._hulls.of_shape(it.shape).placed_on(it.body) for it in sides)
        if not (_separates(one, other) or _separates(other, one)):
            return False
        arbiter.process_collision = False
        self._rejected.append(arbiter._arbiter)  # noqa: SLF001
        return True


def _separates(one: Hull, other: Hull) -> bool:
    """Return whether an edge of a hull has another one wholly outside."""
    edges = (one.corners * one.normals).sum(axis=1)
    distances = dots(one.normals[:, None], other.corners).min(axis=1) - edges
    return bool((distances > one.radius + other.radius).any())
