# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tolerances that the engine and the stages share."""

# Overlap that the engine leaves, so that contacts last [m]; its own 0.1 is 10 cm in a metre world.
COLLISION_SLOP = 0.005
# Share of an overlap beyond that which is left after a second: Pymunk's own, 0.9 after 1/60 s.
COLLISION_BIAS = 0.9**60
