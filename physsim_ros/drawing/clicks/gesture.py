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
A gesture: the clicks of one tool, from the first to the one that ends it.

Laws: a click is fixed to the world as it lies when it is made. What was drawn wrong is dropped
whole, so that a tool starts afresh; a click that is no point at all leaves the gesture as it was.
"""

from __future__ import annotations

import math

from physsim_ros.drawing.clicks.click import Click
from physsim_ros.drawing.clicks.tools import Step, Tool, TOOLS
from physsim_ros.drawing.scene_query import View
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.preview import Line, Preview
from physsim_ros.model.requests import check_point
from physsim_ros.model.transform import Point

# Corners of the ring about a polygon's first corner.
_RING = 24


class Gesture:
    """
    What has been clicked so far with a tool.

    :param tool: in hand
    """

    def __init__(self, tool: Tool = Tool.NONE) -> None:
        self.tool = tool
        self._clicks: tuple[Click, ...] = ()

    def click(self, point: Point, frame: str, view: View, settings: DrawingSettings) -> Step:
        """
        Take a click.

        :param point: [m]
        :param frame: of the point: '' for the world, or a body's name
        :param view: the world that is clicked on
        :param settings: of drawing
        :return: the requests that end the gesture, or which click comes next
        :raises Malformed: the point is not finite; the gesture stays as it was
        :raises UnknownFrame: there is no such frame; the gesture stays as it was
        :raises Refusal: the gesture is nothing that can be drawn; it is dropped
        """
        if self.tool is Tool.NONE:
            return Step(message='ignored: no tool is in hand; parameter tool takes one')
        check_point(point, 'point')
        where = view.placed(point, frame)
        check_point(where, 'point')
        clicks = (*self._clicks, Click.on(view, where))
        # Unless the tool wants more of it, the gesture is over, refused or not.
        self._clicks = ()
        step = TOOLS[self.tool](clicks, view, settings)
        if not step.requests:
            self._clicks = clicks
        return step

    def preview(self, settings: DrawingSettings) -> Preview:
        """Return what has been clicked, to be shown."""
        points = tuple(click.point for click in self._clicks)
        if not points:
            return Preview()
        lines: list[Line] = [points] if len(points) > 1 else []
        if self.tool is Tool.POLYGON:
            lines.append(_ring(points[0], settings.snap))
        return Preview(lines=tuple(lines), points=points, label=str(self.tool))


def _ring(center: Point, radius: float) -> Line:
    """Return a circle as a closed line: within it, a click closes a polygon."""
    angles = [math.tau * corner / _RING for corner in range(_RING + 1)]
    return tuple(
        (center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle))
        for angle in angles
    )
