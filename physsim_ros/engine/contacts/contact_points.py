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
Contact points of two shapes that begin to touch, set one by one.

`Arbiter.contact_point_set` of Pymunk 7.3.1 sets every point to the first: a box that lies on two
points would lie on one.
"""

from __future__ import annotations

import pymunk
from pymunk._chipmunk_cffi import ffi, lib


def set_contact(arbiter: pymunk.Arbiter, contact: pymunk.ContactPointSet) -> None:
    """Replace normal and points of a contact by others, of the same number."""
    found = lib.cpArbiterGetContactPointSet(arbiter._arbiter)  # noqa: SLF001
    found.normal = contact.normal
    for number, point in enumerate(contact.points):
        found.points[number].pointA = point.point_a
        found.points[number].pointB = point.point_b
        found.points[number].distance = point.distance
    lib.cpArbiterSetContactPointSet(arbiter._arbiter, ffi.addressof(found))  # noqa: SLF001
