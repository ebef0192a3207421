// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_JOINT_VELOCITIES_H
#define PHYSSIM_JOINT_VELOCITIES_H

#include "island_solve.h"

// Solve the velocities of an island.
void solve_velocities(Solve *solve);

#endif
