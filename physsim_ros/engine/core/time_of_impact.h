// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_TIME_OF_IMPACT_H
#define PHYSSIM_TIME_OF_IMPACT_H

#include "motion.h"

// The share of the sub-step at which two movers first overlap by the skin, and would still approach by more than
// `depth` [m]; INFINITY if never.
double first_impact(World *world, const Mover *one, const Mover *other, double depth);

#endif
