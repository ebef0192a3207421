// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_JOINT_POSITIONS_H
#define PHYSSIM_JOINT_POSITIONS_H

#include "island_solve.h"

// Solve the positions of an island.
void solve_positions(Solve *solve);

#endif
