# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A world and its time: requests go in, frames come out, and every step of the past can be shown.

Not here: physics (`engine`), files, topics, threads. Start with the front, `simulation`, then
`request_queue` and `playback` (the moment that is shown). `past` has what is kept for going back,
replay and undo; `world` has the present and the handlers of requests.
"""
