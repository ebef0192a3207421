// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_VELOCITY_ROWS_H
#define PHYSSIM_VELOCITY_ROWS_H

#include "island_solve.h"

// The rows of an island in velocities: those of joints, then the two edges of the friction cone of each contact. The
// impulse along an edge, λ >= 0, is one along the normal and μ times as much across it, to one side or the other.
typedef struct VelocityRows {
    Problem problem;
    Jacobian *jacobians;            // (link_count)
    double *wanted, *lower, *upper; // of the problem
    double *rates;                  // (row_count): J v without impulses
    double *last;                   // (row_count): λ of the sub-step before
    double *bounce;                 // (bearing_count): least velocity along the normal that Chipmunk seeks [m/s]
    double *free_slips;             // (bearing_count): velocity across the normal without impulses [m/s]
    double *slips;                  // (bearing_count): greatness of the same after the sub-step
} VelocityRows;

// The rows of an island, given its velocities without their impulses (body_count).
VelocityRows velocity_rows(Solve *solve, const Twist *without);

// A copy of the rows, whose bounds and slips may be changed.
VelocityRows copy_of_rows(const Solve *solve, const VelocityRows *rows);

// Return the solution with some least velocities along the normals of contacts [m/s].
Solution solve_with_bounce(Solve *solve, VelocityRows *rows, const double *bounce);

#endif
