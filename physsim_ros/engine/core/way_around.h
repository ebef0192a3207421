// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The path of a pedestrian around a wall.

#ifndef PHYSSIM_WAY_AROUND_H
#define PHYSSIM_WAY_AROUND_H

#include "surroundings.h"

// The direction, of length 1, in which a pedestrian walks to a point: straight, or around the first wall in between.
Vec heading_to(const World *world, const Surroundings *around, const Disc *self, Vec point);

#endif
