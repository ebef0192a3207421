// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// What Python and the core share: the tables that describe a scene, the state that steps change, and the calls.
//
// Python builds the tables when a request changes the scene, in arrays of NumPy whose fields are those declared here;
// the core never allocates or frees them. cffi reads this file as it is, but for lines that begin with '#'.

#ifndef PHYSSIM_CORE_H
#define PHYSSIM_CORE_H

#include "chipmunk.h"
#include <stdint.h>

// A body; the last one of the table is the background, which has the walls.
typedef struct Body {
    cpBody *engine;
    uint8_t dynamic;  // forces move it
    uint8_t anchored; // it does not move at all
    uint8_t jointed;  // a joint with rows ends on it; the core sets this
} Body;

// Kinds of constraint rows: which number x of the poses of two bodies a row bounds.
enum {
    ROW_X,        // x of the first anchor less that of the second [m]
    ROW_Y,        // the same of y
    ROW_ANGLE,    // ratio yaw_b - yaw_a [rad]
    ROW_DISTANCE, // distance of the two anchors [m]
    ROW_ACROSS,   // distance of the first anchor from the axis of the second body [m]
    ROW_ALONG     // way of the first anchor along that axis [m]
};

// A constraint row: lower <= x <= upper, both the same for an equality.
typedef struct Row {
    int32_t kind;
    int32_t part, component; // which impulse of which constraint is that of the row
    double lower, upper;     // [m, rad]
    double below, above;     // λ by that impulse, where x is below its bounds, and where it is not
    double most;             // greatest absolute value of λ in a step [N s, N m s]
} Row;

// Kinds of constraints of Chipmunk.
enum { PART_PIVOT, PART_PIN, PART_SLIDE, PART_GEAR, PART_ROTARY_LIMIT, PART_MOTOR, PART_SPRING };

// A constraint of a joint.
typedef struct Part {
    int32_t kind;
    cpConstraint *constraint;
} Part;

// A joint; its parts follow one another, and so do its rows.
typedef struct Joint {
    double anchor_a[2]; // in the frame of the first body, its origin the centre of mass [m]
    double anchor_b[2]; // the same in the frame of the second
    double axis[2];     // unit vector of a slider in the frame of the second body
    double ratio;       // of a gear
    double most;        // impulse in a step beyond which it breaks [N s, N m s]
    uint8_t has_axis;   // the direction from its first to its second point is an axis of the second body
    uint8_t presses;    // its first part may push the bodies apart
    uint8_t unstepped;  // its first step is to come
    uint8_t broken;     // in the last step
    int32_t a, b;       // places of its bodies in the table
    int32_t first_part, part_count;
    int32_t first_row, row_count; // none where Chipmunk alone solves it, as a spring
} Joint;

// Functions of Chipmunk, from Pymunk's own library.
typedef struct Chipmunk {
    void (*space_step)(cpSpace *, double);
    void (*body_activate)(cpBody *);
} Chipmunk;

// A world: what Python sets, and what the core keeps between steps.
typedef struct World {
    cpSpace *space;
    Chipmunk chipmunk;
    double dt; // length of a step [s]
    Body *bodies;
    int32_t body_count; // with the background
    Joint *joints;
    int32_t joint_count;
    Part *parts;
    int32_t part_count;
    Row *rows;
    int32_t row_count;
    struct Private *own;
} World;

// All that the library exports.
#pragma GCC visibility push(default)

// A hash of the sources that the library was compiled from (`sources.py`).
const char *core_sources(void);

World *core_new(cpSpace *space, double dt);
void core_free(World *world);
void core_use_bodies(World *world, Body *bodies, int32_t count);
void core_use_joints(World *world, Joint *joints, int32_t joint_count, Part *parts, int32_t part_count, Row *rows,
                     int32_t row_count);

void core_prepare_joints(World *world);
void core_solve_joints(World *world);

// Impulses from which the next step starts, (part_count) [N s, N m s]; the second is 0 but for pivots.
void core_read_impulses(const World *world, cpVect *impulses);
void core_write_impulses(World *world, const cpVect *impulses);

// Of each joint (joint_count): the greatest impulse of its parts in the last step [N s, N m s], its linear impulse on
// the second body [N s], and whether it pushed its bodies apart.
void core_read_joints(const World *world, double *impulses, cpVect *pulls, uint8_t *pressing);

#pragma GCC visibility pop

#endif
