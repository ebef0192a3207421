# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Robots in the engine: what drives do in a step, and what odometry makes of it.

The force between wheels and floor is not here but in `engine.stages.floor`. Start with `drives`.
"""
