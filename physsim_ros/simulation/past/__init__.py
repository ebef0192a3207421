# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
What is kept for going back: a tree of requests with checkpoints; frames, replay, courses and undo.

Not here: the moment that is shown (`playback`). Start with the head of `tree`, which tells the
theory of operation, then `past`, `history`, `lines`, `timeline` and `frame_cache`.
"""
