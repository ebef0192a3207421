// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Bias of overlaps: bodies of all sizes overlap at rest by a slop of their own size.
//
// Problem: Chipmunk has one slop for all bodies (`collisionSlop`).
// Method: the bias velocity of each point, by which Chipmunk pushes an overlap out (`cpArbiterPreStep`), is that of the
// overlap beyond the lesser slop of the two bodies.
// Cost: 3 ns a contact.

#include "contact.h"
#include "stages.h"

void set_overlap_biases(World *world) {
    double rate = (1.0 - world->own->overlap_kept) / world->dt;
    for (int number = 0; number < arbiter_count(world); number++) {
        const cpArbiter *arbiter = arbiter_at(world, number);
        for (int point = 0; point < arbiter->count; point++) {
            cpContact *contact = arbiter->contacts + point;
            contact->bias = -rate * least(gap_at(arbiter, contact) + slop_of(arbiter), 0.0);
            contact->jBias = 0.0;
        }
    }
}
