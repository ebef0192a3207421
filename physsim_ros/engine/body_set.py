# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Body set: the bodies of a space, by name in spawn order.

Pymunk does not wake bodies that overlap a static or kinematic body which is added or moved;
`wake_around` does.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
import itertools
import math

from physsim_ros.engine.body import reach_of, RigidBody, SEAM
from physsim_ros.engine.warm_start import ShapeIds
from physsim_ros.model.transform import Point
import pymunk

EVERYTHING = pymunk.ShapeFilter()


class BodySet:
    """
    Bodies in the engine.

    :param pm_space: Pymunk's space
    :param shapes: numbers of its shapes

    :ivar by_name: the bodies, in spawn order
    """

    def __init__(self, pm_space: pymunk.Space, shapes: ShapeIds) -> None:
        self.by_name: dict[str, RigidBody] = {}
        self._names: dict[pymunk.Body, str] = {}
        self._pm_space = pm_space
        self._shapes = shapes
        self._places: _Places | None = None

    def add_without_shapes(self, rigids: Sequence[RigidBody]) -> None:
        """Add bodies at once; their shapes are added later, under their old numbers."""
        for rigid in rigids:
            self.by_name[rigid.body.name] = rigid
            self._names[rigid.pm_body] = rigid.body.name
        self._pm_space.add(*(rigid.pm_body for rigid in rigids))
        self.note_moved()

    def add(self, rigid: RigidBody) -> None:
        """Add a body; a name that was taken out before keeps its place in the order."""
        self.add_without_shapes([rigid])
        rigid.first_shape = self._shapes.add(rigid.pm_body.shapes)
        self.wake_around(rigid)

    def take_out(self, rigid: RigidBody) -> None:
        """Remove a body from the engine; its name keeps its place in the order."""
        self._shapes.remove(rigid.pm_body.shapes)
        self._pm_space.remove(rigid.pm_body)
        del self._names[rigid.pm_body]
        self.note_moved()

    def note_moved(self) -> None:
        """Note that bodies have moved, come or gone since the last call of `at`."""
        self._places = None

    def at(self, point: Point) -> list[str]:
        """
        Return the bodies that cover a point of the world [m], the last in spawn order first.

        Regions of media come after what is in them.

        Pymunk's own query knows shapes where the last step has compared them; since then stages
        may have moved their bodies, but not in a space that is restored from a checkpoint.
        """
        if self._places is None:
            self._places = _Places(self.by_name.values())
        found = {row: rigid for row, rigid in self._places.near(point) if rigid.covers(point)}
        rows = sorted(found, reverse=True)
        rows.sort(key=lambda row: found[row].body.medium is not None)
        return [found[row].body.name for row in rows]

    def count_near(
        self,
        boxes: Sequence[tuple[float, float, float, float]],
        *,
        most: int,
        without: pymunk.Body | None = None,
        moving_only: bool = False,
    ) -> int:
        """
        Count the pairs of a box and a piece whose box overlaps it.

        :param boxes: left, bottom, right, top of each [m]
        :param most: the count ends once it exceeds this
        :param without: a body whose pieces are left out
        :param moving_only: whether pieces of anchored bodies are left out
        """
        # All other shapes in the engine are those of bodies.
        ignored = {
            *self._pm_space.static_body.shapes,
            *(() if without is None else without.shapes),
        }
        count = 0
        for box in boxes:
            near = set(self._pm_space.bb_query(pymunk.BB(*box), EVERYTHING)) - ignored
            if moving_only:
                near = {shape for shape in near if not _is_anchored(shape)}
            count += len(near)
            if count > most:
                break
        return count

    def touching(self, pm_body: pymunk.Body) -> list[RigidBody]:
        """Return a body and those that touched it in the last step, but not the background."""
        found: list[pymunk.Body] = []
        pm_body.each_arbiter(lambda arbiter: found.extend(arbiter.bodies))
        names = dict.fromkeys(self._names[each] for each in found if each in self._names)
        return [self.by_name[name] for name in names]

    def wake_around(self, rigid: RigidBody, touching: Sequence[RigidBody] = ()) -> None:
        """
        Wake what an anchored or kinematic body overlaps, and what it touched before.

        :param touching: bodies that it touched before it was moved
        """
        if not rigid.body.dynamic:
            wake_bodies(each.pm_body for each in touching)
            wake_overlapping(self._pm_space, rigid.pm_body)


class _Places:
    """
    The places of bodies, until one moves: a hierarchical hash grid (Mirtich 1996).

    A body is in the cell of its engine's origin, in the level whose cells are as wide as its
    reach, or up to twice as wide.

    :param rigids: the bodies, in spawn order
    """

    def __init__(self, rigids: Iterable[RigidBody]) -> None:
        # By level, column and row.
        self._cells: dict[tuple[int, int, int], list[tuple[int, Point, float, RigidBody]]] = {}
        for row, rigid in enumerate(rigids):
            x, y = rigid.pm_body.position
            # A share for the rounding of places, 1 nm at 1 000 km.
            reach = reach_of(rigid.body) * (1.0 + 1e-12) + SEAM + 1e-15 * (abs(x) + abs(y))
            cell = _cell_of(x, y, math.frexp(reach)[1])
            self._cells.setdefault(cell, []).append((row, (x, y), reach, rigid))
        self._levels = {level for level, _, _ in self._cells}

    def near(self, point: Point) -> Iterator[tuple[int, RigidBody]]:
        """Yield the bodies that may cover a point of the world [m], each with its row."""
        for level in self._levels:
            _, column, row = _cell_of(*point, level)
            for cell in itertools.product((level,), _around(column), _around(row)):
                for row, center, reach, rigid in self._cells.get(cell, ()):
                    if math.dist(center, point) <= reach:
                        yield row, rigid


def _cell_of(x: float, y: float, level: int) -> tuple[int, int, int]:
    """Return level, column and row of a place [m]; a cell is 2 to the level wide [m]."""
    return level, math.floor(math.ldexp(x, -level)), math.floor(math.ldexp(y, -level))


def _around(number: int) -> range:
    """Return a number and its neighbours."""
    return range(number - 1, number + 2)


def _is_anchored(shape: pymunk.Shape) -> bool:
    """Return whether a shape is that of an anchored body."""
    return shape.body is None or shape.body.body_type == pymunk.Body.STATIC


def wake_bodies(bodies: Iterable[pymunk.Body]) -> None:
    """Wake dynamic bodies, and with each its whole island."""
    for body in bodies:
        if body.is_sleeping:
            body.activate()


def wake_overlapping(pm_space: pymunk.Space, body: pymunk.Body) -> None:
    """Wake the bodies that overlap one: the engine compares static shapes with awake ones only."""
    hits = (hit.shape for shape in body.shapes for hit in pm_space.shape_query(shape))
    wake_bodies(shape.body for shape in hits if shape is not None and shape.body is not None)
