# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A world: requests go in, steps are made, snapshots come out; it knows the present alone.

Not here: when a request comes, and what was before (`past`). Start with `world`, then
`body_requests`, `joint_requests` and `hand_requests`. Other folders import the names below.
"""

from physsim_ros.simulation.world.world import steps_in, World

__all__ = ['World', 'steps_in']
