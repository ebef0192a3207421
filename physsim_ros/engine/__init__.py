# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The physics engine: Pymunk's space, and the stages that make a step of it accurate.

The only folder that imports Pymunk; an immutable value or a fresh array is all that crosses its
border. Not here: requests, time and history (`simulation`). Start with `pipeline`, the stages of a
step in their order, then `space` (bodies, joints, walls) and `body_table` (bodies by column).
`stages`, `ccd`, `joints` and `contacts` are the packages of the pipeline.
"""
