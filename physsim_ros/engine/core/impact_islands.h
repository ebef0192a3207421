// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_IMPACT_ISLANDS_H
#define PHYSSIM_IMPACT_ISLANDS_H

#include "swept_boxes.h"

// Whether two bodies collide: no joint between them, and no group, excludes that.
bool may_meet(const Body *a, const Body *b);

// Merge bodies that meet in the coming sub-step into islands, starting from `fast`: bodies that could pass through
// others.
void join_impacts(Sweep *sweep, const int *fast, int count);

#endif
