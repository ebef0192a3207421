# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The numbers of the engine's structs are where `engine.memory` reads and writes them."""

from __future__ import annotations

import numpy as np
from physsim_ros.engine.memory import (
    ARBITERS,
    follow,
    IDLE_TIME,
    impulse_places,
    index_of,
    indices_of,
    INVERSE_MASS,
    INVERSE_MOMENT,
    NUMBERS,
    PUSH,
    SPIN,
    VELOCITY,
)
import pymunk
import pytest

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
    found = [float(np.hypot.reduce(NUMBERS[impulse_places(each)])) for each in constraints]
    assert np.abs(found) == pytest.approx(told(constraints), rel=1e-12)
    assert min(told(constraints)) > 0.0


def test_impulses_that_are_set_are_those_that_pymunk_tells() -> None:
    _, constraints = loaded()
    before = told(constraints)
    for constraint in constraints:
        NUMBERS[impulse_places(constraint)] *= 2.0
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
    (index,) = indices_of([body])
    assert NUMBERS[index + INVERSE_MASS] == 0.5
    assert NUMBERS[index + INVERSE_MOMENT] == 2.0
    NUMBERS[[index + VELOCITY, index + VELOCITY + 1, index + SPIN]] = 1.0, 2.0, 3.0
    assert body.velocity == (1.0, 2.0)
    assert body.angular_velocity == 3.0


def test_a_body_that_is_pushed_out_by_contacts_is_moved_no_more_once_its_push_is_taken() -> None:
    _, body = resting()
    (index,) = indices_of([body])
    assert NUMBERS[index + PUSH + 1] > 0.0
    NUMBERS[index + PUSH + np.arange(3)] = 0.0
    body.velocity = (0.0, 0.0)
    before = body.position
    pymunk.Body.update_position(body, DT)
    assert body.position == before


def test_the_list_of_arbiters_of_a_body_begins_with_the_one_that_pymunk_tells() -> None:
    _, body = resting()
    found: list[int] = []
    body.each_arbiter(lambda arbiter: found.append(index_of(arbiter._arbiter)))  # noqa: SLF001
    assert follow(indices_of([body]) + ARBITERS).tolist() == found


def test_a_body_whose_idle_time_is_reset_stays_awake() -> None:
    space, body = resting()
    body.position = (0.0, 0.6)
    space.sleep_time_threshold = 0.1
    for _ in range(100):
        NUMBERS[indices_of([body]) + IDLE_TIME] = 0.0
        space.step(DT)
    assert not body.is_sleeping
    for _ in range(100):
        space.step(DT)
    assert body.is_sleeping
