# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Contacts of two points are set as they are given."""

from physsim_ros.engine.contacts.contact import Contact, ContactPoint, read_contact, write_contact
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
        found = read_contact(arbiter)
        moved = [ContactPoint(point.a + 0.1, point.b + 0.1, -0.002) for point in found.points]
        wanted = Contact(found.normal, tuple(moved))
        write_contact(arbiter, wanted)
        contacts.append((wanted, read_contact(arbiter), arbiter.contact_point_set))

    space.on_collision(begin=begin)
    space.step(0.01)
    ((wanted, found, engines),) = contacts
    assert [(point.a, point.b) for point in found.points] == [
        (point.a, point.b) for point in wanted.points
    ]
    assert [complex(*point.point_a) for point in engines.points] == [
        point.a for point in found.points
    ]
    assert complex(*engines.normal) == found.normal
    assert len({point.a for point in found.points}) == 2
