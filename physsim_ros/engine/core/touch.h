// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// A contact that begins in this sub-step, in the middle of it.

#ifndef PHYSSIM_TOUCH_H
#define PHYSSIM_TOUCH_H

#include "outline.h"
#include "world.h"

typedef struct Touch {
    cpArbiter *arbiter;
    const cpShape *shapes[2];
    cpBody *engines[2];
    int count;        // of points
    Vec normal;       // from the first body to the second
    Vec points[2][2]; // of both points (first index) on either body (second) [m]
    double met;       // when the shapes first met, as a share of the sub-step; 0 where that is not known
    int cornered;     // the shape, of which a corner met the other one then; a disc has but one
    bool on_face;     // whether that was at a face
} Touch;

// Normals of one face differ by the tilt of the bodies that lie on it [1].
static const double same_normal = 1e-3;

Touch touch_of(cpArbiter *arbiter);

// Write normal, points and their number to Chipmunk.
void write_touch(const Touch *touch);

// The distance of a point on the second body from that on the first along the normal, < 0 where they overlap [m].
static inline double distance_of(const Touch *touch, int point) {
    return dot(sub(touch->points[point][1], touch->points[point][0]), touch->normal);
}

// The velocity of a point on one of the bodies [m/s].
static inline Vec velocity_on(const Touch *touch, int side, Vec point) {
    const cpBody *engine = touch->engines[side];
    return velocity_at(twist_of(engine), sub(point, engine->p));
}

// How deep the other shape is behind a face of one [m].
double face_depth(const Touch *touch, int side, int face);

// Make effective masses and bounce of a contact anew, as `cpArbiterPreStep` has made them of the old one; the
// bounce is that of true velocities.
void prepare_contact(cpArbiter *arbiter);

#endif
