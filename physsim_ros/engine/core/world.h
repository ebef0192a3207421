// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// What the core keeps of a world, for the stages.

#ifndef PHYSSIM_WORLD_H
#define PHYSSIM_WORLD_H

#include "arena.h"
#include "core.h"
#include "vector.h"
#include <stdbool.h>

typedef struct Private {
    Arena arena;
    // Places of bodies by the address of their `cpBody`: a hash table with open addressing, of a power of two.
    struct Slot *slots;
    uintptr_t slot_count;
    // Places of dynamic bodies with joints that have rows.
    int *jointed;
    int jointed_count;
} Private;

// Return the place of a body in the table.
int place_of(const World *world, const cpBody *body);

static inline Pose pose_of(const cpBody *body) {
    return (Pose){body->p, body->a};
}

static inline Twist twist_of(const cpBody *body) {
    return (Twist){body->v, body->w};
}

static inline void set_twist(cpBody *body, Twist twist) {
    body->v = twist.v;
    body->w = twist.w;
}

// Set the pose of a body whose centre of mass is its origin, as `cpBodySetPosition` and `cpBodySetAngle` do.
void set_pose(cpBody *body, Pose pose);

// The next contact in the list of a body.
static inline cpArbiter *next_of(const cpArbiter *arbiter, const cpBody *body) {
    return arbiter->body_a == body ? arbiter->thread_a.next : arbiter->thread_b.next;
}

#endif
