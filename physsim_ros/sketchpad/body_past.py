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
The past of a body, for plots: what was shown of it, by columns.

Law: the world's thread only looks up the snapshots; the server's thread makes the columns.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import turned
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad.page_requests import Send

# Frames that a page gets of the past: a minute at 60 Hz.
MOST_FRAMES = 3600
# From one past that a page gets to the next [s]: each takes XX ms of the server's thread.
PERIOD = 1.0


class BodyWatch:
    """
    The body whose past a page asks for: that of the last request is sent, once a period at most.

    :param simulation: with the past
    :param send: sends a message to the page
    """

    def __init__(self, simulation: Simulation, send: Send) -> None:
        self._simulation = simulation
        self._send = send
        # Body and identifier of the request that is not fulfilled yet.
        self._asked: tuple[str, str] | None = None
        # Steady time from which on the next past is sent [s].
        self._due = 0.0

    def watch(self, name: str, request_id: str, now: float) -> None:
        """
        Send the past of a body, as soon as that is due.

        :param name: of the body; '' is none, whose columns are empty
        :param request_id: of the message that asks
        :param now: steady time [s]
        """
        self._asked = (name, request_id) if name else None
        if name:
            self.send_due(now)
        else:
            self._send(partial(_body_content, '', request_id, ()))

    def send_due(self, now: float) -> None:
        """
        Send the past that was asked for last, where that has not been done and is due.

        :param now: steady time [s]
        """
        if self._asked is None or now < self._due:
            return
        (name, request_id), self._asked = self._asked, None
        self._due = now + PERIOD
        simulation = self._simulation
        snapshots = simulation.past.frame_cache.snapshots(simulation.step, MOST_FRAMES)
        self._send(partial(_body_content, name, request_id, snapshots))


def _body_content(name: str, request_id: str, snapshots: Sequence[Snapshot]) -> dict[str, Any]:
    return {'type': 'body', 'request': request_id, 'name': name, **body_past(snapshots, name)}


def body_past(snapshots: Sequence[Snapshot], name: str) -> dict[str, list[float]]:
    """
    Return the columns of a body's past: time [s], x, y of its centre of mass [m], vx, vy [m/s], w.

    :param snapshots: in the order of time
    :param name: of the body; of one that was not there the columns are empty
    """
    rows: list[tuple[float, ...]] = []
    scene: Scene | None = None
    row, centroid = -1, (0.0, 0.0)
    for snapshot in snapshots:
        if snapshot.scene is not scene:
            scene = snapshot.scene
            row = _row_of(name, scene, row)
            if row >= 0:
                centroid = scene.bodies[row].shape.form.centroid
        if row >= 0:
            pose, twist = snapshot.poses[row].tolist(), snapshot.twists[row].tolist()
            rows.append((snapshot.stamp * 1e-9, *pose, *twist, *centroid))
    columns = np.array(rows).reshape(-1, 9)
    centers = columns[:, 1:3] + turned(columns[:, 7:], columns[:, 3])
    x, y = centers.T.tolist()
    vx, vy, spin = columns[:, 4:7].T.tolist()
    return {'time': columns[:, 0].tolist(), 'x': x, 'y': y, 'vx': vx, 'vy': vy, 'w': spin}


def _row_of(name: str, scene: Scene, before: int) -> int:
    """
    Return the row of a body in a scene; -1 where it is not there.

    :param before: its row in another scene, which is often the same
    """
    names = scene.names
    if 0 <= before < len(names) and names[before] == name:
        return before
    return names.index(name) if name in names else -1
