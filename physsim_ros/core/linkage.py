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
Linkages: joints that are held exactly.

The engine goes from joint to joint a few times a step and stops. What hangs together over many
joints then stretches, beams of pinned boxes bend and break into flutter, and pendulums lose their
energy. Here all joints that hang together are solved at once, after the engine's own attempt,
which has also to do with contacts: their velocities are moved, by the least there is to move, to
where every joint will be closed again at the end of the coming step.

Laws: momentum is kept, since bodies only push each other; ropes and limits only hold back; what
is solved depends on the state alone, nothing is remembered from step to step.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import itertools

import numpy as np
from physsim_ros.core.equations import Equations
from physsim_ros.core.joint_properties import JointKind
from physsim_ros.core.joints import EngineJoint, FASTEST_CORRECTION, islands
from physsim_ros.core.restraints import Restraints
from physsim_ros.core.snapshot import Floats
import pymunk

# What hangs together over more rows is solved part by part: these take three milliseconds.
MOST_ROWS = 600
# So often it is looked at which ropes are taut and which limits are reached.
_ROUNDS = 6
# Below it [m/s, rad/s] nothing moves on into a limit.
_STILL = 1e-9
# The most rows that a joint of a kind has.
_ROWS = {
    JointKind.PIN: 3,
    JointKind.AXLE: 4,
    JointKind.MOTOR: 2,
    JointKind.ROD: 1,
    JointKind.ROPE: 1,
    JointKind.SLIDER: 4,
    JointKind.GEAR: 1,
}


class Linkage:
    """
    The joints that are held exactly.

    :param joints: of the space, in their order; springs, and what gives way, are left out
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
        held = [number for number, each in enumerate(joints) if each.exact]
        self._dt = dt
        # What each joint of the space has given beside the engine in the last step [N s].
        self.impulses: Floats = np.zeros(len(joints))
        self._systems = [
            _System(
                Restraints([joints[number] for number in stage], places, listed), stage, groups
            )
            for stage, groups in _stages(held, joints)
        ]

    def hold(self, states: Floats) -> bool:
        """
        Move velocities to where the joints will be closed at the end of the coming step.

        :param states: (m + 1, 6) float64: poses and velocities in the engine's listing, then the
            background; kept up to date
        :return: whether there was anything to hold
        """
        for system in self._systems:
            system.hold(states, self._dt, self.impulses)
        return bool(self._systems)

    def redundant(self, states: Floats) -> set[tuple[int, int]]:
        """
        Return what says nothing new: number of the joint, and which of its constraints.

        The engine hands impulses round and round among joints that say the same, more of them at
        each step.

        :param states: (m + 1, 6) float64: poses and velocities in the engine's listing, then the
            background
        """
        return {each for system in self._systems for each in system.redundant(states)}


def _stages(
    held: Sequence[int], joints: Sequence[EngineJoint]
) -> list[tuple[list[int], list[list[int]]]]:
    """
    Part the joints into what is solved one after the other.

    :param held: numbers of the joints
    :return: for each stage its joints, and these again in groups that hang together
    """
    stages: list[list[list[int]]] = []
    for island in islands(joints, held):
        parts: list[list[int]] = [[]]
        room = MOST_ROWS
        for number in island:
            rows = _ROWS[joints[number].joint.kind]
            if rows > room:
                parts.append([])
                room = MOST_ROWS
            parts[-1].append(number)
            room -= rows
        for stage, part in itertools.zip_longest(range(len(parts)), parts):
            if stage == len(stages):
                stages.append([])
            # A part of what hangs together may not.
            stages[stage] += islands(joints, part)
    return [([*itertools.chain(*groups)], groups) for groups in stages]


class _System:
    """
    Joints that are solved at once.

    :param restraints: what they keep
    :param numbers: of the joints in the space
    :param groups: of these that hang together
    """

    def __init__(
        self, restraints: Restraints, numbers: Sequence[int], groups: Sequence[Sequence[int]]
    ) -> None:
        self._restraints = restraints
        self._numbers = np.array(numbers, np.intp)
        self._limited = bool(restraints.limits.any())
        members: dict[int, list[int]] = {}
        for row, joint in enumerate(restraints.owner.tolist()):
            members.setdefault(numbers[joint], []).append(row)
        # Rows meet that push the same body.
        on: dict[int, list[int]] = {}
        for side, body in enumerate(restraints.sides.tolist()):
            if restraints.inverse[side].any():
                on.setdefault(body, []).append(side)
        self._equations = Equations(
            [[row for number in group for row in members[number]] for group in groups],
            [pair for sides in on.values() for pair in itertools.product(sides, sides)],
            len(restraints.owner),
        )

    def hold(self, states: Floats, dt: float, impulses: Floats) -> None:
        """Move velocities; see `Linkage.hold`."""
        restraints, equations = self._restraints, self._equations
        gaps, pushes = restraints.read(states)
        moves = pushes * restraints.inverse
        shared = _dot(moves[equations.left], pushes[equations.right])
        wanted = np.minimum(np.maximum(gaps / -dt, -FASTEST_CORRECTION), FASTEST_CORRECTION)
        short = wanted - self._speeds(pushes, states)
        active = ~restraints.limits | (short < -_STILL)
        given = equations.solve(shared, short, active)
        for _ in range(_ROUNDS if self._limited else 0):
            # What pushes where it can only pull lets go; what goes on into its limit is stopped.
            pushed = states.copy()
            self._push(pushed, moves, given)
            left = wanted - self._speeds(pushes, pushed)
            wrong = restraints.limits & active & (given > 0.0)
            missed = restraints.limits & ~active & (left < -_STILL)
            if not (wrong | missed).any():
                break
            active = (active & ~wrong) | missed
            given = equations.solve(shared, short, active)
        given[restraints.limits] = np.minimum(given[restraints.limits], 0.0)
        self._push(states, moves, given)
        # Joint by joint, what its rows give together.
        total = np.bincount(restraints.owner, given * given, len(self._numbers))
        impulses[self._numbers] = np.sqrt(total)

    def redundant(self, states: Floats) -> Iterator[tuple[int, int]]:
        """Yield what says nothing new; see `Linkage.redundant`."""
        restraints, equations = self._restraints, self._equations
        _, pushes = restraints.read(states)
        shared = _dot((pushes * restraints.inverse)[equations.left], pushes[equations.right])
        keeps = ~restraints.limits
        for row in equations.dependent(shared, keeps):
            constraint = int(row >= restraints.angles_from)
            joint = int(restraints.owner[row])
            yield int(self._numbers[joint]), constraint if restraints.has_both[joint] else 0

    def _speeds(self, pushes: Floats, states: Floats) -> Floats:
        """Return how fast each number changes."""
        each = _dot(pushes, states[self._restraints.sides, 3:])
        count = len(each) // 2
        return each[:count] + each[count:]

    def _push(self, states: Floats, moves: Floats, given: Floats) -> None:
        """Give each row's impulse to its bodies."""
        changes = moves * np.concatenate((given, given))[:, None]
        for axis in range(3):
            change = np.bincount(self._restraints.sides, changes[:, axis], len(states))
            states[:, 3 + axis] += change


def _dot(a: Floats, b: Floats) -> Floats:
    """Return (k,) float64: the products of (k, 3) vectors."""
    product: Floats = np.einsum('ij,ij->i', a, b)
    return product
