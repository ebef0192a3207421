# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Contact: normal and points of two shapes that touch, read from the engine and written back.

`Arbiter.contact_point_set` of Pymunk 7.3.1 sets every point to the first: a box that lies on two
points would lie on one.
"""

from __future__ import annotations

from typing import NamedTuple

from physsim_ros.engine.plane_vectors import coordinates
import pymunk
from pymunk._chipmunk_cffi import ffi, lib

# ruff: noqa: SLF001 - Chipmunk's arbiter has no other public way to be read in a microsecond


class ContactPoint(NamedTuple):
    """
    A point of a contact, as a place on either body.

    :ivar a: on the first body [m]
    :ivar b: on the second body [m]
    :ivar distance: of b from a along the normal, < 0 where the two overlap [m]
    """

    a: complex
    b: complex
    distance: float


class Contact(NamedTuple):
    """
    Where two shapes touch.

    :ivar normal: from the first shape to the second, of length 1
    :ivar points: one or two
    """

    normal: complex
    points: tuple[ContactPoint, ...]


def read_contact(arbiter: pymunk.Arbiter) -> Contact:
    """Return the contact of two shapes."""
    found = lib.cpArbiterGetContactPointSet(arbiter._arbiter)
    points = []
    for number in range(found.count):
        point = found.points[number]
        a, b = point.pointA, point.pointB
        points.append(ContactPoint(complex(a.x, a.y), complex(b.x, b.y), point.distance))
    return Contact(complex(found.normal.x, found.normal.y), tuple(points))


def write_contact(arbiter: pymunk.Arbiter, contact: Contact) -> None:
    """Replace normal and points of a contact by others, of the same number."""
    found = lib.cpArbiterGetContactPointSet(arbiter._arbiter)
    found.normal = coordinates(contact.normal)
    for number, point in enumerate(contact.points):
        found.points[number].pointA = coordinates(point.a)
        found.points[number].pointB = coordinates(point.b)
        found.points[number].distance = point.distance
    lib.cpArbiterSetContactPointSet(arbiter._arbiter, ffi.addressof(found))
