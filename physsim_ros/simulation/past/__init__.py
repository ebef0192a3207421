# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
What is kept for going back: the log of requests, checkpoints and frames; replay, courses and undo.

Not here: the moment that is shown (`playback`). Start with `past`, which has the budget, then
`timeline`, `history` with its `request_log`, `replay`, `frame_cache` and `undo`.
"""
