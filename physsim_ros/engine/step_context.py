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

"""The context of one step: what stages need from each other, by name."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.model.arrays import Floats
from physsim_ros.model.settings import WorldSettings


@dataclass(slots=True, eq=False)
class StepContext:
    """
    One step of the pipeline.

    :param table: the bodies
    :param settings: of the world
    :param dt: length of the step [s]
    :param age: steps made since the space was built; stages that act every so many steps count
        by it, so that a space restored from a checkpoint goes on alike
    :param watching: whether contacts are reported
    :param poses: (n, 3) float64: of the engine's origins as the step begins [m, rad]
    :param twists: (n, 3) float64: velocities [m/s] and spins [rad/s] that the engine begins the
        step with; a stage that changes one in the engine changes it here too
    """

    table: BodyTable
    settings: WorldSettings
    dt: float
    age: int
    watching: bool
    poses: Floats = field(default_factory=lambda: np.empty((0, 3)))
    twists: Floats = field(default_factory=lambda: np.empty((0, 3)))
