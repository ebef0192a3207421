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
What flies, and what does from now on because something has let go of it.

The engine gives a body its velocity at the end of a step, and half of what accelerates it too
much: what flies leads by that (`Layout.lead`), what is held does not.

Law: true velocities do not jump when a body comes to fly or flies no more; what loses its footing
falls as one.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.batch_io import EngineArrays
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.body_table import Layout
from physsim_ros.engine.stages.support_graph import Footing
from physsim_ros.model.arrays import Floats, Ints
import pymunk

# What a wrench leaves of gravity where it bears a body, by rounding [m/s, rad/s].
ROUNDING = 1e-14


class Settled(NamedTuple):
    """
    What a step begins with.

    :ivar state: (n, 6) float64: poses and velocities of the engine's origins, in spawn order
    :ivar free: (n,) bool: what is in free flight
    :ivar fallen: numbers of the shapes whose contacts hold nothing any more
    """

    state: Floats
    free: NDArray[np.bool_]
    fallen: Ints


class Flight:
    """
    Tells what flies from what does not.

    :param space: of the engine, whose `collision_persistence` is 1
    :param arrays: of it
    :param bodies: in it, by name in spawn order
    """

    def __init__(
        self, space: pymunk.Space, arrays: EngineArrays, bodies: Mapping[str, RigidBody]
    ) -> None:
        self._footing = Footing(space, arrays)
        self._bodies = bodies
        # Those that something has let go of since the last step.
        self._loosened: set[str] = set()
        # What of these hangs together with nothing that stands, in spawn order, and how many
        # changes there had been when it was found.
        self._lost: tuple[int, NDArray[np.bool_]] | None = None

    def let_go(self, rigids: Iterable[RigidBody]) -> None:
        """Let bodies fly from the next step on, unless something else holds them then."""
        self._loosened.update(rigid.body.name for rigid in rigids)

    def forget_loosened(self) -> None:
        """Take what has been let go of as settled."""
        self._loosened.clear()

    def is_unsettled(self, layout: Layout) -> bool:
        """Tell whether anything may begin the next step otherwise than it ended the last."""
        return bool(self._loosened) or bool((layout.free & layout.hung).any())

    def settled(self, layout: Layout, state: Floats, changes: int) -> Settled:
        """
        Return what the next step begins with, whatever has been asked since the last one.

        :param state: (n, 6) float64: what the last one ended with
        :param changes: counts what has been done to the bodies from outside
        """
        free, fallen = layout.free, np.empty(0, np.int64)
        leads = free & ~layout.hung
        if self._loosened:
            lost = self._find_lost(layout, changes)
            leads |= lost
            fallen = self._shape_numbers(lost)
        if not np.array_equal(leads, free):
            state = state.copy()
            state[leads & ~free, 3:] += layout.lead[leads & ~free]
            state[free & ~leads, 3:] -= layout.lead[free & ~leads]
        return Settled(state, leads, fallen)

    def judge(self, layout: Layout, before: Floats, state: Floats) -> None:
        """
        Find which bodies a step only accelerated: those are in free flight.

        :param before: (m, 3) float64: velocities and spins in the engine's listing that it began
            with, less what the air took
        :param state: (n, 6) float64: what it ended with
        """
        after = state[:, 3:]
        flown = before.take(layout.order, axis=0)
        flown += 2.0 * layout.lead
        # Rounding of the same sum in another order, nothing more.
        same = np.abs(flown - after) <= 1e-12 * (1.0 + np.abs(after))
        flies = layout.loose & ~layout.hung
        layout.free = same[:, 0] & same[:, 1] & same[:, 2] & flies

    @staticmethod
    def accelerates(layout: Layout) -> bool:
        """Tell whether anything that flies goes on otherwise than it does now."""
        return bool((np.abs(layout.lead[layout.free]) > ROUNDING).any())

    def _find_lost(self, layout: Layout, changes: int) -> NDArray[np.bool_]:
        """Return (n,) bool: what has lost its footing since the last step."""
        if self._lost is None or self._lost[0] != changes:
            rigids = (self._bodies[name] for name in self._loosened if name in self._bodies)
            loose = [rigid for rigid in rigids if not rigid.body.fixed]
            lost = self._footing.lost(layout.ground, layout.joined, loose)
            self._lost = changes, lost[layout.order]
        return self._lost[1]

    def _shape_numbers(self, rows: NDArray[np.bool_]) -> Ints:
        """Return the engine's numbers of the shapes of some bodies, (n,) bool."""
        rigids = itertools.compress(self._bodies.values(), rows.tolist())
        numbers = (
            range(rigid.first, rigid.first + len(rigid.body.shape.form.pieces)) for rigid in rigids
        )
        return np.fromiter(itertools.chain.from_iterable(numbers), np.int64)
