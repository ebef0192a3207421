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
Loads: what leans on a machine is carried by all of it.

The engine solves contacts and joints in turns, and stops. What it gives the plank of a bridge by
a ball that is a hundred times as heavy, `linkage` takes back from the plank alone, and the ball
would sink into it, step by step. Here contacts that close are given what it takes to keep them
open, where each body yields as far as all that it is joined to lets it.

Laws: bodies only push each other apart; momentum is kept, and no energy of motion is given that
was not there before; while no contact closes, nothing is changed; what is done depends on the
state alone, in whatever order the engine lists contacts.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.articulation.solver import Linkage
from physsim_ros.engine.batch_io import EngineArrays, Touching
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.islands import Rows
from physsim_ros.model.arrays import Floats
import pymunk

# Contacts that close more slowly than this are left to the engine [m/s].
_SLOWEST = 1e-3
# What may be left of that [m/s].
_ENOUGH = 1e-6
# So many contacts are solved at once, those that close fastest.
_MOST = 48
# A contact that yields by less than this share of what it would without joints is held.
_HELD = 1e-7
# So often friction goes from contact to contact.
_SWEEPS = 8
# So little give lets two contacts say the same.
_GIVE = 1e-9
# What is so much less than the rest is nothing.
_NOTHING = 1e-12


class _Pushes(NamedTuple):
    """
    How contacts push.

    :ivar sides: (c, 2) the places of the two bodies
    :ivar pushes: (c, 2, 3) float64: directions and moments on both
    """

    sides: Rows
    pushes: Floats

    def speeds(self, twists: Floats) -> Floats:
        """Return (c,) float64: how fast they open [m/s], from (m + 1, 3) velocities."""
        speeds: Floats = np.einsum('csj,csj->c', self.pushes, twists[self.sides])
        return speeds

    def lightness(self, inverse: Floats) -> Floats:
        """Return (c,) float64: what each makes of itself without joints [1/kg]."""
        lightness: Floats = (self.pushes**2 * inverse[self.sides]).sum(axis=(1, 2))
        return lightness

    def only(self, rows: Rows) -> _Pushes:
        """Return some of them."""
        return _Pushes(self.sides[rows], self.pushes[rows])

    def beside(self, others: _Pushes) -> _Pushes:
        """Return these and others."""
        pushes = np.concatenate((self.pushes, others.pushes))
        return _Pushes(np.concatenate((self.sides, others.sides)), pushes)


