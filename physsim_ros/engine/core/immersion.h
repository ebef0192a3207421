// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Which part of a body lies in a region, and what of its outline is wet (`immersion.c`).

#ifndef PHYSSIM_IMMERSION_H
#define PHYSSIM_IMMERSION_H

#include "arena.h"
#include "outline.h"
#include "world.h"

// A convex piece of a region, in the world.
typedef struct Basin {
    const Region *region;
    bool moves;    // with its body
    Vec center;    // of a disc around it [m]
    double radius; // of that disc [m]
    Vec *corners;  // counter-clockwise [m]
    Vec *normals;  // outwards, of the edge that begins at each corner, of length 1
    int count;
} Basin;

// A straight part of a wet outline; the body is on its left.
typedef struct Side {
    Vec begin, end; // [m]
} Side;

// A round part of a wet outline. Those of one disc may be of either sign; they count by their sum.
typedef struct Bow {
    Vec center;      // [m]
    double radius;   // [m]
    double from, to; // angles [rad]
} Bow;

// What of a body is in a region; positions are from its centre of mass, in axes of the world.
typedef struct Immersion {
    double area;      // [m²]
    Vec first_moment; // area times centroid [m³]
    Side *sides;
    Bow *bows;
    int side_count, bow_count, side_room, bow_room;
} Immersion;

typedef enum Containment { OUTSIDE, CROSSING, INSIDE } Containment;

// The piece of a region at a pose of its body.
Basin basin_of(const Region *region, const cpShape *shape, Pose pose, Arena *arena);

// How a disc around a body lies to a piece of a region.
Containment containment_of(const Basin *basin, Vec center, double reach);

// What of a body at a pose is wet; no basin is all of it. The outline is left out where nothing needs it.
Immersion immersed(const Body *body, Pose pose, const Basin *basin, bool outlined, Arena *arena);

#endif
