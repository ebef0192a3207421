# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tolerances that the engine and the stages share."""

# Overlap that the engine leaves, so that contacts last [m]; its own 0.1 is 10 cm in a metre world.
COLLISION_SLOP = 0.005
