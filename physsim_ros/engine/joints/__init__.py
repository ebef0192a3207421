# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Joints: Pymunk's constraints without their bias, and the correction of positions after a step.

A file a kind has its constraints, its constraint rows and its centripetal term; `projection`
closes gaps. Not here: properties and ranges of a kind (`model.joints`), and which bodies a joint
is between (`simulation.joint_requests`). Start with `joint_set`, then `kind` and `axle`.
"""
