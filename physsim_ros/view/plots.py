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

"""Plots over time: energy, momentum, counts, and the pace of the world."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.model.transform import cross
from physsim_ros.view import columns
from physsim_ros.view.frame_batch import FrameBatch, RECORDED
from physsim_ros.view.frame_context import FrameContext
import rerun as rr
import rerun.blueprint as rrb

# Period of the plots [frames].
SAMPLE = 6
# Time span of the plots [s].
_SPAN = 15.0
_BLUE, _ORANGE, _GREEN, _PURPLE, _GREY = (
    (76, 120, 168),
    (245, 133, 24),
    (84, 162, 75),
    (178, 121, 162),
    (120, 120, 120),
)
Style = tuple[str, tuple[int, int, int]]


class Plot(NamedTuple):
    """
    A plot of several series.

    :ivar name: with its unit
    :ivar series: name and colour of each
    :ivar values: of a frame, one for each series
    """

    name: str
    series: tuple[Style, ...]
    values: Callable[[Frame], tuple[float, ...]]


def _energies(frame: Frame) -> tuple[float, ...]:
    now = frame.snapshot
    parts = (now.kinetic_energy, now.potential_energy, now.elastic_energy)
    return *parts, sum(parts)


def _momenta(frame: Frame) -> tuple[float, ...]:
    return frame.snapshot.momentum


def angular_momentum(snapshot: Snapshot) -> float:
    """Return the angular momentum of all movable bodies about the origin [kg m²/s]."""
    mass, moment = snapshot.scene.inertia.T
    orbital = mass * cross(snapshot.centers, snapshot.twists[:, :2])
    return float((orbital + moment * snapshot.twists[:, 2]).sum())


def _counts(frame: Frame) -> tuple[float, ...]:
    scene, contacts = frame.snapshot.scene, frame.contacts
    pairs = 0 if contacts is None else len(contacts.pairs)
    return float(len(scene.bodies)), float(len(scene.joints)), float(pairs)


PLOTS = {
    'plots/energy': Plot(
        'Energy [J]',
        (('kinetic', _ORANGE), ('height', _BLUE), ('elastic', _GREEN), ('total', _GREY)),
        _energies,
    ),
    'plots/momentum': Plot('Momentum [kg m/s]', (('x', _ORANGE), ('y', _BLUE)), _momenta),
    'plots/angular_momentum': Plot(
        'Angular momentum about the origin [kg m²/s]',
        (('angular momentum', _PURPLE),),
        lambda frame: (angular_momentum(frame.snapshot),),
    ),
    'plots/counts': Plot(
        'Counts', (('bodies', _BLUE), ('joints', _GREEN), ('contacts', _ORANGE)), _counts
    ),
}
PACE, COST = 'plots/pace', 'plots/cost'


def send_styles(recording: rr.RecordingStream) -> None:
    """Log names and colours of the series."""
    for path, plot in PLOTS.items():
        names, colors = zip(*plot.series, strict=True)
        recording.log(path, rr.SeriesLines(names=names, colors=colors), static=True)
    recording.log(
        PACE, rr.SeriesLines(names='real-time factor by speed', colors=[_GREEN]), static=True
    )
    recording.log(COST, rr.SeriesLines(names='frame [ms]', colors=[_ORANGE]), static=True)


def send_plots(recording: rr.RecordingStream, batch: FrameBatch) -> None:
    """Send the values of every `SAMPLE`-th frame of a batch, and of its last one."""
    chosen = batch.sampled(SAMPLE)
    times = batch.times_at(chosen)
    for path, plot in PLOTS.items():
        values = np.array([plot.values(batch.frames[index]) for index in chosen])
        lengths = [len(plot.series)] * len(chosen)
        column = columns.column(columns.SCALARS, values.ravel(), lengths)
        recording.send_columns(path, times, [column])


def send_pace(recording: rr.RecordingStream, batch: FrameBatch, context: FrameContext) -> None:
    """
    Send real-time factor and cost of the last frame of a batch, where there are any.

    The factor is that of the asked speed: 1 is a world that keeps up.
    """
    times, speed = batch.times_at([len(batch) - 1]), batch.frames[-1].speed
    values = {
        PACE: context.real_time_factor / speed if speed else 0.0,
        COST: 1e3 * (context.cost or 0.0),
    }
    for path, value in values.items():
        if value:
            column = columns.column(columns.SCALARS, np.array([value]), [1])
            recording.send_columns(path, times, [column])


def plot_views(*, paced: bool, traced: bool) -> list[rrb.Horizontal]:
    """
    Return the views of the plots that have values, for the blueprint.

    :param paced: whether there is a real-time factor
    :param traced: whether bodies are traced
    """
    energy, momentum, angular, counts = (_view(path, plot.name) for path, plot in PLOTS.items())
    views = [
        rrb.Horizontal(energy, name='Energy'),
        rrb.Horizontal(momentum, angular, name='Momentum'),
        rrb.Horizontal(counts, name='Counts'),
    ]
    if traced:
        heights = _view('plots/bodies', 'Height of traced bodies, and in free flight [m]')
        views.append(rrb.Horizontal(heights, name='Traced bodies'))
    if paced:
        pace = _view(PACE, 'Real-time factor by speed', low=0.0)
        cost = _view(COST, 'Cost of a frame [ms]')
        views.append(rrb.Horizontal(pace, cost, name='Pace'))
    return views


def _view(path: str, name: str, *, low: float | None = None) -> rrb.TimeSeriesView:
    return rrb.TimeSeriesView(
        origin=path,
        name=name,
        axis_y=None if low is None else rrb.ScalarAxis(range=(low, 1.2), zoom_lock=False),
        time_ranges=rrb.VisibleTimeRange(
            RECORDED,
            start=rrb.TimeRangeBoundary.cursor_relative(seconds=-_SPAN),
            end=rrb.TimeRangeBoundary.cursor_relative(),
        ),
        plot_legend=rrb.PlotLegend(corner=rrb.Corner2D.LeftTop),
    )
