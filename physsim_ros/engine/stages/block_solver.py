# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
not move; with them the nearest contacts, up to `MOST` points: the ground that carries a body which
is hit, and the stack below it. Bodies further away are taken to stay as they are.

**Cost.** Some 300 us for each pair of bodies that hit each other so, and 10 us for all others.

Without it laws 8 (bodies that fall flat) and 21 (elastic polygons keep their energy) fail.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
import itertools
from typing import Any

import numpy as np
from physsim_ros.engine.contacts.contact import Contact
from physsim_ros.engine.contacts.side import Side
from physsim_ros.engine.lcp import solve_lcp
from physsim_ros.engine.plane_vectors import dot
from physsim_ros.engine.stages.impact_propagation import SLOWEST
from physsim_ros.engine.stages.pre_solve_hook import add_pre_solve
from physsim_ros.model.arrays import Floats
import pymunk
from pymunk._chipmunk_cffi import ffi, lib

# ruff: noqa: SLF001 - Chipmunk's contacts have no public way to be written

# Points that are solved together at most: of three boxes on each other and the ground, six are.
MOST = 8

# Places in the numbers of 8 bytes of `struct cpBody` (`include/chipmunk/chipmunk_structs.h` of
# Munk2D as in Pymunk 7.3.1): inverse mass and moment, velocity, force, spin, torque.
_INVERSE_MASS, _INVERSE_MOMENT, _VELOCITY, _FORCE, _SPIN, _TORQUE = 3, 5, 10, 12, 15, 16


class BlockSolver:
    """
    Solves impacts of several points, before the engine does.

    :param space: of the engine
    """

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        # `cpArbiter` of the impacts that have begun in this step.
        self._begun: list[Any] = []
        add_pre_solve(space, self._solve_impacts)

    def add_contact(
        self, arbiter: pymunk.Arbiter, contact: Contact, sides: tuple[Side, Side]
    ) -> None:
        """Add a contact that begins in this step, if it is an impact."""
        a, b = sides
        velocities = (b.velocity_at(point.b) - a.velocity_at(point.a) for point in contact.points)
        if any(-dot(velocity, contact.normal) > SLOWEST for velocity in velocities):
            self._begun.append(arbiter._arbiter)

    def _solve_impacts(self, *_: object) -> None:
        """Solve the impacts of this step."""
        impacts: dict[frozenset[Any], list[Any]] = {}
        for contact in self._begun:
            bodies = frozenset(filter(_moves, (contact.body_a, contact.body_b)))
            impacts.setdefault(bodies, []).append(contact)
        self._begun.clear()
        solved: set[Any] = set()
        for contacts in impacts.values():
            if sum(each.count for each in contacts) > 1 and contacts[0] not in solved:
                nearest, moved = _nearest(contacts)
                solved.update(nearest)
                self._solve(nearest, moved)

    def _solve(self, contacts: Sequence[Any], moved: set[Any]) -> None:
        """
        Set the normal impulses of contacts, and add those of contacts that begin to velocities.

        :param contacts: `cpArbiter`
        :param moved: `cpBody` that their impulses move
        """
        (gx, gy), dt = self._space.gravity, self._space.current_time_step
        # Share of the velocities that the engine keeps before it solves.
        kept = self._space.damping**dt
        if kept == 0.0:
            return
        pairs = [(each.body_a, each.body_b) for each in contacts]
        columns = {body: at for at, body in enumerate(dict.fromkeys(itertools.chain(*pairs)))}
        bodies = [ffi.cast('double *', body) for body in columns]
        inverse = np.array(
            [(each[_INVERSE_MASS],) * 2 + (each[_INVERSE_MOMENT],) for each in bodies]
        )
        # Bodies further away are as heavy as the ground.
        held = inverse * [[body in moved] for body in columns]
        twists = np.array([(each[_VELOCITY], each[_VELOCITY + 1], each[_SPIN]) for each in bodies])
        forces = np.array([(each[_FORCE], each[_FORCE + 1], each[_TORQUE]) for each in bodies])
        free = twists * kept + (forces * held + (gx, gy, 0.0)) * dt
        points = [(each, each.contacts[place]) for each in contacts for place in range(each.count)]
        jacobian = np.array([_row(contact, point, columns) for contact, point in points])
        begins = [_begins(contact) for contact, _ in points]
        # By an impact next to it that has been solved in this step.
        added = np.where(begins, [point.jnAcc for _, point in points], 0.0)
        rates = jacobian @ np.where(held > 0.0, free, twists).ravel()
        matrix = (jacobian * held.ravel()) @ jacobian.T
        rates += [point.bounce for _, point in points] - matrix @ added
        impulses = solve_lcp(matrix, rates)
        if impulses is None:
            return
        for (_, point), impulse in zip(points, impulses.tolist(), strict=True):
            point.jnAcc = impulse
        # The engine applies those of the other contacts itself (`cpArbiterApplyCachedImpulse`).
        changes = np.where(begins, impulses - added, 0.0) @ jacobian
        changes = changes.reshape(-1, 3) * inverse / kept
        for body, (x, y, spin) in zip(bodies, changes.tolist(), strict=True):
            body[_VELOCITY] += x
            body[_VELOCITY + 1] += y
            body[_SPIN] += spin


def _nearest(begun: Sequence[Any]) -> tuple[list[Any], set[Any]]:
    """
    Return the contacts nearest to an impact, and the bodies that their impulses move.

    :param begun: `cpArbiter` between the two bodies of the impact, which are moved in any case
    """
    bodies = [body for body in (begun[0].body_a, begun[0].body_b) if _moves(body)]
    found, moved = dict.fromkeys(begun), set(bodies)
    queue = deque((body, begun[0]) for body in bodies)
    count = sum(each.count for each in begun)
    while queue:
        body, known = queue.popleft()
        listed = itertools.islice(_contacts_of(body, known), MOST)
        others = [other for other in listed if other not in found]
        more = sum(other.count for other in others)
        if count + more > MOST:
            continue
        moved.add(body)
        count += more
        for other in others:
            found[other] = None
            far = other.body_b if other.body_a == body else other.body_a
            if _moves(far) and far not in moved:
                queue.append((far, other))
    return list(found), moved


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


def _row(contact: Any, point: Any, columns: Mapping[Any, int]) -> Floats:
    """Return (3k,) the row of a point in the Jacobian of the velocities at which bodies part."""
    x, y = contact.n.x, contact.n.y
    row = np.zeros((len(columns), 3))
    for body, arm, sign in ((contact.body_a, point.r1, -1.0), (contact.body_b, point.r2, 1.0)):
        row[columns[body]] = sign * x, sign * y, sign * (arm.x * y - arm.y * x)
    return row.ravel()


def _moves(body: Any) -> bool:
    """Return whether forces move a body."""
    moves: bool = ffi.cast('double *', body)[_INVERSE_MASS] > 0.0
    return moves


def _begins(contact: Any) -> bool:
    """Return whether a contact begins in this step."""
    first: bool = contact.state == lib.CP_ARBITER_STATE_FIRST_COLLISION
    return first
