// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_JOINT_ROWS_H
#define PHYSSIM_JOINT_ROWS_H

#include "core.h"
#include "saddle_point.h"

// The anchors of a joint at some poses of its bodies, in world axes [m].
typedef struct Anchors {
    Vec arm_a, arm_b; // from the centres of mass
    Vec apart;        // from the second anchor to the first
    Rotation of_b;
} Anchors;

Anchors anchors_at(const Joint *joint, Pose a, Pose b);

// The same, of which the rotations are known.
Anchors anchors_turned(const Joint *joint, Vec a, Rotation of_a, Vec b, Rotation of_b);

// Whether a row holds x where it is.
static inline bool is_equality(const Row *row) {
    return row->law == LAW_BOUNDS && row->lower == row->upper;
}

// Whether a row is about the rate of x, wherever x is.
static inline bool is_of_rate(const Row *row) {
    return row->law == LAW_DRIVE || row->law == LAW_FRICTION || row->law == LAW_FALLS || row->law == LAW_RISES;
}

// Return x of a row, and its Jacobian.
double row_at(const Row *row, const Joint *joint, const Anchors *anchors, Pose a, Pose b, Jacobian *jacobian);

// The rate of the upper bound of a row, or of x where it is driven [m/s, rad/s].
static inline double bound_rate(const Row *row) {
    bool ends = row->rate < 0.0 ? row->upper <= row->least : row->upper >= row->greatest;
    return row->law == LAW_BOUNDS && ends ? 0.0 : row->rate;
}

// How many links a row has beside its first (`saddle_point.h`).
static inline int further_count(const Row *row) {
    return row->kind == ROW_PATH ? row->guide_count - 2 : row->guide_count;
}

// Return what a span of a rope, from the guide of a number to the next one, adds to the length of its path, and its
// Jacobian.
double span_at(const Row *row, const Guide *guides, int number, Pose a, Pose b, Jacobian *jacobian);

// Return what a carrier adds to x of a gear that turns about it, and its Jacobian.
double carrier_at(const Joint *joint, Pose carrier, Jacobian *jacobian);

// The Jacobian of direction . (p_a - p_b), for points that are `arm_a` and `arm_b` from the centres of mass.
Jacobian along(Vec direction, Vec arm_a, Vec arm_b);

#endif
