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
Chosen bodies: the way that they went, and their height beside that of free flight.

Free flight begins with the last frame in which a body touched something: from there its height
follows y0 + v0 t + g t² / 2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.view import columns
from physsim_ros.view.frame_batch import FrameBatch
import rerun as rr

PATH = 'world/traces'
PLOTS = 'plots/bodies'
_FLIGHT = (150, 150, 150)


@dataclass(slots=True)
class _Trace:
    """The last place of a body, and the beginning of its flight."""

    position: tuple[float, float]
    stamp: int
    start: int
    height: float
    rise: float


class Traces:
    """
    Sends the ways and flights of chosen bodies.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._traces: dict[str, _Trace] = {}
        self._styled: set[str] = set()

    def send(self, batch: FrameBatch, names: tuple[str, ...], height: float) -> None:
        """
        Send the frames of a batch.

        :param names: of the bodies; those that there are not are ignored
        :param height: z of the ways [m]
        """
        rows = {name: row for row, name in enumerate(batch.scene.names)}
        for name in list(self._traces):
            if name not in names or name not in rows:
                del self._traces[name]
        for name in names:
            if name in rows:
                self._send_body(batch, name, rows[name], height)

    def _send_body(self, batch: FrameBatch, name: str, row: int, height: float) -> None:
        segments, heights = [], []
        for frame in batch.frames:
            now = frame.snapshot
            x, y = now.centers[row].tolist()
            trace = self._traces.get(name)
            flight = None if trace is None else self._flight_height(frame, row, trace)
            if trace is None or flight is None:
                start = now.stamp
                trace = self._traces[name] = _Trace(
                    position=(x, y) if trace is None else trace.position,
                    stamp=now.stamp, start=start, height=y, rise=float(now.twists[row, 1]),
                )  # fmt: skip
                flight = y
            heights.append((y, flight))
            segments.append(((*trace.position, height), (x, y, height)))
            trace.position, trace.stamp = (x, y), now.stamp
        body = batch.scene.bodies[row]
        path = f'{PATH}/{name}'
        plot = f'{PLOTS}/{name}'
        if name not in self._styled:
            self._styled.add(name)
            color = tuple(round(255 * each) for each in body.color[:3])
            radii = rr.Radius.ui_points(1.0)
            style = rr.LineStrips3D.from_fields(colors=[color], radii=radii)
            self._recording.log(path, style, static=True)
            series = rr.SeriesLines(
                names=[f'{name}', f'{name} by y + v t + g t²/2'], colors=[color, _FLIGHT]
            )
            self._recording.log(plot, series, static=True)
        corners = np.array(segments, dtype=np.float32).reshape(-1, 3)
        strips = (corners, np.full(len(segments), 2, dtype=np.intp))
        column = columns.column(columns.STRIPS, strips, [1] * len(batch))
        self._recording.send_columns(path, batch.times, [column])
        values = np.array(heights).ravel()
        series_column = columns.column(columns.SCALARS, values, [2] * len(batch))
        self._recording.send_columns(plot, batch.times, [series_column])

    @staticmethod
    def _flight_height(frame: Frame, row: int, trace: _Trace) -> float | None:
        """Return the height of a body by its flight [m]; None where a flight begins anew."""
        now = frame.snapshot
        if now.stamp < trace.stamp or _is_touched(frame, row) or _is_joined(now, row):
            return None
        time = (now.stamp - trace.start) * 1e-9
        return trace.height + trace.rise * time + now.scene.settings.gravity[1] * time**2 / 2


def _is_touched(frame: Frame, row: int) -> bool:
    return frame.contacts is not None and bool((frame.contacts.pairs == row).any())


def _is_joined(now: Snapshot, row: int) -> bool:
    return bool((now.scene.joint_rows == row).any())
