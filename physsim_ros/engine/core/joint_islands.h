// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_JOINT_ISLANDS_H
#define PHYSSIM_JOINT_ISLANDS_H

#include "joint_rows.h"
#include "world.h"

// The row of the rolling resistance of a contact, as that of a bearing with friction: `rolling.c` has its law.
typedef struct RollingRow {
    Row row;
    double impulse, closing; // [N m s]
} RollingRow;

// A point in which a jointed body touches another one.
typedef struct Bearing {
    cpContact *point;
    int a, b; // places of the two bodies in the table
    uintptr_t shapes[2];
    Vec arm_a, arm_b, normal; // world axes [m]; the normal leads from the first to the second body
    double friction;
    double slop;             // overlap that stays [m]
    double slide;            // velocity across the normal of the surfaces against their bodies [m/s]
    double closing;          // impulse along the normal by which an overlap was closed [N s]
    double remaining;        // of the sub-step after the impact; 0 for a contact that does not begin [s]
    double rolling;          // arm of the load ahead of a disc that rolls; 0 is none [m]
    RollingRow *rolling_row; // NULL is none
} Bearing;

// The rotation of a body by a yaw, kept for the next poses with that.
typedef struct Turn {
    double yaw; // [rad]
    Rotation by;
} Turn;

// The rows of an island: those of joints and of rolling resistance, then normals of contacts, then tangents.
typedef struct Island {
    int joint_count, joint_row_count, bearing_count, body_count, row_count;
    const Joint **joints;       // (joint_count)
    Row **rows;                 // (joint_row_count)
    const Joint **joint_of_row; // (joint_row_count): NULL of rolling resistance
    double **impulses;          // (joint_row_count): where Chipmunk stores them [N s, N m s]
    double *last;     // (row_count): impulses before Chipmunk's solver, those of the sub-step before [N s, N m s]
    double **closing; // (joint_row_count): where those of the positions are stored [N s, N m s]
    Bearing *bearings;
    cpBody **engine; // (body_count): dynamic bodies, and those that do not move but are touched or joined
    bool *jointed;   // (body_count)
    Inverse *inverses;
    Turn *turns;
    const Guide *guides; // of all rows
    Ends *ends;          // (link_count)
    int *further;        // (row_count + 1): the first further link of each row (`saddle_point.h`)
    int *groups;         // (row_count): one for rows of a joint between the same bodies, and for a pair that touches
} Island;

// The rows of a bearing: along its normal, and across it.
static inline int normal_row(const Island *island, int bearing) {
    return island->joint_row_count + bearing;
}

static inline int tangent_row(const Island *island, int bearing) {
    return island->joint_row_count + island->bearing_count + bearing;
}

typedef struct Islands {
    int count;
    Island *islands;
    struct Solve *solves; // (count)
} Islands;

// Return the islands of jointed bodies and of what they touch, between Chipmunk's narrow phase and its solver.
Islands joint_islands(World *world);

#endif
