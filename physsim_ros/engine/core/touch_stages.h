// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The parts of the first touch (`first_touch.c`).

#ifndef PHYSSIM_TOUCH_STAGES_H
#define PHYSSIM_TOUCH_STAGES_H

#include "touch.h"

// Replace normal and points of the contact of a disc by those of its impact.
void move_to_impact(const World *world, Touch *touch);

// A contact at a face that a disc has met, of those that begin.
typedef struct MetFace {
    uintptr_t disc; // number of its shape
    const Touch *touch;
} MetFace;

// List the faces that discs have met, by discs (count); return how many there are.
int list_met_faces(const Touch *touches, int count, MetFace *faces);

// Whether the contact of a disc is at a corner in or behind the plane of a face that it has met before, of such a list.
bool is_hidden(const Touch *touch, const MetFace *faces, int count);

// Replace a contact at a seam by one with the face that the shapes approach slowest; return whether it is at one.
bool slide_over_edge(Touch *touch);

#endif
