# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The layout of the viewer: the world in full width, and below it time, log and plots in tabs.

Law: the bounds of the view of the world never change; the camera moves instead (`camera`), so that
a user's pan and zoom persist.
"""

from __future__ import annotations

from physsim_ros.view import (
    arrows,
    body_texts,
    event_log,
    plots,
    robot_ways,
    styles,
    time_tracks,
    traces,
)
from physsim_ros.view.frame_batch import RECORDED
from physsim_ros.view.recording_list import RECORDING_LIST
import rerun as rr
import rerun.blueprint as rrb
import rerun_bindings as bindings

# Size of the view of the world [pixels]: of the shape that it has in a window of 16 : 9.
WIDTH, HEIGHT = 1600, 640
# Time span of the traces of bodies, and of the ways of robots, which have ten rows a second [s].
_TRACED, _DRIVEN = 5.0, 30.0


def blueprint(*, paced: bool, traced: bool) -> rrb.Blueprint:
    """
    Return the blueprint of the layout.

    :param paced: whether there is a real-time factor
    :param traced: whether bodies are traced
    """
    world = rrb.Spatial2DView(
        origin='world/camera',
        contents='world/**',
        name='World',
        background=styles.PAPER,
        visual_bounds=rrb.VisualBounds2D(x_range=(0, WIDTH), y_range=(0, HEIGHT)),
        overrides={
            traces.PATH: [_last(_TRACED)],
            robot_ways.TRUTH: [_last(_DRIVEN)],
            robot_ways.ODOMETRY: [_last(_DRIVEN)],
            # Shown by a click on the eye in the panel of the blueprint.
            body_texts.NAMES_PATH: [rrb.EntityBehavior(visible=False)],
            arrows.VELOCITIES: [rrb.EntityBehavior(visible=False)],
        },
    )
    log = rrb.Horizontal(
        time_tracks.time_view(),
        event_log.log_view(),
        column_shares=[1, 2],
        name='Time and log',
    )
    return rrb.Blueprint(
        rrb.Vertical(
            world,
            rrb.Tabs(log, *plots.plot_views(paced=paced, traced=traced), active_tab=0),
            # Below, all tracks of time are seen in a window of 900 pixels.
            row_shares=[5, 2],
        ),
        rrb.BlueprintPanel(state='collapsed'),
        rrb.SelectionPanel(state='collapsed'),
        rrb.TimePanel(state='collapsed', timeline=RECORDED, play_state='following'),
    )


def _last(seconds: float) -> rrb.VisibleTimeRanges:
    """Return the time range of the last seconds."""
    return rrb.VisibleTimeRanges(
        timeline=RECORDED,
        start=rrb.TimeRangeBoundary.cursor_relative(seconds=-seconds),
        end=rrb.TimeRangeBoundary.cursor_relative(),
    )


def send_blueprint(recording: rr.RecordingStream, blueprint: rrb.Blueprint) -> None:
    """
    Make a blueprint the active one of a recording, and the default one.

    `RecordingStream.send_blueprint` of Rerun (0.41) leaks: it makes a recording with a memory
    sink, and both keep each other, with two threads, until the process ends. This function can go
    when they do not any more.
    """
    with RECORDING_LIST:
        stream = rr.RecordingStream._from_native(  # noqa: SLF001  as Rerun does it
            bindings.new_blueprint(
                application_id=rr.get_application_id(recording) or '',
                make_default=False,
                make_thread_default=False,
                default_enabled=True,
            )
        )
    stream.set_time('blueprint', sequence=0)
    blueprint._log_to_stream(stream)  # noqa: SLF001  the same
    storage = stream.memory_recording().storage
    bindings.send_blueprint(storage, True, True, recording=recording.to_native())
    # Without its sink nothing keeps the recording.
    stream.disconnect()
    with RECORDING_LIST:
        del stream
