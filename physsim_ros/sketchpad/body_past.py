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


"""The past of a body, for plots: what was shown of it, by columns."""

from __future__ import annotations

from typing import Any

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import turned
from physsim_ros.simulation.simulation import Simulation

# Frames that a page gets of the past: a minute at 60 Hz.
MOST_FRAMES = 3600


def body_past(simulation: Simulation, name: str) -> dict[str, Any]:
    """
    Return the columns of a body's past: time [s], x, y of its centre of mass [m], vx, vy [m/s], w.

    :param name: of the body; of one that was not there the columns are empty
    """
    times: list[float] = []
    rows: list[Floats] = []
    scene, row = None, -1
    for snapshot in simulation.past.frame_cache.snapshots(simulation.step, MOST_FRAMES):
        if snapshot.scene is not scene:
            scene = snapshot.scene
            row = scene.names.index(name) if name in scene.names else -1
        if row >= 0 and scene is not None:
            times.append(snapshot.stamp * 1e-9)
            rows.append(
                np.concatenate((snapshot.poses[row], snapshot.twists[row], scene.centroids[row]))
            )
    columns = np.array(rows).reshape(-1, 8)
    centers = columns[:, :2] + turned(columns[:, 6:], columns[:, 2])
    x, y = centers.T.tolist()
    vx, vy, spin = columns[:, 3:6].T.tolist()
    return {'time': times, 'x': x, 'y': y, 'vx': vx, 'vy': vy, 'w': spin}
