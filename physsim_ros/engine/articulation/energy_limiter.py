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
The balance of energy: what is joined gains none that nothing gives it.

Joints are held by moving velocities, step by step, to where gaps close. Where joints contradict
each other, or a small turn moves what is far out on a long line, that can push harder than the
true forces would, again and again, and a machine begins to run by itself. Here the energy of all
that moves is compared with what it was, and the excess is taken out of the motion of what gained.

Laws: nothing is taken where energy is within what it is uncertain by, a step's worth of the
forces' power; momentum is kept, since motion against the centre of mass is slowed first, and the
drift of what hangs together only where something from outside has changed it, save where the
background holds; where a motor, a wrench or a commanded body drives, nothing is taken.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import math

import numpy as np
from physsim_ros.engine.articulation.jacobian import Restraints
from physsim_ros.engine.joints import EngineJoint, islands, springs_of
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.joints import JointKind
import pymunk

# Of an energy, what is rounding.
_ROUNDING = 1e-12
# By so much of itself may a speed differ that is the same.
_SAME = 1e-9
# So often is what has been slowed looked at again, at most.
_ROUNDS = 6


class Balance:
    """
    What a world with joints has of energy, and may have.

    :param joints: of the space
    :param places: of the engine's bodies in the listing that states come in
    :param listed: how many that listing has
    :param gravity: [m/s²]
    :param dt: of a step [s]
    """

    def __init__(
        self,
        joints: Sequence[EngineJoint],
        places: Mapping[pymunk.Body, int],
        listed: int,
        *,
        gravity: tuple[float, float],
        dt: float,
    ) -> None:
        self._gravity, self._dt = gravity, dt
        self._inertia = np.zeros((listed + 1, 2))
        for body, place in places.items():
            if body.body_type == pymunk.Body.DYNAMIC:
                self._inertia[place] = body.mass, body.moment
        self._commanded = np.array(
            [place for body, place in places.items() if body.body_type == pymunk.Body.KINEMATIC],
            np.intp,
        )
        self._motors = any(each.joint.kind is JointKind.MOTOR for each in joints)
        # The island of each body and of each joint, counted from 1; 0 is none.
        together = islands(joints)
        self._island = np.zeros(listed + 1, np.intp)
        island_of = np.zeros(len(joints), np.intp)
        # Whether an island hangs on what forces do not move.
        self._held = [False] * len(together)
        for number, island in enumerate(together, 1):
            island_of[island] = number
            for joint in island:
                for body in (joints[joint].ends.a, joints[joint].ends.b):
                    if body.body_type == pymunk.Body.DYNAMIC:
                        self._island[places[body]] = number
                    else:
                        self._held[number - 1] = True
        self._springs = _Springs(joints, island_of, places, listed)
        self._yielding = _Yielding(joints, island_of, places, listed)
        # The least energy there has been since something drove it, and that of each island now.
        self._most = math.inf
        self._own: Floats = np.zeros(len(together) + 1)
        self._fresh = True
        self._states: Floats = np.empty((0, 6))

    def drive(self) -> None:
        """Note that energy has come from outside."""
        self._fresh = True

    def limit_energy(self, states: Floats) -> bool:
        """
        Slow what has gained energy that nothing gave it in the last step.

        :param states: (m + 1, 6) float64: poses and velocities in the engine's listing, then the
            background; kept up to date
        :return: whether velocities have been moved
        """
        if self._motors:
            return False
        driven = self._fresh or bool(states[self._commanded, 3:].any())
        own, unsure = self._look(states)
        if not np.isfinite(own).all():
            # Something has left the range of numbers, and will be removed.
            self._fresh = True
            return False
        gained = np.maximum(own - self._own, 0.0)[1:]
        # What bodies without joints have gained is none of this.
        given = max(0.0, float(own.sum() - self._own.sum() - gained.sum()))
        most = math.inf if driven else self._most + given
        slowed = False
        for _ in range(_ROUNDS):
            excess = float(own.sum()) - most - unsure
            if excess <= 0.0 or not gained.any():
                break
            self._slow(states, gained, excess)
            slowed = True
            # What was thrown apart is uncertain by far more than it is once slowed.
            own, unsure = self._look(states)
            gained = np.maximum(own - self._own, 0.0)[1:]
        total = float(own.sum())
        # What is left was not in their motion, where so: they have been lifted, or strained.
        self._most = min(max(most, total - unsure) if slowed else most, total + unsure)
        self._own, self._states, self._fresh = own, states.copy(), False
        return slowed

    def follow(self, before: Balance) -> None:
        """Go on from a balance of the same bodies with more joints: none gives energy by going."""
        if not before._fresh and len(before._states):
            self._states = before._states
            self._own, _ = self._look(before._states)
            gone = float(before._own.sum() - self._own.sum())
            self._most, self._fresh = before._most - gone, False

    def _look(self, states: Floats) -> tuple[Floats, float]:
        """
        Return what energy there is, and how well that is known.

        :return: (k,) float64: of each island [J]; by how much their sum may be off [J], since
            velocities are those of half a step before or after
        """
        moving, mass = _kinetic(self._inertia, states[:, 3:]), self._inertia[:, 0]
        own = _sums(self._island, moving - mass * (states[:, :2] @ self._gravity), len(self._own))
        pulled, power = self._springs.energy(states)
        strained, yielding = self._yielding.energy(states)
        own += pulled + strained
        power += yielding
        power += math.hypot(*self._gravity) * float(mass @ np.hypot(states[:, 3], states[:, 4]))
        rounding = _ROUNDING * (float(np.abs(own).sum()) + float(moving.sum()))
        return own, self._dt * power + rounding

    def _slow(self, states: Floats, gained: Floats, excess: float) -> None:
        """Take energy [J] out of the islands, from each its share of what they gained."""
        whole = float(gained.sum())
        for island in np.flatnonzero(gained).tolist():
            rows = np.flatnonzero(self._island == island + 1)
            moves, inertia = states[rows], self._inertia[rows]
            owed = excess * float(gained[island]) / whole
            together = drift = np.zeros((len(rows), 3))
            if not self._held[island]:
                together, drift = _together(moves, inertia), self._drift(rows, moves)
            apart, owed = _slower(inertia, moves[:, 3:] - together, owed)
            # What is beyond that came by contacts, which may also move an island as a whole.
            turning, _ = _slower(inertia, together - drift, owed)
            states[rows, 3:] = drift + turning + apart

    def _drift(self, rows: Ints, moves: Floats) -> Floats:
        """Return the (3,) velocity of an island as a whole, if nothing has changed it; else 0."""
        share = self._inertia[rows, 0] / self._inertia[rows, 0].sum()
        now, before = share @ moves[:, 3:5], share @ self._states[rows, 3:5]
        fallen = before + self._dt * np.array(self._gravity)
        if np.hypot(*(now - fallen)) > _SAME * (1.0 + np.hypot(*now)):
            return np.zeros(3)
        return np.append(now, 0.0)


