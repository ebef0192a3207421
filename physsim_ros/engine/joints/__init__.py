# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Joints: Pymunk's constraints without their bias, and the constraint rows that the core solves.

`kinds` has the constraints and rows of each kind, `joint_set` the joints of a space, `joint_table`
what the core reads of them. Not here: the solver (`engine/core/joint_solver.c`), properties and
ranges of a kind (`model.joints`), and which bodies a joint is between
(`simulation.world.joint_requests`). Start with `kinds`, then `joint_set`.
"""
