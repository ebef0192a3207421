# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The look of joints in every picture: lines, symbols and the colours of forces, as NumPy arrays.

Markers for RViz (`ros`) and recordings for Rerun (`view`) are drawn with these; neither ROS nor
Rerun is imported here. Start with `joint_glyphs`, which has the lines of each kind.
"""

from physsim_ros.appearance.joint_colors import (
    full_scale_force,
    JointColors,
    nice_number,
    PULL,
    PUSH,
    SLATE,
)
from physsim_ros.appearance.joint_glyphs import is_rigid, joint_strips, Strip, symbol_sizes
from physsim_ros.appearance.joint_lines import JointLines, segment_corners

__all__ = [
    'PULL',
    'PUSH',
    'SLATE',
    'JointColors',
    'JointLines',
    'Strip',
    'full_scale_force',
    'is_rigid',
    'joint_strips',
    'nice_number',
    'segment_corners',
    'symbol_sizes',
]