def _slower(inertia: Floats, velocities: Floats, owed: float) -> tuple[Floats, float]:
    """Take energy [J] out of (k, 3) velocities; return them, and what they did not have."""
    energy = float(_kinetic(inertia, velocities).sum())
    if owed >= energy:
        return np.zeros_like(velocities), owed - energy
    return velocities * math.sqrt(1.0 - owed / energy), 0.0


def _kinetic(inertia: Floats, velocities: Floats) -> Floats:
    """
    Return (k,) float64: the energy of each body's motion [J].

    :param inertia: (k, 2) float64: masses and moments
    :param velocities: (k, 3) float64
    """
    mass, moment = inertia.T
    speed2 = velocities[:, 0] ** 2 + velocities[:, 1] ** 2
    energy: Floats = (mass * speed2 + moment * velocities[:, 2] ** 2) / 2
    return energy


def _sums(islands: Ints, energies: Floats, count: int) -> Floats:
    """Return (count,) float64: the energy of each island [J]."""
    sums: Floats = np.bincount(islands, energies, count).astype(np.float64)
    return sums


def _together(moves: Floats, inertia: Floats) -> Floats:
    """
    Return the (k, 3) velocities that bodies would have, were they one rigid body.

    :param moves: (k, 6) float64: poses and velocities
    :param inertia: (k, 2) float64: masses and moments
    """
    mass, moment = inertia.T
    whole = float(mass.sum())
    middle, drift = mass @ moves[:, :2] / whole, mass @ moves[:, 3:5] / whole
    arm, speed = moves[:, :2] - middle, moves[:, 3:5] - drift
    turning = float(mass @ (arm[:, 0] * speed[:, 1] - arm[:, 1] * speed[:, 0]))
    turning += float(moment @ moves[:, 5])
    spin = turning / float(mass @ (arm**2).sum(axis=1) + moment.sum())
    return np.column_stack(
        (drift[0] - spin * arm[:, 1], drift[1] + spin * arm[:, 0], np.full(len(mass), spin))
    )


