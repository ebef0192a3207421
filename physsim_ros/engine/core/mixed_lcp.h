// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_MIXED_LCP_H
#define PHYSSIM_MIXED_LCP_H

#include "saddle_point.h"

// Solve rows with bounds. `solution` has the first guess of `sides`.
void solve_problem(System *system, const Problem *problem, Solution *solution, Arena *arena);

// Solve them with other targets from the sides of the last solution, whose factors the system has.
void solve_again(System *system, const Problem *problem, Solution *solution, Arena *arena);

// Make one step of iterative refinement against E, which keeps a solution from its targets. Where that would take λ out
// of its bounds, rows change sides.
void refine(System *system, const Problem *problem, Solution *solution, Arena *arena);

#endif
