# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The look of joints and scans: line strips, symbols, colours and points, as arrays.

Markers for RViz (`ros`), recordings for Rerun (`view`) and the small pictures of world files
(`sketchpad`) have the joints of `JointGlyphs`; the page draws joints by symbols of its own, and
takes the scans. `picture` draws a world by Pillow, for a program without a window. Neither ROS nor
Rerun is imported here. Start with `joint_strips`, which has the lines of each kind.
"""

from physsim_ros.appearance.joint_colors import full_scale_force, nice_number, PULL, PUSH, SLATE
from physsim_ros.appearance.joint_glyphs import JointGlyphs, segment_corners, Symbol
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
