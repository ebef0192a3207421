// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_SPRINGS_H
#define PHYSSIM_SPRINGS_H

#include "world.h"

// Whether a joint is a spring between two points.
static inline bool is_spring_joint(const World *world, const Joint *joint) {
    return joint->part_count > 0 && world->parts[joint->first_part].kind == PART_SPRING;
}

// Mark the bodies that springs and motors hold; have springs with a greatest force obey it.
void prepare_springs(World *world);

// Add what springs change the velocities of some bodies by in a time [s]; `pulled` and `changes` (body_count).
void pull_springs(World *world, const bool *pulled, Twist *changes, double lapse);

#endif
