// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Forces of bodies on each other from afar (`attraction.c`).

#ifndef PHYSSIM_ATTRACTION_H
#define PHYSSIM_ATTRACTION_H

#include "world.h"

// The force on each attractor (attractor_count), a time after now [s, N].
Vec *attractions(World *world, double ahead);

#endif
