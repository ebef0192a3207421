// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// A contact (`cpArbiter`) within a sub-step: what its fields are from which stage on.
//
// state: `ARBITER_FIRST_COLLISION` where it begins, by Chipmunk or by the end of being ignored (`first_touch.c`).
// data: not NULL where it is ignored in this sub-step (`one_way.c`, `first_touch.c`); it has no points then.
// n, r1, r2: as the sub-step ends, by Chipmunk; of one that begins, as its bodies first met (`first_touch.c`).
// nMass, tMass: effective masses, by Chipmunk, or `prepare_contact` for another normal; from `steep_friction.c` on,
//     just before the solvers, nMass is that of their rounds, which is less where friction is steep.
// bounce: restitution times the velocity along the normal, < 0 where its bodies approach, by Chipmunk or
//     `prepare_contact`; of an impact, for the moment of it (`rest_of_step.c`); INFINITY of one that is deferred
//     (`impact_propagation.c`); a share of it where an impact would gain energy (`block_solver.c`).
// bias: the velocity by which an overlap is pushed out, by the slop of its bodies (`overlap_bias.c`).
// jnAcc, jtAcc: the impulses of the sub-step before, to start from, until the solvers replace them.

#ifndef PHYSSIM_CONTACT_H
#define PHYSSIM_CONTACT_H

#include "world.h"

static inline bool begins(const cpArbiter *arbiter) {
    return arbiter->state == ARBITER_FIRST_COLLISION;
}

static inline bool is_ignored(const cpArbiter *arbiter) {
    return arbiter->data != NULL;
}

// Have Chipmunk ignore a contact in this sub-step; in the next one it begins.
static inline void ignore(cpArbiter *arbiter) {
    arbiter->data = arbiter;
    arbiter->count = 0;
}

// Approach velocity from which two bodies are in an impact [m/s]; bodies at rest tremble by less.
static const double slowest_impact = 0.05;

// The velocity at which two bodies part in a point, by their twists [m/s].
static inline Vec parting_velocity(const cpContact *point, Twist a, Twist b) {
    return sub(velocity_at(b, point->r2), velocity_at(a, point->r1));
}

// The greatest velocity at which the points of a contact approach along its normal [m/s].
static inline double approach_of(const cpArbiter *arbiter) {
    double approach = -INFINITY;
    for (int number = 0; number < arbiter->count; number++) {
        Vec parting =
            parting_velocity(arbiter->contacts + number, twist_of(arbiter->body_a), twist_of(arbiter->body_b));
        approach = greatest(approach, -dot(parting, arbiter->n));
    }
    return approach;
}

// How far the bodies of a contact are from each other in a point, along its normal; < 0 where they overlap [m].
static inline double gap_at(const cpArbiter *arbiter, const cpContact *point) {
    return dot(sub(add(arbiter->body_b->p, point->r2), add(arbiter->body_a->p, point->r1)), arbiter->n);
}

static inline bool is_impact(const cpArbiter *arbiter) {
    return arbiter->count > 0 && approach_of(arbiter) > slowest_impact;
}

// Whether a contact takes no impulse in this sub-step (`defer_contacts`).
static inline bool is_deferred(const cpContact *point) {
    return point->bounce == INFINITY;
}

#endif
