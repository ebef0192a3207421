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
What a world goes on from: as a file has it, and as a keyframe has it.

Law: two worlds that go on from the same keyframe go on alike to the bit.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.scene import Body, Joint, Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Pose


class Motion(NamedTuple):
    """
    The engine's own numbers for a body: enough to go on from to the bit.

    x, y [m], yaw [rad] of the engine's origin; vx, vy [m/s], spin [rad/s] as the engine has them;
    whether the body is in free flight.
    """

    x: float
    y: float
    yaw: float
    vx: float
    vy: float
    spin: float
    free: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyState:
    """
    A body and all that it goes on from.

    :param body: what it is; `expires` counts from the moment of the state
    :param pose: of its origin in the world [m, rad]
    :param twist: velocity of the centre of mass [m/s] and spin [rad/s]
    :param motion: the engine's numbers for these two; None where they come from a person
    :param wrench: force [N] and torque [N m] that act on it
    :param wrench_steps: steps for which the wrench still acts; None is for ever
    """

    body: Body
    pose: Pose
    twist: Pose = (0.0, 0.0, 0.0)
    motion: Motion | None = None
    wrench: Pose = (0.0, 0.0, 0.0)
    wrench_steps: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class WorldState:
    """
    A whole world at a moment, as it is saved and restored; it has no time of its own.

    :param settings: of the world
    :param bodies: in spawn order
    :param joints: in the order in which they were made
    :param memory: of contacts; None where the state comes from a person
    """

    settings: WorldSettings
    bodies: tuple[BodyState, ...] = ()
    joints: tuple[Joint, ...] = ()
    memory: ContactMemory | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ContactMemory:
    """
    What the engine remembers of contacts: its next step starts from these impulses.

    :param ids: (n,) int64: the engine's number of each body's first shape, in spawn order
    :param walls: the same of the first wall of `bounds`; 0 where there are none
    :param following: the number that the next shape gets
    :param pairs: (k, 2) int64: numbers of the two shapes of each contact point
    :param hashes: (k,) uint64: what the engine tells the points of a pair apart by
    :param impulses: (k, 2) float64: along and across the normal, in the last step [N s]
    """

    ids: Ints
    walls: int
    following: int
    pairs: Ints
    hashes: NDArray[np.uint64]
    impulses: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Keyframe:
    """
    All that a world goes on from at a step, after the requests of that step.

    :param step: number of steps since the world began
    :param scene: the bodies and the settings
    :param state: (n, 6) float64: pose and velocity of each engine body [m, rad, s]
    :param free: (n,) bool: in free flight, so that the engine's velocity leads
    :param wrenches: of the bodies that one acts on: row, wrench [N, N m], the step at which it
        ends or None
    :param memory: of contacts
    :param joint_impulses: (c, 2) float64: impulses from which the engine's constraints start their
        next step [N s, N m s], in the order of the joints
    """

    step: int
    scene: Scene
    state: Floats
    free: NDArray[np.bool_]
    wrenches: tuple[tuple[int, Pose, int | None], ...]
    memory: ContactMemory
    joint_impulses: Floats
