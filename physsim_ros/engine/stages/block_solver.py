# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Block solver: the points in which two bodies hit each other at once are solved together.

**Problem.** The solver goes from point to point (sequential impulses), normal and friction in
turn. Of a box that falls flat the first corner takes more than its half of the impact, the second
one less, and ten iterations do not level that (a hundred would): a box of 0.5 x 1 m that is
dropped from 1 m at a restitution of 0.5 tips over.

**Method.** The normal impulses λ of the points solve a linear complementarity problem: λ >= 0,
and the velocity v + K λ after the impact is at least -e times that before it, where K is the
inverse effective mass (D. Baraff, Analytical methods for dynamic simulation of non-penetrating
rigid bodies, 1989; of two points E. Catto, `b2ContactSolver::SolveVelocityConstraints` in Box2D
2.4, "block solver"). The engine's own solver begins with these impulses, and adds friction.

**Scope.** Two bodies that hit each other in two points or more, or one that so hits what forces do
not move: the outermost contacts of each normal, between which the others have nothing to add. With
them all contacts of these bodies and of those that they touch in turn, up to `MOST` points: the
ground that carries a body which is hit, a short stack below it. Impacts in greater piles are left
to the engine's solver: impulses from a part of a pile throw its light bodies out.

**Cost.** Some 90 us for each pair of bodies that hit each other so, and 5 us for all others.

Units of an impulse are [N s], a change by an impulse of 1 is [1/kg].

Without it laws 8 (bodies that fall flat) and 21 (elastic polygons keep their energy) fail.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
import itertools
from typing import Any, NamedTuple

from physsim_ros.engine import memory
from physsim_ros.engine.contacts.touches import Touches, velocities_at
from physsim_ros.engine.lcp import product, solve_lcp
from physsim_ros.engine.stages.impact_propagation import SLOWEST
from physsim_ros.model.transform import dot, dots
import pymunk
from pymunk._chipmunk_cffi import ffi, lib

# Points that are solved together at most: of four boxes on each other and the ground, eight are.
MOST = 8


class BlockSolver:
    """
    Solves impacts of several points, before the engine does.

    :param pm_space: of the engine
    """

    def __init__(self, pm_space: pymunk.Space) -> None:
        self._pm_space = pm_space

    def solve_impacts(self, touches: Touches) -> None:
        """Solve the impacts among contacts that begin."""
        arms = touches.places - touches.states[:, :, None, memory.BODY_POSITION]
        a, b = velocities_at(touches, arms)
        approach = -dots(b - a, touches.normals[:, None]).min(axis=1)
        begun = touches.arbiters[approach > SLOWEST]
        impacts: dict[frozenset[Any], list[Any]] = {}
        for contact in (memory.pointer_to('cpArbiter *', each) for each in begun.tolist()):
            impacts.setdefault(frozenset(_moved_by(contact)), []).append(contact)
        solved: set[Any] = set()
        for contacts in impacts.values():
            if contacts[0] in solved:
                continue
            island = _island(_outermost(contacts), contacts)
            if 1 < sum(each.count for each in island) <= MOST:
                solved.update(contacts, island)
                self._solve(island)

    def _solve(self, contacts: Sequence[Any]) -> None:
        """
        Set the normal impulses of contacts, and add those of contacts that begin to velocities.

        :param contacts: `cpArbiter`
        """
        dt = self._pm_space.current_time_step
        kept, gravity = self._pm_space.damping**dt, complex(*self._pm_space.gravity)
        if kept == 0.0:
            return
        pairs = [(contact.body_a, contact.body_b) for contact in contacts]
        bodies = {
            body: _MovedBody(body, gravity=gravity, kept=kept, dt=dt)
            for body in itertools.chain(*pairs)
        }
        points = [point for contact in contacts for point in _points_of(contact, bodies)]
        matrix = [[point.change_by(other) for other in points] for point in points]
        # By an impact next to it that has been solved in this step.
        added = [point.struct.jnAcc if point.begins else 0.0 for point in points]
        rates = [
            point.parting + point.struct.bounce - product(row, added)
            for point, row in zip(points, matrix, strict=True)
        ]
        impulses = solve_lcp(matrix, rates)
        if impulses is None:
            return
        for point, impulse, before in zip(points, impulses, added, strict=True):
            point.struct.jnAcc = impulse
            # The engine applies that of other contacts itself (`cpArbiterApplyCachedImpulse`).
            if point.begins:
                for body, push, turn in point.levers:
                    body.apply_impulse(push * (impulse - before), turn * (impulse - before))


def _outermost(begun: Sequence[Any]) -> list[Any]:
    """
    Return the first and the last contact of an impact along each face.

    :param begun: `cpArbiter` of the impact
    """
    body = _moved_by(begun[0])[0]
    faces: dict[tuple[float, float], list[tuple[float, float, int]]] = {}
    for number, contact in enumerate(begun):
        is_first = contact.body_a == body
        normal = complex(contact.n.x, contact.n.y) * (1.0 if is_first else -1.0)
        points = [contact.contacts[place] for place in range(contact.count)]
        arms = [point.r1 if is_first else point.r2 for point in points]
        places = [dot(complex(arm.x, arm.y), normal * 1j) for arm in arms]
        # Normals of one face differ by rounding.
        face = round(normal.real, 6), round(normal.imag, 6)
        faces.setdefault(face, []).append((min(places), max(places), number))
    ends = set()
    for rows in faces.values():
        ends |= {min(rows)[2], max(rows, key=lambda row: row[1])[2]}
    return [begun[number] for number in sorted(ends)]


