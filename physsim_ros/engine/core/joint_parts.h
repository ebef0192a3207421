// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_JOINT_PARTS_H
#define PHYSSIM_JOINT_PARTS_H

#include "world.h"

// Where Chipmunk stores an impulse of a constraint; a pivot has two.
double *impulse_at(const Part *part, int component);

// The impulse of a constraint in the last sub-step; of all but pivots in the first component.
Vec impulse_of_part(const Part *part);

#endif
