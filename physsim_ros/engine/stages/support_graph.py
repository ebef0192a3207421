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
Footing: what hangs together with something that stands, and what has lost that.

Law: what hangs together with nothing that stands falls as one. It hangs together by joints, and by
contacts that pressed in the last step and are still there, or are new. Of such a pile the engine
still remembers what it has borne, and would blow it apart.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.batch_io import EngineArrays
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.islands import Rows, spread
from physsim_ros.engine.stages.resting_damping import Ground
from physsim_ros.model.arrays import Ints
import pymunk
from pymunk import batch

_F = batch.ArbiterFields
_PRESSING = _F.BODY_A_ID | _F.BODY_B_ID | _F.TOTAL_IMPULSE


class Footing:
    """
    Finds what has lost its footing.

    :param space: whose `collision_persistence` is 1, so that it lists only contacts of the last
        step
    :param arrays: of it
    """

    def __init__(self, space: pymunk.Space, arrays: EngineArrays) -> None:
        self._space = space
        self._arrays = arrays

    def lost(
        self, ground: Ground, joined: tuple[Rows, Rows], loosened: Iterable[RigidBody]
    ) -> NDArray[np.bool_]:
        """
        Return (m,) bool, in the engine's listing: what fell away with what something let go of.

        :param ground: what is constant about the bodies
        :param joined: (j,) and (j,) places of what joints hold together, the background's last
        :param loosened: bodies that something let go of since the last step, and forces move
        """
        engines = [rigid.engine for rigid in loosened]
        loose = np.zeros(len(ground.loose), np.bool_)
        loose[ground.rows(_ids(engines))] = True
        one, other = self._contacts(ground, loose, engines)
        one, other = np.append(one, joined[0]), np.append(other, joined[1])
        held = spread(~ground.loose, one, other)
        return spread(loose & ~held, one, other)[:-1]

    def _contacts(
        self, ground: Ground, loose: NDArray[np.bool_], engines: list[pymunk.Body]
    ) -> tuple[Rows, Rows]:
        """Return the places of what touches, pair by pair; of loose bodies this is found anew."""
        ints, floats = self._arrays.contacts(_PRESSING)
        presses = floats.reshape(-1, 2).any(axis=1)
        pairs = ground.rows(ints.reshape(-1, 2))
        now = ground.rows(np.array([*self._now(engines)], np.uintp).reshape(-1, 2))
        known, new = (_keys(each, len(loose)) for each in (pairs, now))
        # What only lies beside another does not hold it.
        now = now[np.isin(new, known[presses]) | ~np.isin(new, known)]
        pairs = np.concatenate((pairs[presses & ~loose[pairs].any(axis=1)], now))
        return pairs[:, 0], pairs[:, 1]

    def _now(self, engines: list[pymunk.Body]) -> Iterator[tuple[int, int]]:
        """Yield the engine's ids of what touches where all is now, as the next step finds it."""
        for body in engines:
            for shape in body.shapes:
                for hit in self._space.shape_query(shape):
                    other = hit.shape
                    if other and other.body and not (shape.sensor or other.sensor):
                        yield body.id, other.body.id


def _ids(engines: list[pymunk.Body]) -> NDArray[np.uintp]:
    return np.array([each.id for each in engines], np.uintp)


def _keys(pairs: NDArray[np.intp], count: int) -> Ints:
    """Return (k,) one number for each pair, whichever comes first."""
    keys: Ints = pairs.min(axis=1, initial=count) * (count + 1) + pairs.max(axis=1, initial=0)
    return keys