def _island(outermost: Sequence[Any], begun: Sequence[Any]) -> list[Any]:
    """
    Return the contacts of an impact, and all others that they reach through bodies that move.

    :param outermost: `cpArbiter` of the impact that are solved
    :param begun: all of the impact
    :return: `cpArbiter`; where there are more than `MOST`, some of them
    """
    known, found = set(begun), list(outermost)
    queue = deque((body, outermost[0]) for body in _moved_by(outermost[0]))
    while queue and len(found) <= MOST:
        body, contact = queue.popleft()
        listed = itertools.islice(_contacts_of(body, contact), len(known) + MOST + 1)
        others = [other for other in listed if other not in known]
        found += others
        known.update(others)
        for other in others:
            queue.extend((far, other) for far in _moved_by(other) if far != body)
    return found


def _contacts_of(body: Any, contact: Any) -> Iterator[Any]:
    """Return the other contacts in the engine's list of a body, from one of them on."""
    for direction in ('prev', 'next'):
        other = contact
        while True:
            thread = other.thread_a if other.body_a == body else other.thread_b
            other = getattr(thread, direction)
            if not other:
                break
            yield other


def _moved_by(contact: Any) -> list[Any]:
    """Return the bodies of a contact that forces move."""
    return [body for body in (contact.body_a, contact.body_b) if _is_moved(body)]


def _is_moved(body: Any) -> bool:
    """Return whether forces move a body."""
    moves: bool = ffi.cast('double *', body)[memory.BODY_INVERSE_MASS] > 0.0
    return moves


class _MovedBody:
    """
    A body in the middle of a step.

    :param struct: `cpBody`
    :param gravity: of the space [m/s²]
    :param kept: share of its velocities that it keeps in the step
    :param dt: of the step [s]

    :ivar inverse_mass: 0 for what forces do not move [1/kg]
    :ivar inverse_moment: 0 for what forces do not turn [1/(kg m²)]
    :ivar velocity: at the end of the step without impulses [m/s]
    :ivar spin: at the end of the step without impulses [rad/s]
    """

    def __init__(self, struct: Any, *, gravity: complex, kept: float, dt: float) -> None:
        self._numbers = numbers = ffi.cast('double *', struct)
        self._kept = kept
        self.inverse_mass = numbers[memory.BODY_INVERSE_MASS]
        self.inverse_moment = numbers[memory.BODY_INVERSE_MOMENT]
        self.velocity = complex(*numbers[memory.BODY_VELOCITY])
        self.spin = numbers[memory.BODY_SPIN]
        if _is_moved(struct):
            force = complex(*numbers[memory.BODY_FORCE])
            self.velocity = self.velocity * kept + (gravity + force * self.inverse_mass) * dt
            self.spin = self.spin * kept + numbers[memory.BODY_TORQUE] * self.inverse_moment * dt

    def apply_impulse(self, linear: complex, angular: float) -> None:
        """Change the velocities with which the engine begins."""
        change = linear * self.inverse_mass / self._kept
        self._numbers[memory.BODY_VELOCITY.start] += change.real
        self._numbers[memory.BODY_VELOCITY.start + 1] += change.imag
        self._numbers[memory.BODY_SPIN] += angular * self.inverse_moment / self._kept


class _Lever(NamedTuple):
    """
    The effect of an impulse of 1 in a point on a body.

    :ivar body: one of the two that touch there
    :ivar push: change of its momentum
    :ivar turn: change of its angular momentum [m]
    """

    body: _MovedBody
    push: complex
    turn: float


class _ImpactPoint(NamedTuple):
    """
    A point of a contact.

    :ivar struct: `cpContact`
    :ivar begins: whether the contact begins in this step
    :ivar levers: on its two bodies
    """

    struct: Any
    begins: bool
    levers: tuple[_Lever, _Lever]

    @property
    def parting(self) -> float:
        """Return the velocity at which the bodies part here, without impulses [m/s]."""
        velocity = 0.0
        for body, push, turn in self.levers:
            velocity += dot(body.velocity, push) + body.spin * turn
        return velocity

    def change_by(self, other: _ImpactPoint) -> float:
        """Return the change of that velocity by an impulse of 1 in another point [1/kg]."""
        change = 0.0
        for body, push, turn in self.levers:
            for lever in other.levers:
                if lever.body is body:
                    change += body.inverse_mass * dot(push, lever.push)
                    change += body.inverse_moment * turn * lever.turn
        return change


def _points_of(contact: Any, bodies: Mapping[Any, _MovedBody]) -> Iterator[_ImpactPoint]:
    """Return the points of a contact."""
    begins: bool = contact.state == lib.CP_ARBITER_STATE_FIRST_COLLISION
    normal = complex(contact.n.x, contact.n.y)
    # Far away a distance can be lost in rounding, and with it the direction.
    for place in range(contact.count if normal else 0):
        point = contact.contacts[place]
        levers = (
            _lever_of(bodies[contact.body_a], -normal, point.r1),
            _lever_of(bodies[contact.body_b], normal, point.r2),
        )
        yield _ImpactPoint(point, begins, levers)


def _lever_of(body: _MovedBody, push: complex, arm: Any) -> _Lever:
    return _Lever(body, push, arm.x * push.imag - arm.y * push.real)
