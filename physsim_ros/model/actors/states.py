# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The states of the actors of a world: when they started, and how many points they reached."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np
from physsim_ros.model.arrays import Ints
from physsim_ros.model.robot_states import NEVER


class ActorState(NamedTuple):
    """
    The state of one actor; `ActorStates` has its fields.

    In a saved state, `begun` counts from the moment of saving.
    """

    begun: int
    reached: int

    def shifted(self, steps: int) -> Self:
        """Return the state in a world that counts its steps from so many earlier."""
        return self if self.begun == NEVER else self._replace(begun=self.begun + steps)


# Of an actor that waits for its start.
WAITING = ActorState(NEVER, 0)


class ActorStates(NamedTuple):
    """
    The states of a actors, in the order of the scene.

    :ivar begun: (a,) int64: step at which it starts, or started; NEVER where it waits for a
        gate or a distance
    :ivar reached: (a,) int64: count of the points that a pedestrian has reached; 0 of a path
    """

    begun: Ints
    reached: Ints

    @classmethod
    def of(cls, actors: Sequence[ActorState]) -> ActorStates:
        """Return the states of actors; of none the same value, which checkpoints share."""
        if not actors:
            return NO_ACTORS
        return cls(*(np.array(column, np.int64) for column in zip(*actors, strict=True)))

    @property
    def nbytes(self) -> int:
        """Memory of the arrays [bytes]."""
        return sum(column.nbytes for column in self)

    def rows(self) -> list[ActorState]:
        """Return the state of each actor."""
        return [ActorState(*row) for row in zip(*(each.tolist() for each in self), strict=True)]


NO_ACTORS = ActorStates(np.empty(0, np.int64), np.empty(0, np.int64))
