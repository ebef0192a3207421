# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The sketchpad: a page in the browser that shows the world and draws in it.

A message goes down, an answer and a frame go up::

    page/                               scripts in the browser
    server/page_socket, frame_feed      the server's thread: checks messages, sends frames
    inbox                               messages between the threads
    sketchpad, page_session, messages/  the world's thread: carries messages out

Not here: ROS (`ros` has the node's `WorldControl`), the reading of strokes (`drawing`). Start with
`sketchpad`. Other folders import the names below.
"""

from physsim_ros.sketchpad.locks import locks_of
from physsim_ros.sketchpad.results import results_file
from physsim_ros.sketchpad.rights import Role
from physsim_ros.sketchpad.server.class_server import ClassServer
from physsim_ros.sketchpad.server.seats import WorldAddresses
from physsim_ros.sketchpad.sketchpad import Sketchpad
from physsim_ros.sketchpad.world_control import WorldControl

__all__ = [
    'ClassServer',
    'Role',
    'Sketchpad',
    'WorldAddresses',
    'WorldControl',
    'locks_of',
    'results_file',
]