class Loads:
    """
    The contacts of what is joined.

    :param arrays: of the space
    :param listed: the bodies in the engine's listing
    :param places: (k + 1,) the places in it of those that are joined, then the background's
    """

    def __init__(
        self, arrays: EngineArrays, listed: Sequence[RigidBody | None], places: Rows
    ) -> None:
        self._arrays = arrays
        self._places = places
        count = len(listed)
        ids = np.array([0 if each is None else each.engine.id for each in listed], np.uint64)
        self._ascending = np.argsort(ids)
        self._ids = ids[self._ascending]
        self._member = np.zeros(count + 1, np.bool_)
        self._member[places[:-1]] = True
        # Mass, mass, moment, and their inverses; zero for what forces do not move.
        self._inertia, self._inverse = np.zeros((2, count + 1, 3))
        # The greatest distance of a point from the centre of mass [m].
        self._reach = np.zeros(count + 1)
        # The roots of friction and elasticity, which a pair multiplies.
        self._surfaces = np.zeros((count + 1, 2))
        for place, rigid in enumerate(listed):
            if rigid is not None:
                self._surfaces[place] = _surface(rigid.engine)
                self._reach[place] = rigid.body.shape.form.outer
                if not rigid.body.fixed:
                    mass, moment = rigid.engine.mass, rigid.engine.moment
                    self._inertia[place] = mass, mass, moment
                    self._inverse[place] = 1 / mass, 1 / mass, 1 / moment

    def carry(
        self,
        linkage: Linkage,
        states: Floats,
        before: Floats,
        engine: Floats,
        background: pymunk.Body,
    ) -> bool:
        """
        Move velocities so that no contact closes.

        :param linkage: by which joints are held
        :param states: (m + 1, 6) float64: poses and velocities in the listing, then the
            background; kept up to date
        :param before: (m + 1, 3) float64: the velocities before the step
        :param engine: (m + 1, 3) float64: those that the engine has found
        :param background: the engine's own
        :return: whether any has been moved
        """
        changed = np.abs(states[:, 3:] - engine)
        moved = changed[:, :2].max(axis=1) + changed[:, 2] * self._reach
        if not (np.isfinite(moved).all() and (moved > _SLOWEST / 4).any()):
            return False
        touching = self._touching()
        if not len(touching.bodies):
            return False
        contacts = _directed(touching, states, touching.normals)
        speeds = contacts.speeds(states[:, 3:])
        left = np.minimum(contacts.speeds(engine), 0.0)
        closing = speeds < left - _SLOWEST
        if not closing.any():
            return False
        self._surfaces[-1] = _surface(background)
        friction, elasticity = self._surfaces[touching.bodies].prod(axis=1).T
        bounced = np.maximum(-elasticity * contacts.speeds(before), 0.0)
        resting = np.where(closing, 0.0, np.minimum(speeds, 0.0))
        wanted = np.where(closing, bounced, resting)
        rows = self._concerned(touching.bodies, closing, wanted - speeds)
        across = touching.normals[:, ::-1] * (-1.0, 1.0)
        pressing, rubbing = contacts.only(rows), _directed(touching, states, across).only(rows)
        changes, shared = self._answers(linkage, pressing.beside(rubbing), len(states))
        # What cannot yield on either side is not pushed at: that would be rounding times rounding.
        yields = shared.diagonal()[: len(rows)] > _HELD * pressing.lightness(self._inverse)
        twists, slips = states[:, 3:].copy(), rubbing.speeds(states[:, 3:])
        pushed = np.flatnonzero(np.abs(changes).max(axis=(1, 2)))
        most = max(self._energy(pushed, each) for each in (before, twists))
        for aim in (wanted, resting):
            short = np.where(yields, (aim - speeds)[rows], -np.inf)
            given = _given(shared, short, slips, friction[rows])
            states[:, 3:] = twists + changes @ given
            # Against what joints hold fast, their errors would come back as blows: then nothing
            # bounces, or all is left to the engine.
            if self._energy(pushed, states[:, 3:]) <= most:
                linkage.take(given)
                return True
        states[:, 3:] = twists
        return False

    def _energy(self, rows: Rows, twists: Floats) -> float:
        """Return that of the motion of some bodies [J], at (m + 1, 3) velocities."""
        return float((self._inertia[rows] * twists[rows] ** 2).sum() / 2)

    def _concerned(self, sides: Rows, closing: NDArray[np.bool_], short: Floats) -> Rows:
        """Return the contacts to solve: what closes, and what else touches the same bodies."""
        pushed = np.zeros(len(self._inverse), np.bool_)
        pushed[sides[closing]] = True
        # What does not yield hands nothing on.
        pushed &= self._inverse[:, 0] > 0.0
        rows = np.flatnonzero(pushed[sides].any(axis=1))
        if len(rows) > _MOST:
            worst = np.argsort(-short[rows], kind='stable')[:_MOST]
            rows = np.sort(rows[worst])
        return rows

    def _answers(self, linkage: Linkage, contacts: _Pushes, count: int) -> tuple[Floats, Floats]:
        """
        Return what pushes do, with what the joints make of them.

        :param count: of bodies, with the background
        :return: (count, 3, c) float64: how each changes velocities; (c, c) float64: how it changes
            the speed of each contact
        """
        changes = np.zeros((count, 3, len(contacts.sides)))
        column = np.arange(len(contacts.sides))
        for side in (0, 1):
            rows = contacts.sides[:, side]
            changes[rows, :, column] += contacts.pushes[:, side] * self._inverse[rows]
        joined = changes[self._places]
        linkage.respond(joined)
        changes[self._places] = joined
        return changes, np.einsum('csj,csjk->ck', contacts.pushes, changes[contacts.sides])

    def _touching(self) -> Touching:
        """Return where machines touch, and what touches them touches, in an order of its own."""
        touching = self._arrays.touching()
        if not len(touching.bodies):
            return touching
        sides = self._places_of(touching.bodies)
        near = self._member.copy()
        near[sides[self._member[sides].any(axis=1)]] = True
        near[-1] = False
        wanted = near[sides].any(axis=1)
        sides = sides[wanted]
        points, normals = touching.points[wanted], touching.normals[wanted]
        swapped = sides[:, 0] > sides[:, 1]
        sides[swapped] = sides[swapped, ::-1]
        normals[swapped] *= -1.0
        order = np.lexsort((*normals.T, *points.T, *sides.T))
        return Touching(sides[order], points[order], normals[order])

    def _places_of(self, ids: Rows) -> Rows:
        """Return the places of bodies in the listing, and one more for all others."""
        at = np.minimum(np.searchsorted(self._ids, ids), len(self._ids) - 1)
        return np.where(self._ids[at] == ids, self._ascending[at], len(self._ids))


