# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The space that a world steps, and the spaces that replace it at checkpoints.

Law: a world that goes on from its checkpoint and one that resumes it later make the same bits. The
engine has a past that cannot be read, as the order in which it has found contacts; a space that is
built from a checkpoint has none. So the world itself goes on in a space built from each of them.
"""

from __future__ import annotations

from typing import NamedTuple

from physsim_ros.engine.body_pool import BodyPool
from physsim_ros.engine.checkpoint import restore_checkpoint, take_checkpoint
from physsim_ros.engine.space import Space
from physsim_ros.model.checkpoint import Checkpoint
from physsim_ros.model.settings import WorldSettings


class LiveSpace:
    """
    The space that a world steps.

    :param settings: of the world
    :param dt: of a step [s]

    :ivar space: the present one
    """

    def __init__(self, settings: WorldSettings, dt: float) -> None:
        self.space = Space(settings, dt)
        self._dt = dt
        self._pool = BodyPool()
        # Of the present space, if it was built from a checkpoint just now.
        self._fresh: _Fresh | None = None

    def renew(self, step: int) -> Checkpoint:
        """
        Replace the space by one that is built from its checkpoint, and return that.

        :param step: steps that the world has made
        """
        if self._fresh is not None and self._fresh.suits(self.space, step):
            return self._fresh.key
        key = take_checkpoint(self.space, step)
        space = restore_checkpoint(key, self._dt, pool=self._pool.bodies)
        _copy_reports(self.space, space)
        self._replace(space, BodyPool(self.space))
        return key

    def resume(self, key: Checkpoint, *, going_over: bool) -> None:
        """
        Replace the space by one that is built from a checkpoint.

        :param going_over: whether the world is at that moment now, with the same bodies; then
            the contacts of the frame so far are kept
        """
        space = restore_checkpoint(key, self._dt)
        if going_over:
            _copy_reports(self.space, space)
        self._replace(space, BodyPool())

    def begin(self, key: Checkpoint) -> None:
        """
        Replace the space by one that begins with a checkpoint, made of a saved state.

        :raises BadProperty: springs are too stiff for the steps; nothing is changed
        """
        space = restore_checkpoint(key, self._dt)
        space.joints.check_springs(
            {name: rigid.body for name, rigid in space.bodies.by_name.items()}
        )
        self._replace(space, BodyPool())
        self._fresh = _Fresh(key, space, space.changes)

    def build_bodies(self, count: int) -> None:
        """Build a number of bodies for the next `renew`."""
        self._pool.build_bodies(self.space.table.scene, count)

    def _replace(self, space: Space, pool: BodyPool) -> None:
        self.space, self._pool, self._fresh = space, pool, None


class _Fresh(NamedTuple):
    """
    A checkpoint, and the space that was built from it.

    :ivar changes: of the space then
    """

    key: Checkpoint
    space: Space
    changes: int

    def suits(self, space: Space, step: int) -> bool:
        """Return whether a space is still as it was built, at a step."""
        as_built = self.space is space and space.age == 0 and space.changes == self.changes
        return as_built and self.key.step == step


def _copy_reports(old: Space, new: Space) -> None:
    """Copy what an older space of the same bodies has reported of the frame so far."""
    report = new.pipeline.contact_report
    report.copy_sums(old.pipeline.contact_report, old.table.ids, new.table.ids)
    new.broken = old.broken
