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
What lies still: the solver's errors taken out of bodies that Coulomb's law holds in place.

The engine's solver stops after a few sweeps and takes its impulses over into the next step. For
the slow bending of a stack that is a spring without a damper: a stack of ten sways for half a
minute after it has been put down, by its solver's error alone.

Law: a body that lies with a face on something at rest, its friction inside the cone, does not
move. Where such contacts lead from a body down to the background, the speed that it still has is
error, and a share of it is taken away. What slides, rolls, flies, stands on a corner or on
something that moves is never touched, nor what is faster than such an error can be.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.batch_io import EngineArrays
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.islands import spread
from physsim_ros.model.arrays import Floats
from pymunk import batch

# Looked for so often [Hz]: the solver itself ends within a second what sways faster than half of
# this, and to look at every step would cost more than the sweeps that the solver saves.
RATE = 8.0
# That share of the error is taken away each time, and so three quarters of a sway in a second.
SHARE = 0.3
# The fastest error [m/s]: what the worst orders of solving leave of a stack that is put down.
FASTEST_ERROR = 0.1
# Where nothing is faster, there is nothing to see, and contacts need not be read [m/s].
UNSEEN = 1e-6
# Share of the cone inside which friction holds; a contact that slides lies on it to the last bit.
INSIDE = 0.999

_F = batch.ArbiterFields
_CONTACT = (
    _F.BODY_A_ID
    | _F.BODY_B_ID
    | _F.IS_FIRST_CONTACT
    | _F.CONTACT_COUNT
    | _F.TOTAL_IMPULSE
    | _F.NORMAL
)


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """
    What is constant about the bodies, one row for each in the order of the engine's listing.

    The last row is the background, which the engine does not list.

    :param ids: (m,) uintp: the engine's ids, sorted
    :param places: (m,) intp: the place in the listing of each of these
    :param grip: (m + 1,) float64: the engine's friction, whose products are those of pairs
    :param reach: (m,) float64: greatest distance of a point from the centre of mass [m]
    :param loose: (m + 1,) bool: whether forces move the body
    :param fixed: (m + 1,) bool: whether it is fixed to the background
    """

    ids: NDArray[np.uintp]
    places: NDArray[np.intp]
    grip: Floats
    reach: Floats
    loose: NDArray[np.bool_]
    fixed: NDArray[np.bool_]

    def rows(self, ids: NDArray[np.uintp]) -> NDArray[np.intp]:
        """Return the rows of engine ids."""
        near = np.minimum(np.searchsorted(self.ids, ids), len(self.ids) - 1)
        return np.where(self.ids[near] == ids, self.places[near], len(self.ids))

    def speeds(self, twists: Floats) -> Floats:
        """Return (m,) float64: what no point of each body is faster than [m/s]."""
        speeds: Floats = np.hypot(twists[:, 0], twists[:, 1])
        return speeds + np.abs(twists[:, 2]) * self.reach


def ground(listed: Sequence[RigidBody | None], ids: Sequence[int], friction: float) -> Ground:
    """
    Return what is constant about bodies.

    :param listed: in the order of the engine's listing; None belongs to the background
    :param ids: their engine ids
    :param friction: of the background
    """
    listing = np.array(ids, dtype=np.uintp)
    places = np.argsort(listing)
    bodies = [None if rigid is None else rigid.body for rigid in (*listed, None)]
    return Ground(
        ids=listing[places],
        places=places,
        grip=np.sqrt([friction if body is None else body.friction for body in bodies]),
        reach=np.array([0.0 if body is None else body.shape.form.outer for body in bodies[:-1]]),
        loose=np.array([body is not None and not body.fixed for body in bodies], dtype=np.bool_),
        fixed=np.array([body is None or body.anchored for body in bodies], dtype=np.bool_),
    )


class Stillness:
    """
    Calms what lies still, every now and then.

    :param arrays: of a space whose `collision_persistence` is 1, so that the engine lists only
        contacts of the last step
    """

    def __init__(self, arrays: EngineArrays) -> None:
        self._arrays = arrays

    def calm(self, ground: Ground, twists: Floats, thrown: NDArray[np.intp]) -> None:
        """
        Take a share of its speed from what is held in place.

        :param ground: what is constant about the bodies
        :param twists: (m, 3) float64: their velocities [m/s] and spins [rad/s] in the order of
            the engine's listing; kept up to date
        :param thrown: (k,) places in it of what moves as it was told to
        """
        speed = ground.speeds(twists)
        slow = ground.loose[:-1] & (speed < FASTEST_ERROR)
        slow[thrown] = False
        if not (slow & (speed > UNSEEN)).any():
            return
        held = self._held(ground, np.append(slow, False) | ground.fixed)[:-1] & slow
        if held.any():
            twists[held] *= 1.0 - SHARE
            self._arrays.write_twists(twists)

    def _held(self, ground: Ground, slow: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return (m + 1,) bool: which are fixed, or held by something that is, by friction."""
        ints, floats = self._arrays.contacts(_CONTACT)
        ints, floats = ints.reshape(-1, 4), floats.reshape(-1, 4)
        # A face has two points. At a first touch the impulse is that of an impact.
        face = (ints[:, 3] == 2) & (ints[:, 2] == 0)
        impulse, normal = floats[face, :2], floats[face, 2:]
        along = np.abs((impulse * normal).sum(axis=1))
        across = np.abs(impulse[:, 0] * normal[:, 1] - impulse[:, 1] * normal[:, 0])
        a, b = ground.rows(ints[face, :2]).T
        stuck = across < INSIDE * ground.grip[a] * ground.grip[b] * along
        stuck &= slow[a] & slow[b]
        # From the background up, contact by contact.
        return spread(ground.fixed, a[stuck], b[stuck])
