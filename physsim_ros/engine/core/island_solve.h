// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_ISLAND_SOLVE_H
#define PHYSSIM_ISLAND_SOLVE_H

#include "joint_islands.h"

// Violated limits are closed but for this [m, rad]: Chipmunk stops a limit while it is violated.
static const double limit_slop = 1e-4;

// The fastest that a gap is closed at [m/s, rad/s]: a body that is put elsewhere comes back like a thrown one, and
// joints that contradict each other move their bodies no further than that.
static const double fastest_correction = 20.0;

// One island in one sub-step.
typedef struct Solve {
    Arena *arena;
    double dt;           // [s]
    double overlap_kept; // share of an overlap that is not pushed out in a sub-step
    const Island *island;
    System system;
    Twist *velocities;   // (body_count): of this sub-step
    Pose *poses;         // (body_count)
    double *excess;      // (joint_row_count): C [m, rad]
    Jacobian *jacobians; // (link_count): where the step of Chipmunk ends
    bool *holds;         // (joint_row_count): rows of joints that have not reached their greatest force
    bool *springs;       // (row_count)
} Solve;

Layout layout_of(const Island *island);

// Begin to solve an island.
Solve island_solve(World *world, const Island *island, const System *system);

// Solve the velocities of an island (`joint_velocities.c`), then its positions (`joint_positions.c`).
void solve_velocities(Solve *solve);
void solve_positions(Solve *solve);

// Read the rows of joints at some poses: C, and J as the first of `jacobians`.
void read_rows(const Island *island, const Pose *poses, double *excess, Jacobian *jacobians);

// Bounds of λ of a row of a joint, without its greatest force.
static inline double lower_bound(const Row *row, bool holds, double excess) {
    bool pulls = row->law == LAW_BOUNDS ? row->lower == row->upper || excess > 0.0 : row->law != LAW_RISES;
    return holds && pulls ? -INFINITY : 0.0;
}

static inline double upper_bound(const Row *row, bool holds, double excess) {
    bool pushes = row->law == LAW_BOUNDS ? row->lower == row->upper || excess < 0.0 : row->law != LAW_FALLS;
    return holds && pushes ? INFINITY : 0.0;
}

// The side of a row by a guess of λ.
static inline int8_t side_by_guess(double guess, double lower, double upper) {
    return (int8_t)(guess <= lower ? -1 : guess >= upper ? 1 : 0);
}

// The share of a gain of energy that what was lost pays for.
static inline double paid_share(double lost, double gained) {
    double owed = greatest(gained, 1e-300);
    return least(greatest(lost, 0.0), owed) / owed;
}

// Add changes to the velocities, here and in Chipmunk.
void change_velocities(Solve *solve, const Twist *changes, double share);

#endif
