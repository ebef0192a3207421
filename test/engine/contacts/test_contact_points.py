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

"""Contacts of two points are set as they are given."""

from physsim_ros.engine.contacts.contact_points import set_contact
import pymunk


def test_each_point_of_a_contact_is_set():
    space, bodies = pymunk.Space(), []
    for height in (0.0, 0.99):
        body = pymunk.Body(1.0, 1.0)
        body.position = (0.0, height)
        space.add(body, pymunk.Poly.create_box(body, (1.0, 1.0)))
        bodies.append(body)
    contacts = []

    def begin(arbiter, _space, _data):
        found = arbiter.contact_point_set
        aside = pymunk.Vec2d(0.1, 0.0)
        moved = [
            pymunk.ContactPoint(point.point_a + aside, point.point_b + aside, -0.002)
            for point in found.points
        ]
        wanted = pymunk.ContactPointSet(found.normal, tuple(moved))
        set_contact(arbiter, wanted)
        contacts.append((wanted, arbiter.contact_point_set))

    space.on_collision(begin=begin)
    space.step(0.01)
    ((wanted, found),) = contacts
    assert [(point.point_a, point.point_b) for point in found.points] == [
        (point.point_a, point.point_b) for point in wanted.points
    ]
    assert len({point.point_a for point in found.points}) == 2
