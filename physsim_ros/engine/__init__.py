# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The physics engine: Pymunk's space, and the stages that make a step of it accurate.

The only folder that imports Pymunk. `Space` and `RigidBody` are known to `simulation.world` alone;
all else that crosses the border is an immutable value or a fresh array. Not here: requests, time
and history (`simulation`). Start with `space` (bodies, joints, walls); `bodies` has them in
Pymunk, `body_table` as the core steps them. `core` has all that happens within a step, in C;
`joints` has the kinds of joints.
"""
