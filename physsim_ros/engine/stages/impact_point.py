# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Impact points: what impulses in the points of contacts change, from the memory of the engine.

Units of an impulse are [N s], a change by an impulse of 1 is [1/kg].
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from physsim_ros.engine.plane_vectors import dot
from pymunk._chipmunk_cffi import ffi, lib

# Places in the numbers of 8 bytes of `struct cpBody` (`include/chipmunk/chipmunk_structs.h` of
# Munk2D as in Pymunk 7.3.1): inverse mass and moment, velocity, force, spin, torque.
_INVERSE_MASS, _INVERSE_MOMENT, _VELOCITY, _FORCE, _SPIN, _TORQUE = 3, 5, 10, 12, 15, 16


def is_moved(body: Any) -> bool:
    """Return whether forces move a body."""
    moves: bool = ffi.cast('double *', body)[_INVERSE_MASS] > 0.0
    return moves


class MovedBody:
    """
    A body in the middle of a step.

    :param memory: `cpBody`
    :param gravity: of the space [m/s²]
    :param kept: share of its velocities that it keeps in the step
    :param dt: of the step [s]

    :ivar inverse_mass: 0 for what forces do not move [1/kg]
    :ivar inverse_moment: 0 for what forces do not turn [1/(kg m²)]
    :ivar velocity: at the end of the step without impulses [m/s]
    :ivar spin: at the end of the step without impulses [rad/s]
    """

    def __init__(self, memory: Any, *, gravity: complex, kept: float, dt: float) -> None:
        self._numbers = numbers = ffi.cast('double *', memory)
        self._kept = kept
        self.inverse_mass = numbers[_INVERSE_MASS]
        self.inverse_moment = numbers[_INVERSE_MOMENT]
        self.velocity = complex(numbers[_VELOCITY], numbers[_VELOCITY + 1])
        self.spin = numbers[_SPIN]
        if is_moved(memory):
            force = complex(numbers[_FORCE], numbers[_FORCE + 1])
            self.velocity = self.velocity * kept + (gravity + force * self.inverse_mass) * dt
            self.spin = self.spin * kept + numbers[_TORQUE] * self.inverse_moment * dt

    def apply_impulse(self, linear: complex, angular: float) -> None:
        """Change the velocities with which the engine begins."""
        change = linear * self.inverse_mass / self._kept
        self._numbers[_VELOCITY] += change.real
        self._numbers[_VELOCITY + 1] += change.imag
        self._numbers[_SPIN] += angular * self.inverse_moment / self._kept


class Lever(NamedTuple):
    """
    The effect of an impulse of 1 in a point on a body.

    :ivar body: one of the two that touch there
    :ivar push: change of its momentum
    :ivar turn: change of its angular momentum [m]
    """

    body: MovedBody
    push: complex
    turn: float


class ImpactPoint(NamedTuple):
    """
    A point of a contact.

    :ivar memory: `struct cpContact`
    :ivar begins: whether the contact begins in this step
    :ivar levers: on its two bodies
    """

    memory: Any
    begins: bool
    levers: tuple[Lever, Lever]

    @property
    def parting(self) -> float:
        """Return the velocity at which the bodies part here, without impulses [m/s]."""
        velocity = 0.0
        for body, push, turn in self.levers:
            velocity += dot(body.velocity, push) + body.spin * turn
        return velocity

    def change_by(self, other: ImpactPoint) -> float:
        """Return the change of that velocity by an impulse of 1 in another point [1/kg]."""
        change = 0.0
        for body, push, turn in self.levers:
            for lever in other.levers:
                if lever.body is body:
                    change += body.inverse_mass * dot(push, lever.push)
                    change += body.inverse_moment * turn * lever.turn
        return change


def points_of(contact: Any, bodies: Mapping[Any, MovedBody]) -> Iterator[ImpactPoint]:
    """Return the points of a contact."""
    begins: bool = contact.state == lib.CP_ARBITER_STATE_FIRST_COLLISION
    normal = complex(contact.n.x, contact.n.y)
    for place in range(contact.count):
        point = contact.contacts[place]
        levers = (
            _lever_of(bodies[contact.body_a], -normal, point.r1),
            _lever_of(bodies[contact.body_b], normal, point.r2),
        )
        yield ImpactPoint(point, begins, levers)


def _lever_of(body: MovedBody, push: complex, arm: Any) -> Lever:
    return Lever(body, push, arm.x * push.imag - arm.y * push.real)
