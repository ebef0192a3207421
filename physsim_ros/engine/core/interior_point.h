// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_INTERIOR_POINT_H
#define PHYSSIM_INTERIOR_POINT_H

#include "saddle_point.h"

// Find the sides of the rows of a solution.
void find_sides(System *system, const Problem *problem, Solution *solution, Arena *arena);

#endif
