// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The parts of the first touch (`first_touch.c`).

#ifndef PHYSSIM_TOUCH_STAGES_H
#define PHYSSIM_TOUCH_STAGES_H

#include "touch.h"

// Replace normal and points of the contact of a disc by those of its impact.
void move_to_impact(const World *world, Touch *touch);

// Whether the contact of a disc is at a corner in or behind the plane of a face that it has met before, of the contacts
// that begin.
bool is_hidden(const Touch *touch, const Touch *touches, int count);

// Replace a contact at a seam by one with the face that the shapes approach slowest; return whether it is at one.
bool slide_over_edge(Touch *touch);

#endif
