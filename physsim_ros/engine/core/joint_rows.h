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

// Whether a row gives x a rate, within its greatest force.
static inline bool is_motor(const Row *row) {
    return row->kind == ROW_SPIN || row->kind == ROW_WAY;
}

// Whether a row acts on velocities alone, by a force, rather than holds x within bounds.
static inline bool is_force(const Row *row) {
    return row->kind == ROW_SPRING || is_motor(row);
}

// Whether a row holds x where it is.
static inline bool is_equality(const Row *row) {
    return row->lower == row->upper && !is_force(row);
}

// Return x of a row, and its Jacobian.
double row_at(const Row *row, const Joint *joint, const Anchors *anchors, Pose a, Pose b, Jacobian *jacobian);

// The Jacobian of direction . (p_a - p_b), for points that are `arm_a` and `arm_b` from the centres of mass.
Jacobian along(Vec direction, Vec arm_a, Vec arm_b);

#endif
