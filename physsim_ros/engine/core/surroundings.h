// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// What pedestrians see of a world.

#ifndef PHYSSIM_SURROUNDINGS_H
#define PHYSSIM_SURROUNDINGS_H

#include "world.h"

// A body as pedestrians see it: the disc about its centre of mass.
typedef struct Disc {
    const Body *body;
    Vec point, velocity; // [m], [m/s]
    double radius;       // [m]
    bool walks;          // it is a pedestrian, and avoids others
} Disc;

// Velocities v with n · v >= c.
typedef struct HalfPlane {
    Vec n;
    double c;
} HalfPlane;

// The nearest point of a wall.
typedef struct Nearest {
    double distance; // negative within the wall [m]
    Vec outwards;    // direction from it, of length 1
} Nearest;

// A wall within sight of a pedestrian.
typedef struct Seen {
    const cpShape *wall;
    Nearest nearest;
    double beside; // distance from the line ahead, at most 0 where the line meets it [m]
    int front;     // number of a nearer wall that touches its nearest point; its own if there is none
} Seen;

// All that has to be avoided: discs, and the shapes of what is anchored and no disc.
typedef struct Surroundings {
    Disc *discs;
    int disc_count;
    const cpShape **walls;
    int wall_count;
    const cpShape **anchored; // the shapes of all that is anchored, discs too
    int anchored_count;
    HalfPlane *planes[2]; // room for two of each disc and one of each wall, twice
    Seen *seen;           // room for all walls
} Surroundings;

// Walls and bodies further away than this do nothing [m]: the repulsion of the social force model has decayed to 1e-9
// m/s² there, and ORCA's horizon of the default, 2 s, is nearer at any pace.
static const double farthest_seen = 10.0;

// Whether a pedestrian passes through a body, instead of avoiding it.
static inline bool passes_through(const Body *self, const Body *other) {
    return self == other || share_group(self, other);
}

// The robot of an actor; NULL if it is none.
Robot *robot_of(const World *world, const Actor *actor);

// The arm from the centre of mass to the point that is led.
Vec arm_of(const World *world, const Actor *actor);

bool has_begun(const World *world, const Actor *actor);

// Of bodies that move, and of anchored discs, the disc around them; of others each shape.
Surroundings surroundings_of(World *world);

// A wall as a pedestrian at a point sees it; false if it is too far away, or the pedestrian passes through it.
bool sees_wall(const World *world, const cpShape *wall, const Body *self, Vec point, Nearest *nearest);

// The distance of a wall from the line through a point in a direction, at most 0 where the line meets it.
double distance_beside(const cpShape *wall, Vec point, Vec ahead);

#endif
