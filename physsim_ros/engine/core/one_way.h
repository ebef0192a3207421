// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_ONE_WAY_H
#define PHYSSIM_ONE_WAY_H

#include "world.h"

static inline bool is_one_way(const Body *body) {
    return body->one_way.x != 0.0 || body->one_way.y != 0.0;
}

static inline bool is_of_one_way(const cpArbiter *arbiter) {
    return is_one_way(body_of(arbiter->body_a)) || is_one_way(body_of(arbiter->body_b));
}

// Whether a contact of two shapes, one of them of a one-way body, carried a load in the sub-step before.
bool was_loaded(const World *world, const cpShape *a, const cpShape *b);

// Whether a body at a yaw is closed on the side that a normal leads out of; but for a one-way body it always is.
bool is_closed(const Body *body, double yaw, Vec normal);

#endif
