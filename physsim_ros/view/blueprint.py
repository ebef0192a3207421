# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The layout of the viewer: the world in full width, and below it time, log and plots in tabs.

Law: the bounds of the view of the world never change; the camera moves instead (`camera`), so that
a user's pan and zoom persist.
"""

from __future__ import annotations

from physsim_ros.view import event_log, name_labels, plots, time_tracks, traces, velocities
from physsim_ros.view.colors import PAPER
from physsim_ros.view.frame_batch import RECORDED
import rerun.blueprint as rrb

# Size of the view of the world [pixels]: of the shape that it has in a window of 16 : 9.
WIDTH, HEIGHT = 1600, 640
# Time span of the traces of bodies [s].
_TRACED = 5.0


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
        background=PAPER,
        visual_bounds=rrb.VisualBounds2D(x_range=(0, WIDTH), y_range=(0, HEIGHT)),
        overrides={
            traces.PATH: [
                rrb.VisibleTimeRanges(
                    timeline=RECORDED,
                    start=rrb.TimeRangeBoundary.cursor_relative(seconds=-_TRACED),
                    end=rrb.TimeRangeBoundary.cursor_relative(),
                )
            ],
            # Shown by a click on the eye in the panel of the blueprint.
            name_labels.PATH: [rrb.EntityBehavior(visible=False)],
            velocities.PATH: [rrb.EntityBehavior(visible=False)],
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
