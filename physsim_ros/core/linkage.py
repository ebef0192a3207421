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
Linkages: pins, axles, rods, sliders and gears, held exactly.

The engine goes from joint to joint a few times a step and stops. What hangs together over many
joints then stretches, beams of pinned boxes bend and break into flutter, and pendulums lose their
energy. Here all joints that hang together are solved at once, after the engine's own attempt,
which has also to do with contacts: their velocities are moved, by the least there is to move, to
where every joint will be closed again at the end of the coming step.

Laws: momentum is kept, since bodies only push each other; a joint with a greatest force never
gives more; what is solved depends on the state alone, nothing is remembered from step to step.
"""

from __future__ import annotations

from collections.abc import Sequence
import itertools

import numpy as np
from numpy.typing import NDArray
from physsim_ros.core.equations import Equations
from physsim_ros.core.joint_properties import JointKind
from physsim_ros.core.joints import EngineJoint, FASTEST_CORRECTION
from physsim_ros.core.snapshot import Floats
import pymunk

Rows = NDArray[np.intp]

# What hangs together over more rows is solved part by part: these take three milliseconds.
MOST_ROWS = 600

_PIVOTS = {JointKind.PIN, JointKind.AXLE, JointKind.MOTOR}
_TURNS = {JointKind.PIN, JointKind.SLIDER, JointKind.GEAR}
# How many numbers each kind takes away from its bodies' freedom.
ROWS = {
    JointKind.PIN: 3,
    JointKind.AXLE: 2,
    JointKind.MOTOR: 2,
    JointKind.ROD: 1,
    JointKind.SLIDER: 2,
    JointKind.GEAR: 1,
}


class Linkage:
    """
    The joints that are held exactly.

    :param joints: of the space, in their order; those that are not rigid are left out
    :param places: of the engine's bodies in the listing that states come in
    :param listed: how many that listing has
    :param dt: of a step [s]
    """

    def __init__(
        self,
        joints: Sequence[EngineJoint],
        places: dict[pymunk.Body, int],
        listed: int,
        dt: float,
    ) -> None:
        held = [
            number
            for number, each in enumerate(joints)
            if each.constraints and each.joint.kind in ROWS
        ]
        self._dt = dt
        # What each joint of the space has given beside the engine in the last step [N s].
        self.impulses: Floats = np.zeros(len(joints))
        self._systems = [
            _System(
                [joints[number] for number in group],
                group,
                blocks,
                places,
                listed=listed,
                total=len(joints),
            )
            for group, blocks in _stages(held, joints)
        ]

    def hold(self, state: Floats, room: Floats | None) -> bool:
        """
        Move velocities to where the joints will be closed at the end of the coming step.

        :param state: (m, 6) float64: poses and velocities in the engine's listing; kept up to date
        :param room: (j,) float64: what each joint may still give [N s]; None is no limit
        :return: whether there was anything to hold
        """
        for system in self._systems:
            system.hold(state, self._dt, self.impulses, room)
        return bool(self._systems)


def _stages(
    held: Sequence[int], joints: Sequence[EngineJoint]
) -> list[tuple[list[int], list[list[int]]]]:
    """
    Part the joints into what is solved one after the other.

    :param held: numbers of the joints
    :return: for each stage its joints, and these again in groups that hang together
    """
    stages: list[list[list[int]]] = []
    for island in _islands(held, joints):
        parts: list[list[int]] = [[]]
        room = MOST_ROWS
        for number in island:
            rows = ROWS[joints[number].joint.kind]
            if rows > room:
                parts.append([])
                room = MOST_ROWS
            parts[-1].append(number)
            room -= rows
        for stage, part in itertools.zip_longest(range(len(parts)), parts):
            if stage == len(stages):
                stages.append([])
            stages[stage].append(part)
    return [([*itertools.chain(*groups)], groups) for groups in stages]


def _islands(held: Sequence[int], joints: Sequence[EngineJoint]) -> list[list[int]]:
    """Part joints into groups that have no body in common which forces move."""
    owner: dict[pymunk.Body, list[int]] = {}
    for number in held:
        ends = joints[number].ends
        island = [number]
        for body in (ends.a, ends.b):
            if body.body_type != pymunk.Body.DYNAMIC:
                continue
            other = owner.get(body)
            if other is not None and other is not island:
                # The longer list takes in the shorter one.
                island, other = (other, island) if len(other) > len(island) else (island, other)
                island += other
                for each in other:
                    for end in (joints[each].ends.a, joints[each].ends.b):
                        if owner.get(end) is other:
                            owner[end] = island
            owner[body] = island
        for body in (ends.a, ends.b):
            if body.body_type == pymunk.Body.DYNAMIC:
                owner[body] = island
    unique = {id(island): island for island in owner.values()}
    return sorted((sorted(island) for island in unique.values()), key=lambda island: island[0])


class _System:
    """
    Joints that are solved at once.

    Every row is one number that the joint keeps at zero: how fast it changes is the velocity of
    two points along a direction, and two spins.

    :param joints: that are solved
    :param numbers: of them in the space
    :param groups: of them that hang together
    :param places: of the engine's bodies in the listing
    :param listed: how many that listing has
    :param total: joints in the space
    """

    def __init__(
        self,
        joints: Sequence[EngineJoint],
        numbers: Sequence[int],
        groups: Sequence[Sequence[int]],
        places: dict[pymunk.Body, int],
        *,
        listed: int,
        total: int,
    ) -> None:
        self._total = total
        # The background, which does not move, comes behind the bodies of the listing.
        self._bodies = bodies = listed + 1
        inverse = np.zeros((bodies, 3))
        for each in joints:
            for body in (each.ends.a, each.ends.b):
                if body.body_type == pymunk.Body.DYNAMIC:
                    inverse[places[body]] = 1 / body.mass, 1 / body.mass, 1 / body.moment
        kinds = [each.joint.kind for each in joints]
        self._a = np.array([places.get(each.ends.a, bodies - 1) for each in joints], np.intp)
        self._b = np.array([places.get(each.ends.b, bodies - 1) for each in joints], np.intp)
        self._at_a = np.array([each.ends.at_a for each in joints])
        self._at_b = np.array([each.ends.at_b for each in joints])
        self._axis = np.array([(each.joint.seat.ux, each.joint.seat.uy) for each in joints])
        self._length = np.array([each.joint.seat.length for each in joints])
        self._phase = np.array([each.joint.seat.phase for each in joints])
        self._ratio = np.array(
            [
                each.joint.number('ratio') if each.joint.kind is JointKind.GEAR else 1.0
                for each in joints
            ]
        )

        def of(*chosen: JointKind) -> Rows:
            return np.array([row for row, kind in enumerate(kinds) if kind in chosen], np.intp)

        self._pivots, self._rods = of(*_PIVOTS), of(JointKind.ROD)
        self._sliders, self._turns = of(JointKind.SLIDER), of(*_TURNS)
        # The joint of each row, as `_rows` lists them.
        owner = np.concatenate(
            (self._pivots, self._pivots, self._rods, self._sliders, self._turns)
        )
        self._owner = np.array(numbers, np.intp)[owner]
        self._first, self._second = self._a[owner], self._b[owner]
        self._sides = np.concatenate((self._first, self._second))
        self._inverse = inverse[self._sides]
        self._equations = self._arrange(groups)

    def _arrange(self, groups: Sequence[Sequence[int]]) -> Equations:
        """Find which rows meet: those that push the same body."""
        rows: dict[int, list[int]] = {}
        for row, number in enumerate(self._owner.tolist()):
            rows.setdefault(number, []).append(row)
        on: dict[int, list[int]] = {}
        for side, body in enumerate(self._sides.tolist()):
            if self._inverse[side].any():
                on.setdefault(body, []).append(side)
        return Equations(
            [[row for number in group for row in rows[number]] for group in groups],
            [pair for sides in on.values() for pair in itertools.product(sides, sides)],
            len(self._owner),
        )

    def hold(self, state: Floats, dt: float, impulses: Floats, room: Floats | None) -> None:
        """Move velocities; see `Linkage.hold`."""
        states = np.vstack((state, np.zeros((1, 6))))
        gaps, pushes = self._rows(states)
        twists = states[:, 3:]
        speeds = (pushes * twists[self._sides]).sum(axis=1)
        count = len(gaps)
        wanted = -np.clip(gaps / dt, -FASTEST_CORRECTION, FASTEST_CORRECTION)
        wanted -= speeds[:count] + speeds[count:]
        moves = pushes * self._inverse
        left, right = self._equations.left, self._equations.right
        shared = (moves[left] * pushes[right]).sum(axis=1)
        given = self._equations.solve(shared, wanted)
        # Joint by joint, what its rows give together.
        total = np.sqrt(np.bincount(self._owner, given * given, self._total))
        if room is not None:
            share = np.minimum(1.0, room / np.maximum(total, 1e-300))
            given *= share[self._owner]
            total *= share
        impulses[:] = np.where(
            np.bincount(self._owner, minlength=self._total) > 0, total, impulses
        )
        moves *= np.concatenate((given, given))[:, None]
        for axis in range(3):
            change = np.bincount(self._sides, moves[:, axis], self._bodies)
            state[:, 3 + axis] += change[:-1]

    def _rows(self, states: Floats) -> tuple[Floats, Floats]:
        """
        Return how far each row is from zero, and what it pushes.

        :return: (r,) float64 [m, rad], and (2 r, 3) float64: direction and moment on the first
            body of each row, then on the second
        """
        yaw_a, yaw_b = states[self._a, 2], states[self._b, 2]
        arm_a, arm_b = _turned(self._at_a, yaw_a), _turned(self._at_b, yaw_b)
        apart = states[self._a, :2] + arm_a - states[self._b, :2] - arm_b
        pivots, rods, sliders, turns = self._pivots, self._rods, self._sliders, self._turns

        length = np.hypot(apart[rods, 0], apart[rods, 1])
        along = np.where(
            length[:, None] > 0, apart[rods] / np.maximum(length, 1e-300)[:, None], (1.0, 0.0)
        )
        line = _turned(self._axis[sliders], yaw_b[sliders])
        across = np.column_stack((-line[:, 1], line[:, 0]))
        x, y = np.full((len(pivots), 2), (1.0, 0.0)), np.full((len(pivots), 2), (0.0, 1.0))
        direction = np.concatenate((x, y, along, across))
        owner = np.concatenate((pivots, pivots, rods, sliders))
        # A slider's line turns with the second body, all the way out to where the first one is.
        reach_b = arm_b.copy()
        reach_b[sliders] += apart[sliders]

        count = len(owner)
        rows = count + len(turns)
        pushes = np.zeros((2 * rows, 3))
        pushes[:count, :2], pushes[rows : rows + count, :2] = direction, -direction
        pushes[:count, 2] = _cross(arm_a[owner], direction)
        pushes[rows : rows + count, 2] = -_cross(reach_b[owner], direction)
        pushes[count:rows, 2] = -1.0
        pushes[rows + count :, 2] = self._ratio[turns]

        gaps = np.empty(rows)
        gaps[:count] = (apart[owner] * direction).sum(axis=1)
        rods_from = 2 * len(pivots)
        gaps[rods_from : rods_from + len(rods)] -= self._length[rods]
        gaps[count:] = self._ratio[turns] * yaw_b[turns] - yaw_a[turns] - self._phase[turns]
        return gaps, pushes


def _turned(vectors: Floats, yaw: Floats) -> Floats:
    """Return vectors, (k, 2), each turned counter-clockwise [rad]."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    x, y = vectors.T
    return np.column_stack((cos * x - sin * y, sin * x + cos * y))


def _cross(a: Floats, b: Floats) -> Floats:
    product: Floats = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return product
