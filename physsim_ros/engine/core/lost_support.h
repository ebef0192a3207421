// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_LOST_SUPPORT_H
#define PHYSSIM_LOST_SUPPORT_H

#include "world.h"

// Whether a body may have lost what it rested on.
static inline bool is_loose(const Body *body) {
    return body->state.released && body->dynamic;
}

// Whether a contact pressed on its bodies in the last sub-step.
static inline bool presses(const cpArbiter *arbiter) {
    for (int number = 0; number < arbiter->count; number++) {
        if (arbiter->contacts[number].jnAcc != 0.0 || arbiter->contacts[number].jtAcc != 0.0) {
            return true;
        }
    }
    return false;
}

// Find which bodies have lost all that they rested on; `unsupported` (body_count) is 0 before.
void find_unsupported(World *world, uint8_t *unsupported);

#endif
