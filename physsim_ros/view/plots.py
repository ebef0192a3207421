# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Plots over time: energy, momentum, counts, and the pace of the world."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.model.transform import cross
from physsim_ros.view.frame_batch import Change, FrameBatch, RECORDED
import rerun as rr
import rerun.blueprint as rrb

# Period of the plots [s].
_PERIOD = 0.1
# Time before the moment that is shown, and room for the legend after it, in plots [s].
_SPAN, _ROOM = 10.0, 4.0
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
    :ivar values: of a frame, one for each series; None where one was not measured
    :ivar stepped: whether values last until they change
    """

    name: str
    series: tuple[Style, ...]
    values: Callable[[Frame], tuple[float, ...] | None]
    stepped: bool = False


def _energies(frame: Frame) -> tuple[float, ...]:
    now = frame.snapshot
    parts = (now.kinetic_energy, now.potential_energy, now.elastic_energy)
    return *parts, sum(parts)


def angular_momentum(snapshot: Snapshot) -> float:
    """Return the angular momentum of all dynamic bodies about the origin [kg m²/s]."""
    mass, moment = snapshot.scene.inertia.T
    orbital = mass * cross(snapshot.centers, snapshot.twists[:, :2])
    return float((orbital + moment * snapshot.twists[:, 2]).sum())


def _counts(frame: Frame) -> tuple[float, ...] | None:
    scene, contacts = frame.snapshot.scene, frame.contacts
    if contacts is None:
        return None
    return float(len(scene.bodies)), float(len(scene.joints)), float(len(contacts.pairs))


PLOTS = {
    'plots/energy': Plot(
        'Energy [J]',
        (('kinetic', _ORANGE), ('potential', _BLUE), ('elastic', _GREEN), ('total', _GREY)),
        _energies,
    ),
    'plots/momentum': Plot(
        'Momentum [kg m/s]', (('x', _ORANGE), ('y', _BLUE)), lambda frame: frame.snapshot.momentum
    ),
    'plots/angular_momentum': Plot(
        'Angular momentum [kg m²/s]',
        (('angular momentum', _PURPLE),),
        lambda frame: (angular_momentum(frame.snapshot),),
    ),
    'plots/counts': Plot(
        'Counts',
        (('bodies', _BLUE), ('joints', _GREEN), ('contacts', _ORANGE)),
        _counts,
        stepped=True,
    ),
}
PACE = 'plots/pace'


class Plots:
    """
    Sends the values of plots.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        for path, plot in PLOTS.items():
            names, colors = zip(*plot.series, strict=True)
            mode = rr.components.InterpolationMode.StepAfter if plot.stepped else None
            style = rr.SeriesLines(names=names, colors=colors, interpolation_mode=mode)
            recording.log(path, style, static=True)
        style = rr.SeriesLines(names='real-time factor / speed', colors=[_GREEN])
        recording.log(PACE, style, static=True)

    def send(self, batch: FrameBatch, _: Change) -> None:
        """
        Send the values of a batch, ten times a second, and of its last frame.

        A frame without one of the values of a plot has no row of it.
        """
        chosen = batch.sampled(_PERIOD)
        for path, plot in PLOTS.items():
            rows = {index: plot.values(batch.frames[index]) for index in chosen}
            measured = {index: values for index, values in rows.items() if values is not None}
            if measured:
                values = np.array([*measured.values()])
                scalars = rr.Scalars.columns(scalars=values.ravel())
                parts = scalars.partition([len(plot.series)] * len(measured))
                self._recording.send_columns(path, batch.times_at([*measured]), parts)

    def send_pace(self, batch: FrameBatch, real_time_factor: float) -> None:
        """
        Send the real-time factor by the asked speed at the last frame of a batch, if it is known.

        It is 1 for a world that keeps up.

        :param real_time_factor: simulation seconds a second; 0 where it is not known
        """
        last, speed = len(batch) - 1, batch.frames[-1].speed
        if speed and real_time_factor:
            scalars = rr.Scalars.columns(scalars=[real_time_factor / speed])
            self._recording.send_columns(PACE, batch.times_at([last]), scalars)


def plot_views(*, paced: bool) -> list[rrb.TimeSeriesView]:
    """
    Return the views of the plots that have values, for the blueprint.

    :param paced: whether there is a real-time factor
    """
    views = [_view(path, plot.name, legend=len(plot.series) > 1) for path, plot in PLOTS.items()]
    return [*views, _view(PACE, 'Real-time factor / speed', low=0.0)] if paced else views


def _view(
    path: str, name: str, *, legend: bool = False, low: float | None = None
) -> rrb.TimeSeriesView:
    return rrb.TimeSeriesView(
        origin=path,
        name=name,
        axis_y=None if low is None else rrb.ScalarAxis(range=(low, 1.2), zoom_lock=False),
        axis_x=rrb.TimeAxis(
            view_range=rr.TimeRange(
                start=rrb.TimeRangeBoundary.cursor_relative(seconds=-_SPAN),
                end=rrb.TimeRangeBoundary.cursor_relative(seconds=_ROOM),
            )
        ),
        time_ranges=rrb.VisibleTimeRange(
            RECORDED,
            start=rrb.TimeRangeBoundary.cursor_relative(seconds=-_SPAN),
            end=rrb.TimeRangeBoundary.cursor_relative(),
        ),
        # Of a single series the title tells enough.
        plot_legend=rrb.PlotLegend(corner=rrb.Corner2D.RightTop, visible=legend),
    )
