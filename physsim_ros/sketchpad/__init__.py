# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The sketchpad: a page in the browser that shows the world and draws in it.

Not here: ROS (`ros` has the node's `WorldControl`), the reading of strokes (`drawing`). The
server runs on a thread of its own. Start with `sketchpad`, then `page_socket`, `message` and
`page_session`, the path of a message; `server` and `frame_feed` are the way back. `page/` has the
files that a browser runs. Other folders import the names below.
"""

from physsim_ros.sketchpad.class_server import ClassServer, World
from physsim_ros.sketchpad.rights import locks_of, Role
from physsim_ros.sketchpad.sketchpad import Sketchpad
from physsim_ros.sketchpad.world_control import WorldControl

__all__ = ['ClassServer', 'Role', 'Sketchpad', 'World', 'WorldControl', 'locks_of']
