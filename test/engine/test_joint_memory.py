# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The engine's memory is where `engine_memory` reads and writes it."""

from __future__ import annotations

import numpy as np
from physsim_ros.engine.joints import engine_memory
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
        lambda b: pymunk.GrooveJoint(ground, b, (-1.0, 0.0), (1.0, 0.0), (0.1, 0.2)),
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


def test_accumulated_impulses_are_those_that_pymunk_tells() -> None:
    _, constraints = loaded()
    found = engine_memory.impulses(constraints)
    told = [abs(constraint.impulse) for constraint in constraints]
    assert np.hypot(*found.T) == pytest.approx(told, rel=1e-12)
    assert min(told) > 0.0


def test_impulses_that_are_set_are_those_that_pymunk_tells() -> None:
    _, constraints = loaded()
    doubled = 2.0 * engine_memory.impulses(constraints)
    engine_memory.set_impulses(constraints, doubled)
    told = [abs(constraint.impulse) for constraint in constraints]
    assert np.hypot(*doubled.T) == pytest.approx(told, rel=1e-12)


def test_a_body_that_is_pushed_out_by_contacts_is_moved_no_more_once_its_push_is_taken() -> None:
    space = pymunk.Space()
    space.collision_slop = 0.0
    ground = pymunk.Segment(space.static_body, (-5.0, 0.0), (5.0, 0.0), 0.1)
    body = pymunk.Body(1.0, 1.0)
    body.position = (0.0, 0.4)
    space.add(ground, body, pymunk.Circle(body, 0.5))
    space.step(DT)
    (push,) = engine_memory.take_pushes(engine_memory.numbers_of([body]))
    assert push[1] > 0.0
    body.velocity = (0.0, 0.0)
    before = body.position
    pymunk.Body.update_position(body, DT)
    assert body.position == before
