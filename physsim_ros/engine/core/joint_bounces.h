// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_JOINT_BOUNCES_H
#define PHYSSIM_JOINT_BOUNCES_H

#include "velocity_rows.h"

// Return the solution with bounces, less the share of them that would create energy.
Solution solve_bounces(Solve *solve, VelocityRows *rows);

#endif
