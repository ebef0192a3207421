// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The outline of a convex shape of Chipmunk: one to n corners, with a face before each, rounded by a radius.
//
// A disc has one corner, its centre, and no face; a segment two of each. In the world outlines are where Chipmunk has
// last compared the shapes; in the frame of a body they do not move.

#ifndef PHYSSIM_OUTLINE_H
#define PHYSSIM_OUTLINE_H

#include "vector.h"
#include <stdbool.h>

typedef struct Corner {
    Vec point;  // [m]
    Vec normal; // outwards of the face that ends there, of length 1; (0, 0) of a disc
} Corner;

static inline int kind_of(const cpShape *shape) {
    return *(const int *)shape->klass;
}

static inline int corner_count(const cpShape *shape) {
    switch (kind_of(shape)) {
    case SHAPE_CIRCLE:
        return 1;
    case SHAPE_SEGMENT:
        return 2;
    default:
        return ((const cpPolyShape *)shape)->count;
    }
}

// The radius of a disc, or of the rounding [m].
static inline double radius_of(const cpShape *shape) {
    switch (kind_of(shape)) {
    case SHAPE_CIRCLE:
        return ((const cpCircleShape *)shape)->r;
    case SHAPE_SEGMENT:
        return ((const cpSegmentShape *)shape)->r;
    default:
        return ((const cpPolyShape *)shape)->r;
    }
}

// A corner where Chipmunk has last compared the shape, in the world.
Corner corner_in_world(const cpShape *shape, int number);

// A corner in the frame of its body.
Corner corner_on_body(const cpShape *shape, int number);

// Whether a point of the frame of the body lies in a shape, edge included.
bool covers(const cpShape *shape, Vec point);

// Whether a point of the world lies in a shape of a body at a pose, edge included.
bool body_covers(const cpBody *body, Pose pose, Vec point);

#endif
