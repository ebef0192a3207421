// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_ORCA_H
#define PHYSSIM_ORCA_H

#include "surroundings.h"

// The velocity of a pedestrian at the end of a step; `desired` is the velocity that it would have alone.
Vec walk_by_orca(const World *world, const Surroundings *around, const Actor *actor, const Disc *self, Vec desired);

#endif
