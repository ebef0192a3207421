# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A gesture: the clicks of one tool, from the first to the one that ends it.

Laws: the body under a click is looked up when the click is made. A gesture that cannot be drawn is
dropped as a whole. A click that is not a finite point leaves the gesture as it was.
"""

from __future__ import annotations

import math

from physsim_ros.drawing.clicks.click import Click
from physsim_ros.drawing.clicks.tools import ClickResult, Tool, TOOLS
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.checks import check_point
from physsim_ros.model.snapshot import Line, Preview
from physsim_ros.model.transform import Point

# Number of corners of the circle around the first corner of a polygon.
_CIRCLE_CORNERS = 24


class Gesture:
    """
    The clicks so far with a tool.

    :param tool: of the gesture
    """

    def __init__(self, tool: Tool = Tool.NONE) -> None:
        self.tool = tool
        self._clicks: tuple[Click, ...] = ()

    def click(
        self, point: Point, frame: str, scene: SceneQuery, settings: DrawingSettings
    ) -> ClickResult:
        """
        Add a click.

        :param point: [m]
        :param frame: of the point: '' for the world, or the name of a body
        :param scene: the world that was clicked
        :param settings: of drawing
        :return: the requests that end the gesture, or a message about the next click
        :raises Malformed: the point is not finite; the gesture stays as it was
        :raises UnknownFrame: there is no such frame; the gesture stays as it was
        :raises Refusal: the gesture cannot be drawn; it is dropped
        """
        if self.tool is Tool.NONE:
            return ClickResult(message='ignored: no tool is in hand; parameter tool takes one')
        check_point(point, 'point')
        in_world = scene.resolve_point(point, frame)
        check_point(in_world, 'point')
        clicks = (*self._clicks, Click.at_point(scene, in_world))
        # The gesture is over, refused or not, unless the tool needs more clicks.
        self._clicks = ()
        step = TOOLS[self.tool](clicks, scene, settings)
        if not step.requests:
            self._clicks = clicks
        return step

    def preview(self, settings: DrawingSettings) -> Preview:
        """Return the preview of the clicks so far."""
        points = tuple(click.point for click in self._clicks)
        if not points:
            return Preview()
        lines: list[Line] = [points] if len(points) > 1 else []
        if self.tool is Tool.POLYGON:
            lines.append(_circle(points[0], settings.snap))
        return Preview(lines=tuple(lines), points=points, label=str(self.tool))


def _circle(center: Point, radius: float) -> Line:
    """Return a circle as a closed line; a click within it closes a polygon."""
    angles = [math.tau * corner / _CIRCLE_CORNERS for corner in range(_CIRCLE_CORNERS + 1)]
    return tuple(
        (center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle))
        for angle in angles
    )
