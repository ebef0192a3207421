# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Position corrections that keep the energy: of continuous collision and of contact projection.

A body that is set back against gravity or a wrench has the velocity of the place that it came to;
without this, each bounce of a falling body would gain the potential energy of the way set back.
"""

from __future__ import annotations

import math

from physsim_ros.engine.plane_vectors import coordinates, dot
import pymunk


def is_jointed(space: pymunk.Space, body: pymunk.Body) -> bool:
    """Return whether a body has joints, which remove the work that it gains."""
    # A body lists joints that have left the space for as long as anything refers to them.
    dynamic = body.body_type == pymunk.Body.DYNAMIC
    # `Space.constraints` copies the list of all joints of the space.
    inside = space._constraints  # noqa: SLF001
    return dynamic and any(joint in inside for joint in body.constraints)


def take_back_work(space: pymunk.Space, body: pymunk.Body, back: complex, dt: float) -> None:
    """
    Set the velocity of a body that is set back to that which it had at that place.

    :param back: the way by which it is set back [m]
    :param dt: of a step [s]
    """
    pull = complex(*space.gravity) + complex(*body.force) / body.mass
    work = dot(pull, back)
    if not work:
        return
    velocity, along = complex(*body.velocity), back / abs(back)
    # The engine's velocity is that of half a step before.
    speed = dot(velocity, along) + dot(pull, along) * dt / 2
    square = speed * speed + 2.0 * work
    change = math.copysign(math.sqrt(max(square, 0.0)), speed) - speed
    body.velocity = coordinates(velocity + along * change)
    if square < 0.0:
        # It has come so far by turning.
        spin = body.angular_velocity
        left = max(spin * spin + square * body.mass / body.moment, 0.0)
        body.angular_velocity = math.copysign(math.sqrt(left), spin)