def _surface(body: pymunk.Body) -> tuple[float, float]:
    """Return the roots of friction and elasticity; what has no shapes touches nothing."""
    shape = next(iter(body.shapes), None)
    return (0.0, 0.0) if shape is None else (shape.friction, shape.elasticity)


def _directed(touching: Touching, states: Floats, directions: Floats) -> _Pushes:
    """Return how contacts push along (c, 2) directions: the first body back, the second forth."""
    arms = touching.points[:, None, :] - states[touching.bodies, :2]
    pushes = np.empty((len(arms), 2, 3))
    pushes[:, 0, :2], pushes[:, 1, :2] = -directions, directions
    pushes[:, :, 2] = arms[..., 0] * pushes[..., 1] - arms[..., 1] * pushes[..., 0]
    return _Pushes(touching.bodies, pushes)


def _given(shared: Floats, short: Floats, slips: Floats, friction: Floats) -> Floats:
    """
    Return (2 c,) float64: what contacts give along their normals, then across them [N s].

    :param shared: (2 c, 2 c) float64: how each changes the speed of each
    :param short: (c,) float64: how much faster they are to open, at least [m/s]
    :param slips: (c,) float64: how fast they slip [m/s]
    :param friction: (c,) float64
    """
    count = len(short)
    pressed = _least(shared[:count, :count], short)
    slips = slips + shared[count:, :count] @ pressed
    rubbed = _within(shared[count:, count:], -slips, friction * pressed)
    return np.concatenate((pressed, rubbed))


def _least(shared: Floats, short: Floats) -> Floats:
    """
    Return (c,) float64 that are not below zero, and above it only where nothing is left over.

    They are the least of a convex function, found by active sets: C. L. Lawson and R. J. Hanson,
    Solving Least Squares Problems, 1974, chapter 23.

    :param shared: (c, c) float64: what each makes of each
    :param short: (c,) float64: what there is to make, at least
    """
    count = len(short)
    shared = (shared + shared.T) / 2
    shared[np.diag_indices(count)] *= 1.0 + _GIVE
    given, active = np.zeros(count), np.zeros(count, np.bool_)
    for _ in range(3 * count):
        left = np.where(active, 0.0, short - shared @ given)
        most = int(left.argmax())
        if left[most] <= _ENOUGH:
            break
        active[most] = True
        # Each time at least one less pushes.
        for _ in range(count):
            rows = np.flatnonzero(active)
            aim = np.linalg.solve(shared[np.ix_(rows, rows)], short[rows])
            wrong = aim <= 0.0
            if not wrong.any():
                given[rows] = aim
                break
            # As far as none goes below zero; what comes there pushes no more.
            now = given[rows]
            way = float((now[wrong] / (now[wrong] - aim[wrong])).min())
            given[rows] = now + way * (aim - now)
            active[rows[wrong & (given[rows] <= _NOTHING * given.max())]] = False
            given[~active] = 0.0
    return given


def _within(shared: Floats, short: Floats, most: Floats) -> Floats:
    """
    Return (c,) float64 that leave nothing short, as far as none is greater than its most.

    :param shared: (c, c) float64: what each makes of each
    :param short: (c,) float64: what there is to make
    :param most: (c,) float64
    """
    given = np.zeros_like(short)
    for _ in range(_SWEEPS):
        for row, own in enumerate(shared.diagonal()):
            if own > 0.0:
                left = short[row] - shared[row] @ given
                given[row] = min(max(given[row] + left / own, -most[row]), most[row])
    return given
