# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Memory of Chipmunk is read and written as Pymunk tells it, and not where it lies otherwise."""

from __future__ import annotations

from unittest import mock

import numpy as np
from physsim_ros.engine import memory
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.contacts.touches import prepare_contacts, read_touches
import pymunk
import pytest

# ruff: noqa: SLF001 - Pymunk has no public way to its structs

DT = 1.0 / 240.0


def loaded() -> tuple[pymunk.Space, list[pymunk.Constraint]]:
    """Return a space in which constraints of each kind hold a body against gravity and spin."""
    space, constraints = pymunk.Space(), []
    space.gravity = (3.0, -9.81)
    ground = space.static_body
    makers = [
        lambda b: pymunk.PivotJoint(ground, b, (0.0, 0.0), (0.1, 0.2)),
        lambda b: pymunk.PinJoint(ground, b, (0.0, 2.0), (0.1, 0.2)),
        lambda b: pymunk.SlideJoint(ground, b, (0.0, 2.0), (0.1, 0.2), 0.0, 1.0),
        lambda b: pymunk.GearJoint(ground, b, 0.0, 2.0),
        lambda b: pymunk.RotaryLimitJoint(ground, b, 0.5, 1.0),
        lambda b: pymunk.SimpleMotor(ground, b, 1.0),
        lambda b: pymunk.DampedSpring(ground, b, (0.0, 2.0), (0.1, 0.2), 1.0, 50.0, 1.0),
    ]
    for make in makers:
        body = pymunk.Body(2.0, 0.5)
        body.angular_velocity = -3.0
        constraint = make(body)
        space.add(body, constraint)
        constraints.append(constraint)
    space.step(DT)
    return space, constraints


def told(constraints: list[pymunk.Constraint]) -> list[float]:
    """Return the impulses that Pymunk tells."""
    return [abs(constraint.impulse) for constraint in constraints]


def test_accumulated_impulses_are_those_that_pymunk_tells() -> None:
    _, constraints = loaded()
    found = [
        float(np.hypot.reduce(memory.NUMBERS[memory.impulse_places(each)])) for each in constraints
    ]
    assert np.abs(found) == pytest.approx(told(constraints), rel=1e-12)
    assert min(told(constraints)) > 0.0


def test_impulses_that_are_set_are_those_that_pymunk_tells() -> None:
    _, constraints = loaded()
    before = told(constraints)
    for constraint in constraints:
        memory.NUMBERS[memory.impulse_places(constraint)] *= 2.0
    assert told(constraints) == pytest.approx([2.0 * each for each in before], rel=1e-12)


def resting() -> tuple[pymunk.Space, pymunk.Body]:
    """Return a space in which a disc overlaps the ground."""
    space = pymunk.Space()
    space.collision_slop = 0.0
    ground = pymunk.Segment(space.static_body, (-5.0, 0.0), (5.0, 0.0), 0.1)
    body = pymunk.Body(2.0, 0.5)
    body.position = (0.0, 0.4)
    space.add(ground, body, pymunk.Circle(body, 0.5))
    space.step(DT)
    return space, body


def test_masses_and_velocities_of_a_body_are_those_that_pymunk_tells() -> None:
    _, body = resting()
    (place,) = memory.places_of([body])
    assert memory.NUMBERS[place + memory.BODY_INVERSE_MASS] == 0.5
    assert memory.NUMBERS[place + memory.BODY_INVERSE_MOMENT] == 2.0
    memory.NUMBERS[place + memory.BODY_TWIST] = 1.0, 2.0, 3.0
    assert body.velocity == (1.0, 2.0)
    assert body.angular_velocity == 3.0


def test_a_body_that_is_pushed_out_by_contacts_is_moved_no_more_once_its_push_is_taken() -> None:
    _, body = resting()
    (place,) = memory.places_of([body])
    assert memory.NUMBERS[place + memory.BODY_BIAS[1]] > 0.0
    memory.NUMBERS[place + memory.BODY_BIAS] = 0.0
    body.velocity = (0.0, 0.0)
    before = body.position
    pymunk.Body.update_position(body, DT)
    assert body.position == before


def test_the_list_of_arbiters_of_a_body_begins_with_the_one_that_pymunk_tells() -> None:
    _, body = resting()
    found: list[int] = []
    body.each_arbiter(lambda arbiter: found.append(memory.place_of(arbiter._arbiter)))
    assert (
        memory.places_in(
            memory.read_words(memory.places_of([body]), memory.BODY_ARBITERS)
        ).tolist()
        == found
    )


def test_a_body_whose_idle_time_is_reset_stays_awake() -> None:
    space, body = resting()
    body.position = (0.0, 0.6)
    space.sleep_time_threshold = 0.1
    for _ in range(100):
        memory.NUMBERS[memory.places_of([body]) + memory.BODY_IDLE_TIME] = 0.0
        space.step(DT)
    assert not body.is_sleeping
    for _ in range(100):
        space.step(DT)
    assert body.is_sleeping


@pytest.mark.parametrize(
    ('name', 'wrong'),
    [
        ('_SPACE_ARBITERS', 19),
        ('BODY_POSE', np.array((9, 8, 14))),
        ('BODY_INVERSE_MASS', 2),
        ('BODY_FORCES', np.array((12, 13, 17))),
        ('BODY_INVERSES', np.array((3, 3, 6))),
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
