# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Settings of Pymunk's space that are the same in all worlds, and tolerances that stages share."""

from __future__ import annotations

import pymunk

# Overlap that the engine leaves, so that contacts last [m]; Pymunk's own 0.1 is 10 cm in a metre
# world.
COLLISION_SLOP = 0.005
# Overlap of small bodies at rest, as a share of the inner radius: 5 mm of a box of 10 cm.
SLOP_SHARE = 0.1
# An island sleeps when none of its bodies had more kinetic energy than at this speed [m/s]: a ball
# that rolls at 1 cm/s stays awake. Pymunk's default, g dt, is 4 cm/s at 240 Hz.
IDLE_SPEED = 0.005
# Time for which it has to be so slow [s].
IDLE_TIME = 0.5


def make_space() -> pymunk.Space:
    """Return an empty space of Pymunk."""
    space = pymunk.Space()
    space.collision_slop = COLLISION_SLOP
    # Contacts of the last step only are listed, and those that parted are forgotten at once.
    space.collision_persistence = 1
    space.sleep_time_threshold = IDLE_TIME
    space.idle_speed_threshold = IDLE_SPEED
    return space
