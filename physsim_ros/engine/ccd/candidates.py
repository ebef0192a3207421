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

"""Fast bodies: found before a step, and handed to the sweep if they could meet anything."""

from __future__ import annotations

from collections.abc import Mapping
import itertools

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.batch_io import EngineArrays
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.body_table import Layout
from physsim_ros.engine.ccd import continuous
from physsim_ros.engine.ccd.broad_phase import could_meet, Motions
from physsim_ros.model.arrays import Floats, Ints
import pymunk

# So many fast bodies are worth finding out first which of them could meet anything.
FEW = 8


class FastBodies:
    """
    Shortens steps of bodies that are too fast for the engine.

    :param space: of the engine
    :param arrays: of it
    :param bodies: in it, by name
    :param names: of these
    :param dt: of a step [s]
    """

    def __init__(
        self,
        space: pymunk.Space,
        arrays: EngineArrays,
        bodies: Mapping[str, RigidBody],
        names: Mapping[pymunk.Body, str],
        dt: float,
    ) -> None:
        self._space = space
        self._arrays = arrays
        self._bodies = bodies
        self._names = names
        self._dt = dt
        # Around what never moves; None where that has changed.
        self._boxes: Floats | None = None

    def forget_standing(self) -> None:
        """Note that what never moves has come, gone or been put elsewhere."""
        self._boxes = None

    def arrest(self, layout: Layout, twists: Floats, fastest: float) -> None:
        """
        Shorten the coming step of the bodies that are too fast for the engine.

        :param twists: (m, 3) float64: velocities and spins in the engine's listing; kept up to
            date
        :param fastest: no number of these is greater
        """
        if fastest <= layout.unswept:
            return
        speed = np.hypot(twists[:, 0], twists[:, 1]) + np.abs(twists[:, 2]) * layout.arm
        fast = np.flatnonzero(speed > layout.safe)
        if len(fast) >= FEW and layout.ground.loose[fast].all():
            fast = fast[self._could_meet(layout, twists, fast)]
        if len(fast):
            movers = [layout.listed[place] for place in fast.tolist()]
            continuous.arrest(
                self._space,
                [rigid for rigid in movers if rigid is not None],
                self._dt,
                reach=float(speed.max()) * self._dt,
                depth_of=layout.depth,
                rigid_of=lambda engine: self._bodies.get(self._names.get(engine, '')),
            )
            for place, rigid in zip(fast.tolist(), movers, strict=True):
                if rigid is not None:
                    engine = rigid.engine
                    twists[place] = *engine.velocity, engine.angular_velocity

    def _could_meet(self, layout: Layout, twists: Floats, fast: Ints) -> NDArray[np.bool_]:
        """Return (k,): which of so many fast bodies, by their places, could meet anything."""
        # What is anchored stands, and sensors meet nothing: of these none is swept.
        moving = np.isfinite(layout.safe)
        rows = np.cumsum(moving) - 1
        ways, turns = twists[moving, :2] * self._dt, np.abs(twists[moving, 2]) * self._dt
        motions = Motions(
            centers=self._arrays.centers()[moving],
            ways=ways,
            turns=np.where(layout.arm[moving] > 0.0, turns, 0.0),
            outer=layout.ground.reach[moving],
            depth=layout.safe[moving] * self._dt,
            group=layout.group[moving],
        )
        apart = rows[layout.apart[moving[layout.apart].all(axis=1)]]
        return could_meet(rows[fast], motions, apart, self._standing())

    def _standing(self) -> Floats:
        """Return (b, 4) float64: left, bottom, right, top of all shapes that never move [m]."""
        if self._boxes is None:
            anchored = (
                rigid.engine.shapes for rigid in self._bodies.values() if rigid.body.anchored
            )
            shapes = itertools.chain(self._space.static_body.shapes, *anchored)
            boxes = [tuple(shape.bb) for shape in shapes]
            self._boxes = np.array(boxes, dtype=np.float64).reshape(-1, 4)
        return self._boxes
