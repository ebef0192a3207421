// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_ROBOTS_H
#define PHYSSIM_ROBOTS_H

#include "world.h"

// The chord of an arc by its length, for the turn along it [rad].
static inline double chord_by_arc(double turn) {
    return turn != 0.0 ? sin(turn / 2.0) / (turn / 2.0) : 1.0;
}

// Whether a robot has a battery, and that is empty.
static inline bool is_empty(const Robot *robot) {
    return robot->battery.capacity > 0.0 && robot->state.drawn >= robot->battery.charge;
}

#endif
