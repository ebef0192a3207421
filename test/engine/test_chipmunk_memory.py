# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Memory of Chipmunk is read as Pymunk reads it, and is not read where it lies otherwise."""

from unittest import mock

import numpy as np
from physsim_ros.engine import chipmunk_memory as memory
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.contacts.pre_step import prepare_contacts
from physsim_ros.engine.contacts.touches import read_touches
import pymunk
import pytest

# ruff: noqa: SLF001 - Pymunk has no public way to its structs


@pytest.mark.parametrize(
    ('name', 'wrong'),
    [
        ('_SPACE_ARBITERS', 19),
        ('BODY_POSE', np.array((9, 8, 14))),
        ('BODY_INVERSE_MASS', 2),
        ('SHAPE_BOX', slice(7, 11)),
        ('_RADIUS', np.array((27, 36, 24))),
        ('_SEGMENT_ENDS', 24),
    ],
)
def test_a_version_with_other_structs_is_refused(name, wrong):
    with (
        mock.patch.object(memory, name, wrong),
        pytest.raises(ImportError, match=pymunk.version),
    ):
        memory._check_layout()


def _pair(slide):
    """Return a space in which a tilted box has met a slab, and what stands before the solver."""
    space, found = pymunk.Space(), []
    space.collision_slop = 0.005
    slab, box = pymunk.Body(3.0, 1.0), pymunk.Body(1.0, 0.2)
    box.position, box.angle, box.velocity = (0.1, 0.745), 0.01, (1.0, -3.0)
    shapes = [pymunk.Poly.create_box(slab, (3.0, 1.0)), pymunk.Poly.create_box(box, (0.5, 0.5))]
    for shape in shapes:
        shape.elasticity = 0.7
    space.add(slab, box, *shapes)
    hook = pymunk.RotaryLimitJoint(space.static_body, pymunk.Body(1.0, 1.0), -1.0, 1.0)
    space.add(hook)
    hook.pre_solve = lambda *_: found.append(slide(space))
    space.step(0.01)
    return found[0]


def test_contacts_are_read_as_pymunk_reads_them():
    def compare(space):
        (raw,) = space._get_arbiters()
        arbiter = pymunk.Arbiter(raw, space)
        table = mock.create_autospec(BodyTable, instance=True)
        touches = read_touches(table, memory.contacts_of_step(space))
        known = arbiter.contact_point_set
        read = [[*point.point_a, *point.point_b] for point in known.points]
        assert touches.counts.tolist() == [len(read)] == [2]
        assert touches.normals[0].tolist() == [*known.normal]
        places = np.concatenate((touches.places[0, 0], touches.places[1, 0]), axis=1)
        assert places == pytest.approx(np.array(read), abs=1e-12)
        distances = [point.distance for point in known.points]
        assert touches.distances[0] == pytest.approx(distances, abs=1e-12)
        assert touches.ids[0].tolist() == [body.id for body in arbiter.bodies]
        corners = [
            sorted(tuple(shape.body.local_to_world(each)) for each in shape.get_vertices())
            for shape in arbiter.shapes
        ]
        found = [sorted(map(tuple, each[0].tolist())) for each in touches.shapes.corners]
        assert np.array(found) == pytest.approx(np.array(corners), abs=1e-12)
        return True

    assert _pair(compare)


def test_contacts_are_prepared_as_the_engine_prepares_them():
    def compare(space):
        arbiters = memory.contacts_of_step(space)
        (raw,) = space._get_arbiters()
        fields = ('nMass', 'tMass', 'bounce', 'jBias', 'bias')

        def read():
            return [
                [getattr(raw.contacts[place], each) for each in fields]
                for place in range(raw.count)
            ]

        made = read()
        for place in range(raw.count):
            for each in fields:
                setattr(raw.contacts[place], each, 7.0)
        prepare_contacts(space, arbiters)
        return made, read()

    made, again = _pair(compare)
    assert np.array(again) == pytest.approx(np.array(made), rel=1e-12, abs=1e-12)
