# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Stiffness: which springs are soft constraints, solved with the loads that act on them.

Chipmunk moves bodies first and lets springs pull then (symplectic Euler), which keeps the energy
of what swings, and is stable while no body swings by more than two radians a sub-step. All springs
on a body together swing it by less than one while sum of f k (1/m + r^2/I) <= 1 / dt^2, f = 2
where the other body is dynamic too, since (v_a - v_b)^2 <= 2 v_a^2 + 2 v_b^2; a torsion spring has
1/I in place of 1/m + r^2/I. What exceeds that is
taken where the sub-step ends (implicit Euler): no spring is too stiff, and one that swings faster
than steps can show comes to rest. A damper is always taken there.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
import math

import numpy as np
from physsim_ros.engine.joints.kinds import EngineJoint
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.snapshot import Springs


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


def dampings_of(springs: Sequence[Joint], bodies: Mapping[str, Body], dt: float) -> list[float]:
    """
    Return the damping of each spring, with what its stiffness adds to it [N s/m, N m s/rad].

    :param bodies: by name
    :param dt: of a sub-step [s]
    """
    total: dict[str, float] = {}
    for spring in springs:
        for name, share in _softness(spring, bodies):
            total[name] = total.get(name, 0.0) + spring.stiffness * share * dt * dt
    dampings = []
    for spring in springs:
        swing = max((total[name] for name, _ in _softness(spring, bodies)), default=0.0)
        ahead = max(0.0, 1.0 - 1.0 / swing) if swing > 0.0 else 0.0
        dampings.append(spring.number('damping') + ahead * dt * spring.stiffness)
    return dampings


def _softness(spring: Joint, bodies: Mapping[str, Body]) -> Iterator[tuple[str, float]]:
    """Yield the dynamic bodies of a spring, and f (1/m + r^2/I) or f/I of each."""
    seat = spring.seat
    ends = ((spring.a, seat.ax, seat.ay), (spring.b, seat.bx, seat.by))
    moving = [each for each in ends if each[0] in bodies and bodies[each[0]].dynamic]
    for name, x, y in moving:
        body = bodies[name]
        form = body.shape.form
        arm2 = (x - form.centroid[0]) ** 2 + (y - form.centroid[1]) ** 2
        share = 1.0 + arm2 / form.gyration if spring.kind.points == 2 else 1.0 / form.gyration
        yield name, len(moving) * share / body.total_mass
