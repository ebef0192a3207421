# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The physics engine: Pymunk's space, and the stages that make a step of it accurate.

The only folder that imports Pymunk. `Space` and `RigidBody` are known to `simulation.world` alone;
all else that crosses the border is an immutable value or a fresh array. Not here: requests, time
and history (`simulation`). Start with `space` (bodies, joints, walls).

A property of a body reaches Pymunk by `pymunk_bodies`, and the core by `scene_columns`, which
makes its row of `Body` in `core/core.h`; `body_table` adds its state, and `core_world` passes the
table to `core`, all that happens within a step, in C. `joints` has the kinds of joints.
"""
