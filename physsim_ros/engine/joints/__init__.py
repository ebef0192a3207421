# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Joints: Pymunk's constraints without their bias, and a direct solve after the engine's step.

A file a kind has its constraints and its constraint rows; `joint_solver` solves them together
with the contacts of jointed bodies. Not here: properties and ranges of a kind (`model.joints`),
and which bodies a joint is between (`simulation.world.joint_requests`). Start with `joint_set`,
then `constraint_rows` and `axle`.
"""
