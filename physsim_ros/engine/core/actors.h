// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// What pedestrians see of a world, and the models by which they walk.

#ifndef PHYSSIM_ACTORS_H
#define PHYSSIM_ACTORS_H

#include "world.h"

// A body as pedestrians see it: the disc about its centre of mass.
typedef struct Disc {
    const Body *body;
    Vec place, velocity; // [m], [m/s]
    double radius;       // [m]
    bool walks;          // it is a pedestrian, and avoids others
} Disc;

// Velocities v with n · v >= c.
typedef struct HalfPlane {
    Vec n;
    double c;
} HalfPlane;

// All that has to be avoided: discs, and the shapes of what is anchored and no disc.
typedef struct Surroundings {
    Disc *discs;
    int disc_count;
    const cpShape **walls;
    int wall_count;
    HalfPlane *planes[2]; // room for one of each of these, twice
} Surroundings;

// The nearest point of a wall.
typedef struct Nearest {
    double distance; // negative within the wall [m]
    Vec outwards;    // direction from it, of length 1
} Nearest;

// Walls and bodies further away than this do nothing [m]: the repulsion of the social force model has decayed to 1e-9
// m/s² there, and ORCA's horizon of the default, 2 s, is nearer at any pace.
static const double farthest_seen = 10.0;

// Whether a pedestrian minds a body at all.
static inline bool passes_through(const Body *self, const Body *other) {
    return self == other || (self->group != 0 && self->group == other->group);
}

// A wall as a pedestrian at a place sees it; false if it is too far away.
bool sees_wall(const World *world, const cpShape *wall, Vec place, Nearest *nearest);

// The velocity of a pedestrian at the end of a step, by its model.
//
// `desired` is the velocity that it would have alone; `dt` the length of the step [s].
Vec walk_by_social_force(const World *world, const Surroundings *around, const Actor *actor, const Disc *self,
                         Vec desired, double dt);
Vec walk_by_orca(const World *world, const Surroundings *around, const Actor *actor, const Disc *self, Vec desired);

#endif
