// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_SOCIAL_FORCE_H
#define PHYSSIM_SOCIAL_FORCE_H

#include "surroundings.h"

// The velocity of a pedestrian at the end of a step; `desired` is the velocity that it would have alone; `dt` the
// length of the step [s].
Vec walk_by_social_force(const World *world, const Surroundings *around, const Actor *actor, const Disc *self,
                         Vec desired, double dt);

#endif
