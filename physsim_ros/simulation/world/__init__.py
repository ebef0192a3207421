# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A world: requests go in, steps are made, snapshots come out; it knows only the present.

Not here: the time of a request, and the past (`past`); what needs no space, as the body that a
request describes (`model`). Start with the table of handlers in `world`; those for bodies, robots,
joints and hands are in files of their own. Folders other than `simulation` import the names below.
"""

from physsim_ros.simulation.world.forces_now import forces_now
from physsim_ros.simulation.world.live_space import Beginning, beginning_of, steps_covering
from physsim_ros.simulation.world.world import Change, load_message, World

__all__ = [
    'Beginning',
    'Change',
    'World',
    'beginning_of',
    'forces_now',
    'load_message',
    'steps_covering',
]
