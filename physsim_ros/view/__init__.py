# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Rerun: frames become recordings, shown in a window or browser or written to a file.

Not here: topics for RViz and Foxglove (`ros`). Start with `viewer`, then `recording` (entities)
and the folders: `sinks` (threads, queues, windows, files), `meshes` (bodies) and `joints`. Other
folders import the names below; Rerun itself, which takes a second to import, is imported only by
the thread of a worker.
"""

from physsim_ros.view.frame_context import FrameContext
from physsim_ros.view.joints.joint_colors import JointColors
from physsim_ros.view.joints.joint_glyphs import joint_strips, symbol_size
from physsim_ros.view.joints.joint_lines import JointLines, segment_corners
from physsim_ros.view.viewer import Viewer, ViewerMode

__all__ = [
    'FrameContext',
    'JointColors',
    'JointLines',
    'Viewer',
    'ViewerMode',
    'joint_strips',
    'segment_corners',
    'symbol_size',
]
