# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Traces of chosen bodies: their paths, and their heights beside those of free flight.

Free flight begins with the last frame in which a body touched something: from there its height
follows y0 + v0 t + g t² / 2.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from physsim_ros.model.snapshot import Frame
from physsim_ros.view.frame_batch import FrameBatch
from physsim_ros.view.line_strips import strip_column
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
    Sends the paths and heights of chosen bodies.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._traces: dict[str, _Trace] = {}
        self._styled: set[str] = set()
        self._heights: defaultdict[str, list[tuple[float, float]]] = defaultdict(list)
        style = rr.LineStrips3D.from_fields(radii=rr.Radius.ui_points(1.0))
        recording.log(PATH, style, static=True)

    def send(self, batch: FrameBatch, names: tuple[str, ...], height: float) -> None:
        """
        Send the frames of a batch.

        :param names: of the bodies; unknown names are ignored
        :param height: z of the paths [m]
        """
        rows = {name: row for row, name in enumerate(batch.scene.names)}
        for name in list(self._traces):
            if name not in names or name not in rows:
                del self._traces[name]
        traced = {name: rows[name] for name in names if name in rows}
        if not traced:
            return
        segments = [
            segment for frame in batch.frames for segment in self._segments(frame, traced, height)
        ]
        for name in traced:
            self._send_heights(batch, name)
        colors = [batch.scene.bodies[row].color for row in traced.values()] * len(batch)
        corners = np.array(segments, dtype=np.float32).reshape(-1, 3)
        lengths = [len(traced)] * len(batch)
        levels = np.rint(np.array(colors) * 255).astype(np.uint8)
        strips = strip_column(corners, 2, lengths)
        styles = rr.LineStrips3D.columns(colors=levels).partition(lengths)
        self._recording.send_columns(PATH, batch.times, [strips, *styles])

    def _segments(
        self, frame: Frame, traced: dict[str, int], height: float
    ) -> Iterator[tuple[tuple[float, float, float], tuple[float, float, float]]]:
        """Yield the path of each body since the frame before, and note its height."""
        now = frame.snapshot
        for name, row in traced.items():
            x, y = now.centers[row].tolist()
            trace = self._traces.get(name)
            flight = None if trace is None else self._flight_height(frame, row, trace)
            if trace is None or flight is None:
                trace = self._traces[name] = _Trace(
                    position=(x, y) if trace is None else trace.position,
                    stamp=now.stamp,
                    start=now.stamp,
                    height=y,
                    rise=float(now.twists[row, 1]),
                )
                flight = y
            self._heights[name].append((y, flight))
            yield (*trace.position, height), (x, y, height)
            trace.position, trace.stamp = (x, y), now.stamp

    def _send_heights(self, batch: FrameBatch, name: str) -> None:
        """Send the noted heights of a body."""
        plot = f'{PLOTS}/{name}'
        if name not in self._styled:
            self._styled.add(name)
            color = batch.scene.bodies[batch.scene.names.index(name)].color[:3]
            series = rr.SeriesLines(
                names=[name, f'{name} by y + v t + g t²/2'],
                colors=[tuple(round(255 * each) for each in color), _FLIGHT],
            )
            self._recording.log(plot, series, static=True)
        values = np.array(self._heights.pop(name)).ravel()
        scalars = rr.Scalars.columns(scalars=values).partition([2] * len(batch))
        self._recording.send_columns(plot, batch.times, scalars)

    @staticmethod
    def _flight_height(frame: Frame, row: int, trace: _Trace) -> float | None:
        """Return the height of a body in free flight [m]; None where another flight begins."""
        now, contacts = frame.snapshot, frame.contacts
        touched = contacts is not None and (contacts.pairs == row).any()
        if now.stamp < trace.stamp or touched or (now.scene.joint_rows == row).any():
            return None
        time = (now.stamp - trace.start) * 1e-9
        return trace.height + trace.rise * time + now.scene.settings.gravity[1] * time**2 / 2
