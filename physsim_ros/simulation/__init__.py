# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A world and its time: requests go in, frames come out, any past step can be gone back to.

No physics (that is `engine`), no files, topics or threads. Start with `simulation`, the front,
then `request_handler` and `playback` (the moment that is shown); the folder `past` has what is
kept for going back, `world` the present and what requests do to it.
"""
