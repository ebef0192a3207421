# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The gesture of a tool: its clicks so far, and their preview.

Laws: a refused click drops the gesture as a whole. A click that is not a finite point leaves it as
it was.
"""

from __future__ import annotations

from physsim_ros.drawing.click import Click, ClickResult, Tool
from physsim_ros.drawing.geometry import circle_outline
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.tools import TOOLS
from physsim_ros.model.checks import check_point
from physsim_ros.model.preview import Line, Preview
from physsim_ros.model.shapes import as_tuples
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import Text

# Number of sides of the circle around the first corner of a polygon.
_SIDES = 24


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
            return ClickResult(
                message=Text('ignored: no tool is in hand; parameter tool takes one')
            )
        check_point(point, 'point')
        in_world = scene.resolve_point(point, frame)
        check_point(in_world, 'point')
        clicks = (*self._clicks, Click.at_point(scene, in_world))
        # The gesture is over, refused or not, unless the tool needs more clicks.
        self._clicks = ()
        result = TOOLS[self.tool](clicks, scene, settings)
        if not result.requests:
            self._clicks = clicks
        return result

    def preview(self, settings: DrawingSettings) -> Preview:
        """Return the preview of the clicks so far."""
        points = tuple(click.point for click in self._clicks)
        if not points:
            return Preview()
        lines: list[Line] = [points] if len(points) > 1 else []
        if self.tool is Tool.POLYGON:
            # A click within it closes the polygon.
            closing = circle_outline(points[0], settings.snap, sides=_SIDES)
            lines.append(as_tuples(closing))
        return Preview(lines=tuple(lines), points=points, label=str(self.tool))
