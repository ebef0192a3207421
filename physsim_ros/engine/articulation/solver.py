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

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
import itertools

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.articulation.block_tridiagonal import Equations
from physsim_ros.engine.articulation.jacobian import Restraints
from physsim_ros.engine.islands import Graph, meetings
from physsim_ros.engine.joints import EngineJoint, FASTEST_CORRECTION, islands
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
import pymunk

# What hangs together and is no more work than so many rows of which each meets each, which take
# twenty milliseconds, is solved at once; what is more, part by part: hundreds of pins on one body.
MOST_ROWS = 600
# Nor is it looked at how much work there is with more pairs of joints on the same body.
_MOST_PAIRS = 1_000_000
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
    :param places: of the engine's bodies in the rows that states come in
    :param background: the row of all others
    :param dt: of a step [s]
    """

    def __init__(
        self,
        joints: Sequence[EngineJoint],
        places: Mapping[pymunk.Body, int],
        background: int,
        dt: float,
    ) -> None:
        held = [number for number, each in enumerate(joints) if each.exact]
        self._dt = dt
        self._systems: list[_System] = []
        for groups in _stages(held, joints):
            stage = [joints[number] for number in itertools.chain(*groups)]
            self._systems.append(_System(stage, groups, places, background))

    def hold(self, states: Floats) -> bool:
        """
        Move velocities to where the joints will be closed at the end of the coming step.

        :param states: (m + 1, 6) float64: poses and velocities of the bodies, then the
            background; kept up to date
        :return: whether there was anything to hold
        """
        for system in self._systems:
            system.hold(states, self._dt)
        return bool(self._systems)

    def respond(self, changes: Floats) -> None:
        """
        Add to changes of velocities what the joints make of them, as they are held now.

        :param changes: (m + 1, 3, c) float64: c of each body, then of the background; kept up to
            date
        """
        for system in self._systems:
            system.respond(changes)

    def take(self, shares: Floats) -> None:
        """Count what `respond` was told of as given, so much of each change, (c,) float64."""
        for system in self._systems:
            system.take(shares)

    def write_impulses(self, impulses: Floats) -> None:
        """Write what each joint of the space has given since it was held, (j,) float64 [N s]."""
        for system in self._systems:
            system.write_impulses(impulses)

    def redundant(self, states: Floats) -> set[tuple[int, int]]:
        """
        Return what says nothing new: number of the joint, and which of its constraints.

        The engine hands impulses round and round among joints that say the same, more of them at
        each step.

        :param states: (m + 1, 6) float64: poses and velocities of the bodies, then the background
        """
        return {each for system in self._systems for each in system.redundant(states)}


def _stages(held: Sequence[int], joints: Sequence[EngineJoint]) -> list[list[list[int]]]:
    """
    Part the joints into what is solved one after the other.

    :param held: numbers of the joints
    :return: for each stage its joints, in groups that hang together
    """
    stages: list[list[list[int]]] = []
    for island in islands(joints, held):
        for stage, part in enumerate(_parts(island, joints)):
            if stage == len(stages):
                stages.append([])
            # A part of what hangs together may not.
            stages[stage] += [part] if len(part) == len(island) else islands(joints, part)
    return stages


def _parts(island: list[int], joints: Sequence[EngineJoint]) -> list[list[int]]:
    """Part joints that hang together, where to solve all at once would be too much work."""
    rows = [_ROWS[joints[number].joint.kind] for number in island]
    if sum(rows) <= MOST_ROWS or _work(island, rows, joints) <= MOST_ROWS**3:
        return [island]
    parts: list[list[int]] = [[]]
    room = MOST_ROWS
    for number, count in zip(island, rows, strict=True):
        if count > room:
            parts.append([])
            room = MOST_ROWS
        parts[-1].append(number)
        room -= count
    return parts


def _work(island: Sequence[int], rows: Sequence[int], joints: Sequence[EngineJoint]) -> float:
    """Return what it takes to solve joints at once: cubes of the rows that come side by side."""
    ends = [
        (body, place)
        for place, number in enumerate(island)
        for body in (joints[number].ends.a, joints[number].ends.b)
        if body.body_type == pymunk.Body.DYNAMIC
    ]
    names = {body: name for name, body in enumerate(dict(ends))}
    bodies, places = np.array([(names[body], place) for body, place in ends], np.intp).T
    if (np.bincount(bodies) ** 2).sum() > _MOST_PAIRS:
        return np.inf
    levels = Graph(*meetings(bodies, places), len(island)).from_end(0)
    count = np.array(rows)
    return float(sum(int(count[level].sum()) ** 3 for level in levels))


@dataclass(slots=True, eq=False)
class _Held:
    """
    How the rows of joints are held in a step.

    :ivar pushes: (2 r, 3) float64: how each row pushes its first body, then its second
    :ivar moves: (2 r, 3) float64: how that moves them
    :ivar shared: (l,) float64: of the equations
    :ivar active: (r,) bool: whether a row holds
    :ivar given: (r,) float64 [N s, N m s]
    :ivar answers: (r, c) float64: the same, to each change that was asked of last
    """

    pushes: Floats
    moves: Floats
    shared: Floats
    active: NDArray[np.bool_]
    given: Floats
    answers: Floats = field(default_factory=lambda: np.empty((0, 0)))


class _System:
    """
    Joints that are solved at once.

    :param joints: these, group by group
    :param groups: their numbers in the space, those together that hang together
    :param places: as in `Linkage`
    :param background: as in `Linkage`
    """

    def __init__(
        self,
        joints: Sequence[EngineJoint],
        groups: Sequence[Sequence[int]],
        places: Mapping[pymunk.Body, int],
        background: int,
    ) -> None:
        self._restraints = restraints = Restraints(joints, places, background)
        self._numbers = np.array([*itertools.chain(*groups)], np.intp)
        self._held: _Held | None = None
        self._limited = bool(restraints.limits.any())
        sizes = [len(group) for group in groups]
        group_of = np.repeat(np.arange(len(groups)), sizes)[restraints.owner]
        ends = np.cumsum(np.bincount(group_of))[:-1]
        # Rows meet that push the same body.
        moving = np.flatnonzero(restraints.inverse.any(axis=1))
        self._equations = Equations(
            np.split(np.argsort(group_of, kind='stable'), ends),
            *meetings(restraints.sides[moving], moving),
            len(restraints.owner),
        )

    def hold(self, states: Floats, dt: float) -> None:
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
        self._held = _Held(pushes, moves, shared, active, given)

    def respond(self, changes: Floats) -> None:
        """Add what the joints make of changes; see `Linkage.respond`."""
        held, sides = self._known(), self._restraints.sides
        each = np.einsum('ij,ijc->ic', held.pushes, changes[sides])
        first, second = np.split(each, 2)
        held.answers = self._equations.solve(held.shared, -first - second, held.active)
        both = np.concatenate((held.answers, held.answers))
        np.add.at(changes, sides, held.moves[:, :, None] * both[:, None, :])

    def take(self, shares: Floats) -> None:
        """Count answers as given; see `Linkage.take`."""
        held = self._known()
        held.given += held.answers @ shares

    def write_impulses(self, impulses: Floats) -> None:
        """Write what each joint has given: what its rows give together."""
        given = self._known().given
        total = np.bincount(self._restraints.owner, given * given, len(self._numbers))
        impulses[self._numbers] = np.sqrt(total)

    def _known(self) -> _Held:
        assert self._held is not None  # noqa: S101 - what has been held
        return self._held

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