class _Springs:
    """The springs of a space; see `Balance`."""

    def __init__(
        self,
        joints: Sequence[EngineJoint],
        island_of: Ints,
        places: Mapping[pymunk.Body, int],
        listed: int,
    ) -> None:
        self._springs = springs_of(joints)
        numbers = self._springs.numbers
        held = [joints[number] for number in numbers.tolist()]
        self._islands, self._count = island_of[numbers], int(island_of.max(initial=0)) + 1
        self._sides = np.array(
            [[places.get(body, listed) for body in (each.ends.a, each.ends.b)] for each in held],
            np.intp,
        ).reshape(-1, 2)
        self._at = np.array([(each.ends.at_a, each.ends.at_b) for each in held]).reshape(-1, 2, 2)

    def energy(self, states: Floats) -> tuple[Floats, float]:
        """Return what is in the springs of each island [J], and the power of all [W], at most."""
        if not len(self._sides):
            return np.zeros(self._count), 0.0
        ends = states[self._sides]
        cos, sin = np.cos(ends[..., 2]), np.sin(ends[..., 2])
        x, y = self._at[..., 0], self._at[..., 1]
        arm_x, arm_y = cos * x - sin * y, sin * x + cos * y
        apart_x, apart_y = _between(ends[..., 0] + arm_x), _between(ends[..., 1] + arm_y)
        speed_x = _between(ends[..., 3] - ends[..., 5] * arm_y)
        speed_y = _between(ends[..., 4] + ends[..., 5] * arm_x)
        within, pull = self._springs.energy(np.hypot(apart_x, apart_y))
        inside = _sums(self._islands, within, self._count)
        return inside, float(pull @ np.hypot(speed_x, speed_y))


def _between(ends: Floats) -> Floats:
    """Return the difference of what is so at both ends, (k, 2) -> (k,)."""
    difference: Floats = ends[:, 0] - ends[:, 1]
    return difference


class _Yielding:
    """
    The joints that give way; see `Balance`.

    What pulls one open can have back all of that work: while it closes again, its force does it.
    """

    def __init__(
        self,
        joints: Sequence[EngineJoint],
        island_of: Ints,
        places: Mapping[pymunk.Body, int],
        listed: int,
    ) -> None:
        numbers = [
            number
            for number, each in enumerate(joints)
            if each.constraints and not each.exact and each.joint.kind is not JointKind.SPRING
        ]
        held = [joints[number] for number in numbers]
        self._islands, self._count = island_of[numbers], int(island_of.max(initial=0)) + 1
        self._most = np.array([each.joint.properties.max_force for each in held], np.float64)
        self._restraints = Restraints(held, places, listed) if held else None

    def energy(self, states: Floats) -> tuple[Floats, float]:
        """Return what the joints of each island may give back [J], and the power of all [W]."""
        restraints = self._restraints
        if restraints is None:
            return np.zeros(self._count), 0.0
        gaps, pushes = restraints.read(states)
        wide = np.where(restraints.limits, np.maximum(gaps, 0.0), np.abs(gaps))
        speeds = (pushes * states[restraints.sides, 3:]).sum(axis=1).reshape(2, -1).sum(axis=0)
        most = self._most[restraints.owner]
        back = _sums(self._islands[restraints.owner], wide * most, self._count)
        return back, float(most @ np.abs(speeds))
