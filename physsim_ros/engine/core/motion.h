// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Rigid motions in the coming sub-step; time is a share of the sub-step.

#ifndef PHYSSIM_MOTION_H
#define PHYSSIM_MOTION_H

#include "outline.h"
#include "world.h"

// A rectangle along the axes [m].
typedef struct Box {
    Vec low, high;
} Box;

static const Box nowhere = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};

static inline bool overlap(Box a, Box b) {
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}

static inline Box united(Box a, Box b) {
    return (Box){{least(a.low.x, b.low.x), least(a.low.y, b.low.y)},
                 {greatest(a.high.x, b.high.x), greatest(a.high.y, b.high.y)}};
}

// The box of all within a reach of a point that moves along a line [m].
static inline Box box_of_way(Vec start, Vec end, double reach) {
    Box line = united((Box){start, start}, (Box){end, end});
    return (Box){sub(line.low, vec(reach, reach)), add(line.high, vec(reach, reach))};
}

// The box of a body that goes on at its velocity for a time [s].
static inline Box box_ahead(const Body *body, double seconds) {
    Vec start = body->engine->p;
    return box_of_way(start, add(start, scaled(body->engine->v, seconds)), body->reach);
}

// A body, or a shape that never moves, in the coming sub-step.
typedef struct Mover {
    Body *body;
    const cpShape *shape; // the only one that counts; NULL is all of the body
    bool movable;         // forces move it
    bool met;             // it has met another one, and is merged into its island
    int island;           // first member of the island of what has met
    int next;             // following member of the island; -1 is none
    int leader;           // what the island of this first member moves as; -1 is none
    double since;         // share of the sub-step from which on the motion holds
    Pose pose;            // then
    Vec pivot;            // centre of rotation then [m]
    Twist rate;           // displacement of the centre of rotation, and rotation, in a whole sub-step [m, rad]
    double depth;         // how far it may be entered in a sub-step unseen [m]
    double turning;       // how far out its turning counts [m]
    double shapes;        // count of its convex shapes
    double corners;       // of these, the cost of comparing it
    double horizon;       // share of the sub-step up to which it is followed
    Vec start, end;       // centres at the beginning of the motion and at the horizon [m]
    Vec half;             // half the size of its box at a moment, about the line between them [m]
    Box box;              // of the whole motion
} Mover;

static inline double yaw_at(const Mover *mover, double share) {
    return mover->pose.yaw + mover->rate.w * (share - mover->since);
}

// Where a body is at a share of the sub-step, and its centre of rotation.
static inline Pose pose_at(const Mover *mover, double share, Vec *pivot) {
    double lapse = share - mover->since;
    *pivot = add(mover->pivot, scaled(mover->rate.v, lapse));
    Vec arm = rotated(sub(mover->pose.p, mover->pivot), rotation(mover->rate.w * lapse));
    return (Pose){add(*pivot, arm), yaw_at(mover, share)};
}

#endif
