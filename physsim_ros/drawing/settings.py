# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The settings of drawing: tolerances of snapping and recognition, defaults of drawn bodies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from physsim_ros.model.checks import Checked, Checks, velocity, Within
from physsim_ros.model.colors import check_color, Color
from physsim_ros.model.shapes import SMALLEST
from physsim_ros.model.transform import Point

# Ranges of the scalar settings.
DRAWING_RANGES = {
    'snap': Within(0.0, 10.0, 'm'),
    'sketch_confidence': Within(0.0, 1.0),
    'regroup': Within(0.0, 10.0, 's'),
    'beautify': Within(0.0, 0.5),
    'wall_thickness': Within(SMALLEST, 10.0, 'm'),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawingSettings(Checked):
    """
    The settings of drawing; each is the ROS parameter of the same name.

    :param snap: the greatest distance at which an end of a stroke, or a click, snaps to a body, an
        end of a wall or a first corner [m], 0 .. 10
    :param sketch_confidence: the least confidence with which a stroke is accepted, 0 .. 1; for a
        closed outline, the confidence that it is a solid of any kind
    :param regroup: the longest time between strokes that are read together [s], 0 .. 10; with 0
        each stroke is read by itself
    :param beautify: tolerance of regularisation, 0 .. 0.5: an angle [rad] from right, horizontal
        or vertical, a length in shares of its neighbour; 0 keeps the geometry as it was drawn
    :param wall_thickness: of drawn walls [m], 0.001 .. 10
    :param draw_velocity: of drawn bodies [m/s]
    :param draw_color: of drawn bodies, red, green, blue, alpha, each 0 .. 1; None chooses a colour
        for each body
    :raises Malformed: a number is not finite
    :raises BadProperty: a value is out of range
    """

    CHECKS: ClassVar[Checks] = {
        'draw_velocity': velocity,
        'draw_color': check_color,
        **DRAWING_RANGES,
    }

    snap: float = 0.15
    sketch_confidence: float = 0.6
    regroup: float = 0.8
    beautify: float = 0.12
    wall_thickness: float = 0.1
    draw_velocity: Point = (0.0, 0.0)
    draw_color: Color | None = None
