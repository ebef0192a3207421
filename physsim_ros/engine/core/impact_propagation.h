// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_IMPACT_PROPAGATION_H
#define PHYSSIM_IMPACT_PROPAGATION_H

#include "world.h"

// Approach velocity from which two bodies are in an impact [m/s]; bodies at rest tremble by less.
static const double slowest_impact = 0.05;

// The greatest velocity at which the points of a contact approach along its normal [m/s].
static inline double approach_of(const cpArbiter *arbiter) {
    double approach = -INFINITY;
    for (int number = 0; number < arbiter->count; number++) {
        const cpContact *point = arbiter->contacts + number;
        Vec a = velocity_at(twist_of(arbiter->body_a), point->r1),
            b = velocity_at(twist_of(arbiter->body_b), point->r2);
        approach = greatest(approach, dot(sub(a, b), arbiter->n));
    }
    return approach;
}

static inline bool is_impact(const cpArbiter *arbiter) {
    return arbiter->count > 0 && approach_of(arbiter) > slowest_impact;
}

// Whether a contact takes no impulse in this step (`defer_contacts`).
static inline bool is_deferred(const cpContact *point) {
    return point->bounce == INFINITY;
}

#endif
