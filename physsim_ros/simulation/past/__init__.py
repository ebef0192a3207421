# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The past of a world: a tree of requests with checkpoints, cached frames, replay, courses and undo.

Not here: the moment that is shown (`playback`). Start with the theory of operation at the head of
`tree`, then `past`, `history`, `lines`, `timeline` and `frame_cache`.
"""
