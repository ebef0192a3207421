// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_IMPACT_ISLANDS_H
#define PHYSSIM_IMPACT_ISLANDS_H

#include "swept_boxes.h"

// Whether two bodies have no joint between them, nor a group, by which they pass through each other.
bool may_meet(const Body *a, const Body *b);

// Have bodies that meet in the coming step move on as one, from bodies whose motions could meet others unseen.
void join_impacts(Sweep *sweep, const int *fast, int count);

#endif
