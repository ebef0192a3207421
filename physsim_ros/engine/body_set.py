# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The bodies of a space, by name and by place.

Law: Pymunk does not wake bodies that overlap a static or kinematic body, or a sensor, which is
added or moved; `BodySet.wake_around` does.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from physsim_ros.engine.bodies import reach_of, RigidBody, SEAM
from physsim_ros.engine.broad_phase import PointGrid
from physsim_ros.engine.warm_start import ShapeIds
from physsim_ros.model.transform import Point
import pymunk

_EVERYTHING = pymunk.ShapeFilter()


class BodySet:
    """
    The bodies of a space, by name in spawn order.

    :param pm_space: Pymunk's space
    :param shapes: numbers of its shapes

    :ivar by_name: the bodies, in spawn order
    :ivar background: Pymunk's static body, which has the walls
    """

    def __init__(self, pm_space: pymunk.Space, shapes: ShapeIds) -> None:
        self.by_name: dict[str, RigidBody] = {}
        self._names: dict[pymunk.Body, str] = {}
        self.background = pm_space.static_body
        self._pm_space = pm_space
        self._shapes = shapes
        # The bodies and where they are, until one moves; None if that is not known.
        self._places: tuple[tuple[RigidBody, ...], PointGrid] | None = None

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
            rigids = tuple(self.by_name.values())
            centers = (rigid.pm_body.position for rigid in rigids)
            reaches = (reach_of(rigid.body) + SEAM for rigid in rigids)
            self._places = rigids, PointGrid(centers, reaches)
        rigids, grid = self._places
        near = sorted(grid.near(point), reverse=True)
        found = [rigids[row].body for row in near if rigids[row].covers(point)]
        return [body.name for body in sorted(found, key=lambda body: body.medium is not None)]

    def count_near(
        self,
        boxes: Sequence[tuple[float, float, float, float]],
        *,
        most: int,
        without: RigidBody | None = None,
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
            *self.background.shapes,
            *(() if without is None else without.pm_body.shapes),
        }
        count = 0
        for box in boxes:
            near = set(self._pm_space.bb_query(pymunk.BB(*box), _EVERYTHING)) - ignored
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
        Wake what a sensor, an anchored or kinematic body overlaps, and what it touched before.

        :param touching: bodies that it touched before it was moved
        """
        if not rigid.body.dynamic or rigid.body.sensor:
            wake_bodies(each.pm_body for each in touching)
            # The engine compares static shapes with awake ones only, and sensors wake nobody.
            for shape in rigid.pm_body.shapes:
                hits = (hit.shape for hit in self._pm_space.shape_query(shape))
                wake_bodies(hit.body for hit in hits if hit is not None and hit.body is not None)


def _is_anchored(shape: pymunk.Shape) -> bool:
    """Return whether a shape is that of an anchored body."""
    return shape.body is None or shape.body.body_type == pymunk.Body.STATIC


def wake_bodies(bodies: Iterable[pymunk.Body]) -> None:
    """Wake dynamic bodies, and with each its whole island."""
    for body in bodies:
        if body.is_sleeping:
            body.activate()
