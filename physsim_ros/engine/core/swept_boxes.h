// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_SWEPT_BOXES_H
#define PHYSSIM_SWEPT_BOXES_H

#include "boxes.h"

// Shapes that never move.
typedef struct Statics {
    int count;
    Mover *movers;
    Tree tree;
} Statics;

// The coming sub-step: bodies, then shapes that never move.
typedef struct Sweep {
    World *world;
    int count; // of bodies
    Mover *movers;
    Tree tree;
    const Statics *statics;
    bool *followed; // (count): bodies that are followed in this round
} Sweep;

static inline Mover *mover_at(const Sweep *sweep, int number) {
    assert(number >= 0 && number < sweep->count + sweep->statics->count);
    return number < sweep->count ? sweep->movers + number : sweep->statics->movers + (number - sweep->count);
}

// Return the shapes that never move, but sensors.
const Statics *statics_of(World *world);

// The displacement and the rotation of a body in the sub-step [m, rad].
typedef Twist DisplacementOf(const World *world, const Body *body);

static inline bool is_solid(const Body *body) {
    return !body->anchored && !body->sensor;
}

// The greatest distance by which a point of a body is displaced [m]; a disc covers the same ground however it turns.
static inline double farthest_displaced(const Body *body, Twist displacement) {
    return length(displacement.v) + fabs(displacement.w) * body->turning_radius;
}

// Whether a body could meet others on a displacement unseen by Chipmunk: of two that approach by more than the safe
// depth of one, at least one is displaced by more than half of it.
static inline bool is_far(const World *world, const Body *body, Twist displacement) {
    return is_solid(body) && farthest_displaced(body, displacement) > world->own->least_depth / 2.0;
}

// A body that moves from a pose by a displacement in the sub-step.
Mover mover_of(Body *body, Pose begin, Twist displacement);

// All bodies, each with its displacement in the sub-step.
Sweep sweep_of(World *world, DisplacementOf *displacement_of);

// Bound the displacement of a body from where its motion begins to its horizon.
void fit_box(Mover *mover);

// Bring the horizons of bodies nearer until they meet no more than the budget permits.
void cut_horizons(Sweep *sweep, const int *bodies, int count);

// Whether the boxes of two movers overlap at one time, which move on straight lines.
bool come_near(const Mover *one, const Mover *other);

#endif
