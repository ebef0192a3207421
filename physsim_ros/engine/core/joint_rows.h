// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_JOINT_ROWS_H
#define PHYSSIM_JOINT_ROWS_H

#include "saddle_point.h"
#include "world.h"

// The anchors of a joint at some poses of its bodies, in world axes [m].
typedef struct Anchors {
    Vec arm_a, arm_b; // from the centres of mass
    Vec offset;       // from the second anchor to the first
    Vec axis;         // of a slider or a rack, of length 1
    Rotation of_b;
} Anchors;

Anchors anchors_at(const Joint *joint, Pose a, Pose b);

// The same, of which the rotations are known.
Anchors anchors_turned(const Joint *joint, Vec a, Rotation of_a, Vec b, Rotation of_b);

// C of a row: how far x lies outside of its bounds [m, rad].
static inline double excess_of(const Row *row, double x) {
    return greatest(x - row->upper, 0.0) + least(x - row->lower, 0.0);
}

// The factor from the impulse that Chipmunk stores to λ of a row.
static inline double factor_of(const Row *row, double excess) {
    return excess < 0.0 ? row->below : row->above;
}

// Whether a row holds x where it is.
static inline bool is_equality(const Row *row) {
    return row->law == LAW_BOUNDS && row->lower == row->upper;
}

// Whether a row is about the rate of x, wherever x is.
static inline bool is_of_rate(const Row *row) {
    return row->law == LAW_DRIVE || row->law == LAW_FRICTION || row->law == LAW_FALLS || row->law == LAW_RISES;
}

// The rate of the upper bound of a row, or of x where it is driven [m/s, rad/s].
static inline double bound_rate(const Row *row) {
    bool ends = row->rate < 0.0 ? row->upper <= row->least : row->upper >= row->greatest;
    return row->law == LAW_BOUNDS && ends ? 0.0 : row->rate;
}

// How many links a row has beside its first (`saddle_point.h`).
static inline int further_count(const Row *row) {
    return row->kind == ROW_PATH ? row->guide_count - 2 : row->guide_count;
}

// The links of a row (`saddle_point.h`): the numbers of its first one and of the one after it, and all links and poses.
typedef struct Links {
    int first, further;
    const Ends *ends;  // of the links, as places among the poses
    const Pose *poses; // of bodies
} Links;

// Return x of a row, and the Jacobians of its links. `anchors` are those of its joint; an angle and a path need none.
double row_at(const Row *row, const Guide *guides, const Anchors *anchors, Links links, Jacobian *jacobians);

// Return x of a row after a time at the velocities of now [s], and the Jacobian of its last link.
double row_after(const World *world, const Joint *joint, const Row *row, double lapse, Jacobian *last);

// The Jacobian of direction . (p_a - p_b), for points that are `arm_a` and `arm_b` from the centres of mass.
Jacobian line_jacobian(Vec direction, Vec arm_a, Vec arm_b);

#endif
