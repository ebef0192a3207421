# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The server of the page, on a thread of its own: what comes from browsers, and what goes to them.

Only this folder imports tornado. Not here: what a message does (`sketchpad.messages`). Start with
`server`, the server of a world, or `class_server`, that of a class; each has a `Site`.
`page_handlers` and `world_handlers` answer over HTTP, `page_socket` receives the messages of a
page, and `frame_feed` sends it frames; every request and every socket is `guarded`.
"""
