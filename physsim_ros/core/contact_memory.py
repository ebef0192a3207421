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
What the engine remembers of contacts: the impulses from which its next step starts.

A space built anew from poses and velocities alone has forgotten them, and what rests stirs until
the solver has found them again. Pymunk has no public way to read or give them; this goes the way
of its own pickling, through the structures of its binding.

Law: two spaces built from one memory go on alike to the bit.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from physsim_ros.core.snapshot import ContactMemory
import pymunk
from pymunk._chipmunk_cffi import lib

# ruff: noqa: SLF001


class ShapeIds:
    """
    The engine's numbers of the shapes in a space: its contacts know them by these.

    :param space: where they are
    """

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        self._numbers: dict[Any, int] = {}

    @property
    def following(self) -> int:
        """Return the number that the next shape gets."""
        number: int = lib.cpSpaceGetShapeIDCounter(self._space._space)
        return number

    @following.setter
    def following(self, number: int) -> None:
        lib.cpSpaceSetShapeIDCounter(self._space._space, number)

    def add(self, shapes: Collection[pymunk.Shape]) -> int:
        """Add shapes to the space, and return the number of the first."""
        first = self.following
        self._space.add(*shapes)
        for number, shape in enumerate(shapes, first):
            self._numbers[shape._shape] = number
        return first

    def put_back(self, numbered: Iterable[tuple[int, Collection[pymunk.Shape]]]) -> None:
        """Add shapes under the numbers that they had: those of the first of each collection."""
        # As many at once as follow one another, since each call costs as much as two shapes.
        run: list[pymunk.Shape] = []
        following = self.following
        for first, shapes in numbered:
            if first != following:
                self.add(run)
                run, self.following = [], first
            run += shapes
            following = first + len(shapes)
        self.add(run)

    def remove(self, shapes: Iterable[pymunk.Shape]) -> None:
        """Remove shapes from the space."""
        for shape in shapes:
            del self._numbers[shape._shape]
        self._space.remove(*shapes)

    def contacts(self) -> Iterator[tuple[int, int, Any]]:
        """Yield the contact points of the last step: numbers of the two shapes, lesser first."""
        numbers = self._numbers
        for arbiter in self._space._get_arbiters():
            a, b = numbers[arbiter.a], numbers[arbiter.b]
            if a > b:
                a, b = b, a
            for place in range(arbiter.count):
                yield a, b, arbiter.contacts[place]


def recall(shapes: ShapeIds, ids: Sequence[int], walls: int) -> ContactMemory:
    """
    Return what a space remembers.

    :param shapes: in the space
    :param ids: number of the first shape of each body, in spawn order
    :param walls: number of the first wall
    """
    rows = [(a, b, each.hash, each.jnAcc, each.jtAcc) for a, b, each in shapes.contacts()]
    # The engine lists by address, which is never the same twice.
    rows.sort()
    return ContactMemory(
        ids=np.array(ids, dtype=np.int64),
        walls=walls,
        following=shapes.following,
        pairs=np.array([row[:2] for row in rows], dtype=np.int64).reshape(-1, 2),
        hashes=np.array([row[2] for row in rows], dtype=np.uint64),
        impulses=np.array([row[3:] for row in rows], dtype=np.float64).reshape(-1, 2),
    )


def remind(space: pymunk.Space, shapes: ShapeIds, memory: ContactMemory, dt: float) -> None:
    """
    Give a space that has not stepped yet what another one remembered.

    :param space: its bodies where they were, and without velocities, which are spoiled
    :param shapes: in it, under the numbers that they had
    :param dt: of its steps [s]
    """
    # A step in which nothing moves and nothing is pushed apart has the engine find the contacts.
    gravity, iterations, bias = space.gravity, space.iterations, space.collision_bias
    space.gravity, space.iterations, space.collision_bias = (0.0, 0.0), 1, 1.0
    space.step(dt)
    space.gravity, space.iterations, space.collision_bias = gravity, iterations, bias
    known = {
        (a, b, hash_): impulse
        for (a, b), hash_, impulse in zip(
            memory.pairs.tolist(), memory.hashes.tolist(), memory.impulses.tolist(), strict=True
        )
    }
    for a, b, contact in shapes.contacts():
        contact.jnAcc, contact.jtAcc = known.get((a, b, contact.hash), (0.0, 0.0))
    shapes.following = memory.following
