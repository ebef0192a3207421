# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Rerun: frames become recordings, shown in a window or browser or written to a file.

Not here: topics for RViz and Foxglove (`ros`), and the lines of joints (`appearance`). Start with
`viewer`. An `endpoint_thread` logs frames to one of the `endpoints`, a program, or to a file
(`file_endpoint`); `recording` has what is drawn. Other folders import the names below. Rerun takes
a second to import, so only the thread of an output imports it.
"""

from physsim_ros.view.frame_context import FrameContext
from physsim_ros.view.viewer import Viewer, ViewerMode

__all__ = ['FrameContext', 'Viewer', 'ViewerMode']
