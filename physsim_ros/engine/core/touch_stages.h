// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The parts of the first touch (`first_touch.c`).

#ifndef PHYSSIM_TOUCH_STAGES_H
#define PHYSSIM_TOUCH_STAGES_H

#include "touch.h"

// Replace normal and points of the contact of a disc, or of a corner that is fast, by those of its impact.
void move_to_impact(const World *world, Touch *touch);

// List the contacts at faces, of those that begin, by the shapes that met these with a corner; return their number.
int list_faces(const Touch *touches, int count, const Touch **faces);

// Whether a contact lies in or behind the plane of a face that one of its shapes has met before.
bool is_hidden(const Touch *touch, const Touch *const *faces, int count);

// Replace a contact at a seam by one with the face that the shapes approach slowest; return whether it is at one.
bool slide_over_edge(Touch *touch);

#endif
