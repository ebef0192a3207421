# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Rerun: frames become recordings, shown in a window or browser or written to a file.

Not here: topics for RViz and Foxglove (`ros`), and the lines of joints (`appearance`). Start with
`viewer`, then `recording` (entities) and the folders: `sinks` (threads, queues, windows, files)
and `meshes` (bodies). Other folders import the names below. Rerun takes a second to import, so
only the thread of a worker imports it.
"""

from physsim_ros.view.frame_context import FrameContext
from physsim_ros.view.viewer import Viewer, ViewerMode

__all__ = ['FrameContext', 'Viewer', 'ViewerMode']
