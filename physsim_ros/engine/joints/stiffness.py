# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Stiffness: how stiff springs may be for the steps.

Pymunk moves bodies first and lets springs pull then (symplectic Euler), which is stable while no
body swings by more than two radians a step. All springs on a body together keep it below one:
sum of f k (1/m + r^2/I) <= 1 / dt^2, f = 2 where the other body is dynamic too, since
(v_a - v_b)^2 <= 2 v_a^2 + 2 v_b^2. `check_stiffness` raises beyond that.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
import math

import numpy as np
from physsim_ros.engine.joints.kinds import EngineJoint
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.snapshot import Springs

# Share of the bound by which rounding may exceed it.
_ROUNDING = 1e-9


def springs_of(joints: Sequence[EngineJoint]) -> Springs:
    """Return the springs among joints."""
    numbers = [
        number
        for number, each in enumerate(joints)
        if each.joint.kind is JointKind.SPRING and each.parts
    ]
    springs = [joints[number].joint for number in numbers]
    stiffness = np.array([spring.stiffness for spring in springs], np.float64)
    limits = (spring.properties.max_force for spring in springs)
    most = np.array([math.inf if limit is None else limit for limit in limits])
    with np.errstate(over='ignore'):
        # A strain that is no number any more is never reached.
        reach = most / np.maximum(stiffness, 1e-300)
    rest = np.array([spring.rest_length for spring in springs], np.float64)
    return Springs(np.array(numbers, np.int64), stiffness, rest, reach)


def check_stiffness(joints: Sequence[Joint], bodies: Mapping[str, Body], dt: float) -> None:
    """
    Refuse springs that are too stiff for the steps.

    :param joints: all of the bodies that change, and of their neighbours, or more
    :param bodies: by name
    :param dt: of a sub-step [s]
    :raises BadProperty: of the greatest stiffness that the last such spring may have
    """
    springs = [joint for joint in joints if joint.kind is JointKind.SPRING]
    total: dict[str, float] = {}
    shares = [dict(_softness(spring, bodies)) for spring in springs]
    for spring, softness in zip(springs, shares, strict=True):
        for name, share in softness.items():
            total[name] = total.get(name, 0.0) + spring.stiffness * share
    bound = 1.0 / (dt * dt)
    for spring, softness in zip(reversed(springs), reversed(shares), strict=True):
        if any(total[name] > bound * (1.0 + _ROUNDING) for name in softness):
            most = min(
                spring.stiffness + (bound - total[name]) / share
                for name, share in softness.items()
            )
            tightest = min(softness, key=lambda name: bound - total[name])
            raise BadProperty(
                f'stiffness of {spring.name} is {spring.stiffness:g} N/m; steps of {dt:g} s can '
                f'follow {max(math.floor(most), 0):d} N/m with what {tightest} weighs and what '
                'other springs are on it',
                field='stiffness',
            )


def _softness(spring: Joint, bodies: Mapping[str, Body]) -> Iterator[tuple[str, float]]:
    """Yield the dynamic bodies of a spring, and f (1/m + r^2/I) of each [1/kg]."""
    seat = spring.seat
    ends = ((spring.a, seat.ax, seat.ay), (spring.b, seat.bx, seat.by))
    moving = [each for each in ends if each[0] in bodies and bodies[each[0]].dynamic]
    for name, x, y in moving:
        body = bodies[name]
        form = body.shape.form
        arm2 = (x - form.centroid[0]) ** 2 + (y - form.centroid[1]) ** 2
        yield name, len(moving) * (1.0 + arm2 / form.gyration) / body.total_mass
