# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The kinds of messages of a page: one function a kind, on the world's thread.

The decorator of a function declares the type of the message, the topic of its answers, the right
that a page needs and the checks of its fields. A new kind is one such function, in the file of
its subject; `make tables` adds it to docs/page_protocol.md.

Not here: the reading of messages (`message`), the session that the functions work on
(`page_session`), the kinds that the server's thread carries out (`server.page_socket`).
"""

from physsim_ros.sketchpad.message import read_message
from physsim_ros.sketchpad.messages import bodies, classroom, drawing, worlds
from physsim_ros.sketchpad.messages.worlds import ACTIONS

__all__ = ['ACTIONS', 'bodies', 'classroom', 'drawing', 'read_message', 'worlds']
