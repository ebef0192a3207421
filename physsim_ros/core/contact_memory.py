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
of its own pickling, through the structures of its binding, and nothing else here does.

Law: two spaces built from one memory go on alike to the bit.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from physsim_ros.core.snapshot import ContactMemory
import pymunk
from pymunk._chipmunk_cffi import lib


def recall(
    space: pymunk.Space, bodies: Iterable[pymunk.Body], walls: Sequence[pymunk.Shape]
) -> ContactMemory:
    """
    Return what the space remembers.

    :param bodies: of the world, in spawn order
    :param walls: of the background
    """
    ids = [_id(next(iter(body.shapes))) for body in bodies]
    names = {shape._shape: _id(shape) for shape in space.shapes}  # noqa: SLF001
    pairs: list[tuple[int, int]] = []
    hashes: list[int] = []
    impulses: list[tuple[float, float]] = []
    for arbiter in space._get_arbiters():  # noqa: SLF001
        a, b = names[arbiter.a], names[arbiter.b]
        pair = (a, b) if a < b else (b, a)
        for number in range(arbiter.count):
            contact = arbiter.contacts[number]
            pairs.append(pair)
            hashes.append(contact.hash)
            impulses.append((contact.jnAcc, contact.jtAcc))
    pairs_array = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    hashes_array = np.array(hashes, dtype=np.uint64)
    # The engine lists by address, which is never the same twice.
    order = np.lexsort((hashes_array, pairs_array[:, 1], pairs_array[:, 0]))
    return ContactMemory(
        ids=np.array(ids, dtype=np.int64),
        walls=_id(walls[0]) if walls else 0,
        following=lib.cpSpaceGetShapeIDCounter(space._space),  # noqa: SLF001
        pairs=pairs_array[order],
        hashes=hashes_array[order],
        impulses=np.array(impulses, dtype=np.float64).reshape(-1, 2)[order],
    )


def number_from(space: pymunk.Space, first: int) -> None:
    """Let the shapes that are added next have ids from this one on: contacts know them by it."""
    lib.cpSpaceSetShapeIDCounter(space._space, first)  # noqa: SLF001


def remind(space: pymunk.Space, memory: ContactMemory, dt: float) -> None:
    """
    Give a space that has not stepped yet what another one remembered.

    :param space: its bodies where they were, and without velocities, which are spoiled
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
    names = {shape._shape: _id(shape) for shape in space.shapes}  # noqa: SLF001
    for arbiter in space._get_arbiters():  # noqa: SLF001
        a, b = names[arbiter.a], names[arbiter.b]
        pair = (a, b) if a < b else (b, a)
        for number in range(arbiter.count):
            contact = arbiter.contacts[number]
            contact.jnAcc, contact.jtAcc = known.get((*pair, contact.hash), (0.0, 0.0))
    number_from(space, memory.following)


def _id(shape: pymunk.Shape) -> int:
    identity: int = shape._hashid  # noqa: SLF001
    return identity
