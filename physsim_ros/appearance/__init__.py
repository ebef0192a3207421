# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The look of joints and scans in every picture: lines, symbols, colours, points, as arrays.

`picture` draws a world by Pillow, for a program without a window.

Markers for RViz (`ros`), recordings for Rerun (`view`) and the page (`sketchpad`) are drawn with
these; neither ROS nor Rerun is imported here. Start with `joint_glyphs`, which has the lines
of each kind.
"""

from physsim_ros.appearance.joint_colors import (
    full_scale_force,
    nice_number,
    PULL,
    PUSH,
    SLATE,
)
from physsim_ros.appearance.joint_lines import JointGlyphs, segment_corners, Symbol
from physsim_ros.appearance.laser_scans import LaserScans
from physsim_ros.appearance.picture import picture_of

__all__ = [
    'PULL',
    'PUSH',
    'SLATE',
    'JointGlyphs',
    'LaserScans',
    'Symbol',
    'full_scale_force',
    'nice_number',
    'picture_of',
    'segment_corners',
]
