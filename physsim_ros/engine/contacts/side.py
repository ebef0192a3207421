# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sides: the two shapes that begin to touch, with the states of their bodies at that moment."""

from __future__ import annotations

from typing import cast, NamedTuple

import pymunk


class Side(NamedTuple):
    """
    One of the two shapes of a contact.

    :ivar shape: of the engine
    :ivar body: of the shape
    :ivar position: of the body [m]
    :ivar yaw: of the body [rad]
    :ivar velocity: of the body's origin [m/s]
    :ivar spin: of the body [rad/s]
    """

    shape: pymunk.Shape
    body: pymunk.Body
    position: complex
    yaw: float
    velocity: complex
    spin: float

    def velocity_at(self, place: complex) -> complex:
        """Return the velocity of the body's material at a place in the world [m/s]."""
        return self.velocity + 1j * self.spin * (place - self.position)


def read_sides(arbiter: pymunk.Arbiter) -> tuple[Side, Side]:
    """Return the two sides of a contact."""
    a, b = arbiter.shapes
    return _read_side(a), _read_side(b)


def _read_side(shape: pymunk.Shape) -> Side:
    # Pymunk's type allows for a shape without a body.
    body = cast('pymunk.Body', shape.body)
    position, velocity = complex(*body.position), complex(*body.velocity)
    return Side(shape, body, position, body.angle, velocity, body.angular_velocity)
