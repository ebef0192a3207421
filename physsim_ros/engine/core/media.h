// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Forces of media on bodies: buoyancy, drag and flow (`media.c`).

#ifndef PHYSSIM_MEDIA_H
#define PHYSSIM_MEDIA_H

#include "boxes.h"
#include "immersion.h"

// A basin that a disc around a body reaches.
typedef struct Reached {
    int basin;
    Containment containment;
} Reached;

// The media of a world at a moment.
typedef struct Media {
    Basin *basins;
    Twist *currents; // of the medium in each: flow and gusts, as the region moves
    int basin_count;
    Tree tree;         // of the boxes of the basins
    Reached *reached;  // (basin_count): scratch, those around one body
    const Region *air; // NULL is none
    Twist wind;
} Media;

// The matrix D of velocity x, velocity y and spin by which drag slows a body: drag has no direction of its own, so that
// D is linear * v + turning * w, and turning . v + angular * w.
typedef struct Drag {
    double linear;  // [N s/m]
    Vec turning;    // [N s]
    double angular; // [N m s]
} Drag;

// A symmetric matrix of velocity x, velocity y and spin.
typedef struct Symmetric {
    double xx, xy, yy, xw, yw, ww;
} Symmetric;

// The force of the media on a body: steady - D q, of its twist q.
typedef struct FluidForce {
    Twist steady; // buoyancy, and the drag of what flows [N, N m]
    Drag drag;    // D
    bool has_drag;
    Symmetric inverse; // of M + D t, with the time t after which the velocity counts
    bool found;        // in this step
} FluidForce;

// The media a time after now [s].
Media media_of(World *world, double ahead);

// The motion of a body up to the moment that the force of the media is of.
typedef struct Flight {
    bool free;    // no contact or joint acts on it
    double ahead; // until that moment [s]
    Twist now;
    Twist guess;  // of its twist at that moment
    Twist others; // other forces; of attraction, only the guess knows [N, N m]
} Flight;

// The force of the media on a body at a pose, in times of a length [s].
FluidForce fluid_force(World *world, const Media *media, Body *body, Pose pose, const Flight *flight, double lapse);

// Whether a region that moves has come to a body.
bool reaches(const Media *media, const Body *body);

// The mean of that force in such a time, which begins with a twist, under other forces [N, N m].
Twist mean_fluid_force(const FluidForce *fluid, const cpBody *engine, Twist twist, Twist others);

#endif
