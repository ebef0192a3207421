# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Contact: normal and points of two shapes that touch, read from the engine."""

from __future__ import annotations

from typing import NamedTuple

import pymunk
from pymunk._chipmunk_cffi import lib

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
