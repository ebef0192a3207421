# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Warm start: the engine's impulse cache, read for a checkpoint and written to a rebuilt space.

The solver starts a step with the impulses of the step before. A space built anew from poses and
velocities alone does not have them, and what rests moves until the solver has found them again.
Pymunk 7.3 has no public way to read or set them; this goes the way of its own pickling, through
`Space._get_arbiters` and Chipmunk's `cpArbiter.contacts` (`cpContact.jnAcc`, `jtAcc`, `hash`). It
can go when Pymunk reads and writes contact impulses.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.core import dtype_of
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.checkpoint import ImpulseCache
import pymunk
from pymunk._chipmunk_cffi import ffi, lib

# ruff: noqa: SLF001

# The engine's contact point, of which the hash tells the points of a pair apart.
_POINT = dtype_of('cpContact')


class ShapeIds:
    """
    The numbers by which the engine's contacts name the shapes of a space.

    :param pm_space: where they are
    """

    def __init__(self, pm_space: pymunk.Space) -> None:
        self._pm_space = pm_space
        self._numbers: dict[Any, int] = {}

    def __len__(self) -> int:
        return len(self._numbers)

    @property
    def following(self) -> int:
        """Return the number that the next shape gets."""
        number: int = lib.cpSpaceGetShapeIDCounter(self._pm_space._space)
        return number

    @following.setter
    def following(self, number: int) -> None:
        lib.cpSpaceSetShapeIDCounter(self._pm_space._space, number)

    def add(self, shapes: Collection[pymunk.Shape]) -> int:
        """Add shapes to the space, and return the number of the first."""
        first = self.following
        self._pm_space.add(*shapes)
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
        self._pm_space.remove(*shapes)

    def contacts(self, sleeping: Iterable[pymunk.Body] = ()) -> _Points:
        """
        Return the contact points of the last step.

        :param sleeping: sleeping bodies, whose contacts the engine does not list with the others
        """
        listed: dict[Any, Any] = {}
        for body in sleeping:
            body.each_arbiter(lambda arbiter: listed.setdefault(arbiter._arbiter))
        arbiters = [*self._pm_space._get_arbiters(), *listed]
        numbers = [(self._numbers[each.a], self._numbers[each.b]) for each in arbiters]
        # The lesser one first, whichever way round the engine has a pair.
        pairs = np.sort(np.array(numbers, dtype=np.int64).reshape(-1, 2), axis=1)
        blocks = [ffi.buffer(each.contacts, each.count * _POINT.itemsize) for each in arbiters]
        counts = [each.count for each in arbiters]
        points = np.frombuffer(bytearray().join(blocks), dtype=_POINT)
        return _Points(blocks, np.repeat(pairs, counts, axis=0), points)


class _Points(NamedTuple):
    """
    Contact points, as the engine lists them.

    :param blocks: the engine's own memory of the points of each pair
    :param pairs: (k, 2) int64: numbers of the two shapes, the lesser first
    :param points: (k,): a copy of that memory
    """

    blocks: list[Any]
    pairs: Ints
    points: NDArray[Any]

    def scale(self, share: float) -> None:
        """Multiply all impulses by a factor."""
        for impulse in ('jnAcc', 'jtAcc'):
            self.points[impulse] *= share

    def forget(self, numbers: Sequence[int]) -> None:
        """Set the impulses of shapes to zero, by their numbers."""
        parted = np.isin(self.pairs, np.array(numbers, np.int64)).any(axis=1)
        for impulse in ('jnAcc', 'jtAcc'):
            self.points[impulse][parted] = 0.0

    def write(self) -> None:
        """Write the points to the memory of the engine."""
        data, begin = self.points.tobytes(), 0
        for block in self.blocks:
            end = begin + len(block)
            block[:] = data[begin:end]
            begin = end


def scale_impulses(shapes: ShapeIds, share: float) -> None:
    """Scale all cached impulses, from which the engine starts its next step."""
    found = shapes.contacts()
    found.scale(share)
    found.write()


def read_impulses(
    shapes: ShapeIds,
    *,
    sleeping: Iterable[pymunk.Body],
    ids: Sequence[int],
    walls: int,
    without: Sequence[int],
    joints: Floats,
) -> ImpulseCache:
    """
    Return the impulse cache of a space.

    :param shapes: in the space
    :param sleeping: the sleeping bodies
    :param ids: number of the first shape of each body, in spawn order
    :param walls: number of the first wall
    :param without: numbers of the shapes whose impulses count as zero
    :param joints: (c, 2) float64: impulses of the constraints
    """
    found = shapes.contacts(sleeping)
    found.forget(without)
    _, pairs, points = found
    # The engine lists by address, which is never the same twice.
    order = np.lexsort((points['hash'], pairs[:, 1], pairs[:, 0]))
    # A contact that nothing presses has no friction either: it is like one that is found anew, and
    # a rebuilt space has more of them: all that touch, though it has not stepped yet.
    order = order[points['jnAcc'][order] != 0.0]
    points = points[order]
    return ImpulseCache(
        ids=np.array(ids, np.int64),
        walls=walls,
        following=shapes.following,
        pairs=pairs[order],
        hashes=points['hash'].copy(),
        impulses=np.column_stack((points['jnAcc'], points['jtAcc'])),
        joints=joints,
    )


def write_impulses(
    pm_space: pymunk.Space, shapes: ShapeIds, memory: ImpulseCache, dt: float
) -> None:
    """
    Set the cached impulses of a space that has not stepped yet.

    :param pm_space: its bodies where they were, and without velocities, which are spoiled
    :param shapes: in it, under the numbers that they had
    :param dt: of its sub-steps [s]
    """
    # A step in which nothing moves and nothing is pushed apart has the engine find the contacts.
    iterations, bias = pm_space.iterations, pm_space.collision_bias
    pm_space.iterations, pm_space.collision_bias = 1, 1.0
    pm_space.step(dt)
    pm_space.iterations, pm_space.collision_bias = iterations, bias
    found = shapes.contacts()
    known, now = _same(memory, found)
    impulses = np.zeros((len(found.points), 2))
    impulses[now] = memory.impulses[known]
    found.points['jnAcc'], found.points['jtAcc'] = impulses.T
    found.write()
    shapes.following = memory.following


def _same(memory: ImpulseCache, found: _Points) -> tuple[Ints, Ints]:
    """Return the rows of the points that are in both, in the one and in the other."""
    pairs = np.concatenate((memory.pairs, found.pairs))
    hashes = np.concatenate((memory.hashes, found.points['hash']))
    # The same points come to lie side by side, the remembered one first.
    order = np.lexsort((hashes, pairs[:, 1], pairs[:, 0]))
    pairs, hashes = pairs[order], hashes[order]
    one, other, known = order[:-1], order[1:], len(memory.hashes)
    twin = (pairs[1:] == pairs[:-1]).all(axis=1) & (hashes[1:] == hashes[:-1])
    twin &= (one < known) & (other >= known)
    return one[twin], other[twin] - known
