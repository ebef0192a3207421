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
The layout of the viewer: the world, and beside it run states, plots and the log of events.

Law: the bounds of the view of the world never change; the camera moves instead (`camera`), so that
a user's pan and zoom persist.
"""

from __future__ import annotations

from physsim_ros.view import run_state_track
import rerun.blueprint as rrb

# Size of the view of the world [pixels].
WIDTH, HEIGHT = 1600, 1000
# Time span of the plots: ten seconds at 60 Hz [frames].
PLOTTED = 600
PAPER = (250, 250, 247)


def blueprint() -> rrb.Blueprint:
    """Return the blueprint of the layout."""
    recent = rrb.VisibleTimeRange(
        'frame',
        start=rrb.TimeRangeBoundary.cursor_relative(seq=-PLOTTED),
        end=rrb.TimeRangeBoundary.cursor_relative(),
    )
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Spatial2DView(
                origin='world/camera',
                contents='world/**',
                name='World',
                background=PAPER,
                visual_bounds=rrb.VisualBounds2D(x_range=(0, WIDTH), y_range=(0, HEIGHT)),
            ),
            rrb.Vertical(
                run_state_track.run_state_view(),
                rrb.TimeSeriesView(
                    origin='energy',
                    name='Energy [J]',
                    time_ranges=recent,
                    plot_legend=rrb.PlotLegend(corner=rrb.Corner2D.RightTop),
                ),
                rrb.TimeSeriesView(
                    origin='real_time_factor',
                    name='Real-time factor',
                    time_ranges=recent,
                    plot_legend=rrb.PlotLegend(visible=False),
                ),
                rrb.TextLogView(
                    origin='events',
                    name='Events',
                    columns=rrb.TextLogColumns(text_log_columns=['loglevel', 'body']),
                ),
                row_shares=[2, 3, 2, 2],
            ),
            column_shares=[3, 1],
        ),
        rrb.BlueprintPanel(state='collapsed'),
        rrb.SelectionPanel(state='collapsed'),
        rrb.TimePanel(state='collapsed', timeline='frame', play_state='following'),
    )
