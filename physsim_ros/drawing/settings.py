# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The settings of drawing: tolerances of snapping and recognition, defaults of drawn bodies."""

from dataclasses import dataclass
from typing import Annotated

from physsim_ros.model.checks import VELOCITY, Within
from physsim_ros.model.colors import check_color, Color
from physsim_ros.model.declarations import Checked
from physsim_ros.model.shapes import SMALLEST
from physsim_ros.model.transform import Point


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawingSettings(Checked):
    """
    The settings of drawing; each is the ROS parameter of the same name.

    :raises Malformed: a number is not finite
    :raises BadProperty: a value is out of range
    """

    snap: Annotated[
        float,
        Within(0.0, 10.0, 'm'),
        'distance within which ends of strokes, and clicks, move onto bodies, ends of walls and '
        'first corners',
    ] = 0.15
    sketch_confidence: Annotated[
        float,
        Within(0.0, 1.0),
        'least confidence at which a stroke is recognised; for a closed outline, the confidence '
        'that it is a solid of any kind',
    ] = 0.6
    regroup: Annotated[
        float,
        Within(0.0, 10.0, 's'),
        'strokes within this time of one another are read together; 0 reads each alone',
    ] = 0.8
    beautify: Annotated[
        float,
        Within(0.0, 0.5),
        'tolerance for making strokes regular: angles [rad], lengths as a share of their '
        'neighbours; 0 keeps a stroke as it was drawn',
    ] = 0.12
    wall_thickness: Annotated[float, Within(SMALLEST, 10.0, 'm'), 'thickness of drawn walls'] = 0.1
    draw_velocity: Annotated[Point, VELOCITY, 'velocity of new drawn bodies'] = (0.0, 0.0)
    draw_color: Annotated[
        Color | None,
        check_color,
        "colour of drawn bodies: `'#rrggbb'`, `'#rrggbbaa'`, or `auto`, a different one for each",
    ] = None
