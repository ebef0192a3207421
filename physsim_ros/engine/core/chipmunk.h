// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Structs of Chipmunk, up to the last field that the core reads or writes; the others are padding.
//
// They are those of Munk2D as in Pymunk 7.3.1, whose headers no wheel has. When the core is imported,
// `engine/layout.py` compares them with what Pymunk itself returns, and refuses a Pymunk with others. cffi reads this
// file too, but for lines that begin with '#'.

#ifndef PHYSSIM_CHIPMUNK_H
#define PHYSSIM_CHIPMUNK_H

#include <stdint.h>

typedef struct cpVect {
    double x, y;
} cpVect;

typedef struct cpTransform {
    double a, b, c, d, tx, ty;
} cpTransform;

typedef struct cpArray {
    int num, max;
    void **arr;
} cpArray;

typedef struct cpBody {
    void *functions_[2];
    double m, m_inv; // mass [kg] and its inverse, 0 for what forces do not move
    double i, i_inv; // moment of inertia [kg m²] and its inverse
    cpVect cog;
    cpVect p, v, f; // position [m], velocity [m/s], force [N]
    double a, w, t; // angle [rad], spin [rad/s], torque [N m]
    cpTransform transform;
    void *userData;
    cpVect v_bias; // velocity [m/s] and spin [rad/s] that push overlaps apart in the next step
    double w_bias;
    void *space;
    struct cpShape *shapeList;
    struct cpArbiter *arbiterList;
    struct cpConstraint *constraintList;
    struct cpBody *sleeping_root; // NULL while awake
    struct cpBody *sleeping_next;
    double idle_time; // [s]
} cpBody;

typedef struct cpShape {
    void *klass; // begins with the kind, an int
    void *space;
    cpBody *body;
    double mass_info_[5];
    double bb[4]; // left, bottom, right, top [m]
    uint8_t sensor;
    double e, u; // square roots of restitution and friction
    cpVect surface_velocity;
    void *userData;
    uintptr_t type;
    uintptr_t group;
    unsigned int categories, mask;
    struct cpShape *next, *prev;
    uintptr_t hashid; // number of the shape in its space
} cpShape;

enum { SHAPE_CIRCLE, SHAPE_SEGMENT, SHAPE_POLYGON };

typedef struct cpCircleShape {
    cpShape shape;
    cpVect c, tc; // centre in the body's frame and in the world [m]
    double r;
} cpCircleShape;

typedef struct cpSegmentShape {
    cpShape shape;
    cpVect a, b, n;    // ends [m] and normal in the body's frame
    cpVect ta, tb, tn; // the same in the world
    double r;
} cpSegmentShape;

typedef struct cpSplittingPlane {
    cpVect v0, n; // corner [m], and normal of the edge that ends there
} cpSplittingPlane;

typedef struct cpPolyShape {
    cpShape shape;
    double r;
    int count;
    cpSplittingPlane *planes; // those in the world, then those in the body's frame
} cpPolyShape;

typedef struct cpPointQueryInfo {
    const cpShape *shape;
    cpVect point;    // nearest point of its outline [m]
    double distance; // to it, negative within the shape [m]
    cpVect gradient; // direction in which the distance grows
} cpPointQueryInfo;

typedef struct cpContact {
    cpVect r1, r2;       // from either body to the point [m]
    double nMass, tMass; // effective masses along and across the normal [kg]
    double bounce;       // restitution times velocity along the normal before the impact [m/s]
    double jnAcc, jtAcc; // impulses along and across the normal [N s]
    double jBias;        // impulse that pushes the overlap out [N s]
    double bias;         // velocity at which it is pushed out [m/s]
    uintptr_t hash;      // of the features that touch
} cpContact;

typedef struct cpArbiterThread {
    struct cpArbiter *next, *prev;
} cpArbiterThread;

enum { ARBITER_FIRST_COLLISION }; // the other states do not count

typedef struct cpArbiter {
    double e, u; // restitution and friction of the pair
    cpVect surface_vr;
    void *data;
    cpShape *a, *b;
    cpBody *body_a, *body_b;
    cpArbiterThread thread_a, thread_b; // in the lists of the two bodies
    int count;
    cpContact *contacts;
    cpVect n; // normal, from the first to the second body
    void *handlers_[4];
    uint8_t swapped;
    unsigned int stamp;
    int state;
} cpArbiter;

typedef struct cpHashSet {
    unsigned int entries, size; // count of elements, and of lists of them
} cpHashSet;

typedef struct cpSpace {
    int iterations;
    cpVect gravity;
    double damping; // share of velocities that is kept in a second
    double idleSpeedThreshold, sleepTimeThreshold;
    double collisionSlop, collisionBias;
    unsigned int collisionPersistence;
    void *userData;
    unsigned int stamp;
    double curr_dt;
    cpArray *dynamicBodies, *staticBodies, *rousedBodies, *sleepingComponents;
    uintptr_t shapeIDCounter;
    void *staticShapes, *dynamicShapes;
    cpArray *constraints;
    cpArray *arbiters; // of the last step, those of sleeping bodies and of sensors excepted
    void *contactBuffersHead;
    cpHashSet *cachedArbiters; // of the last steps, those of sleeping bodies excepted
} cpSpace;

// What Chipmunk calls of a kind of constraints, with the length of the step or the share of a cached impulse.
typedef struct cpConstraintClass {
    void (*preStep)(struct cpConstraint *, double);
    void (*applyCachedImpulse)(struct cpConstraint *, double);
    void (*applyImpulse)(struct cpConstraint *, double);
    double (*getImpulse)(struct cpConstraint *);
} cpConstraintClass;

typedef struct cpConstraint {
    cpConstraintClass *klass;
    void *space;
    cpBody *a, *b;
    struct cpConstraint *next_a, *next_b;
    double maxForce, errorBias, maxBias;
    uint8_t collideBodies;
    void (*preSolve)(struct cpConstraint *, cpSpace *);
    void (*postSolve)(struct cpConstraint *, cpSpace *);
    void *userData;
} cpConstraint;

typedef struct cpPivotJoint {
    cpConstraint constraint;
    cpVect anchorA, anchorB, r1, r2;
    double k[4];
    cpVect jAcc;
} cpPivotJoint;

typedef struct cpPinJoint {
    cpConstraint constraint;
    cpVect anchorA, anchorB;
    double dist;
    cpVect r1, r2, n;
    double nMass, jnAcc;
} cpPinJoint;

typedef struct cpSlideJoint {
    cpConstraint constraint;
    cpVect anchorA, anchorB;
    double min, max;
    cpVect r1, r2, n;
    double nMass, jnAcc;
} cpSlideJoint;

typedef struct cpGearJoint {
    cpConstraint constraint;
    double phase, ratio, ratio_inv, iSum, bias, jAcc;
} cpGearJoint;

typedef struct cpRotaryLimitJoint {
    cpConstraint constraint;
    double min, max, iSum, bias, jAcc;
} cpRotaryLimitJoint;

typedef struct cpSimpleMotor {
    cpConstraint constraint;
    double rate, iSum, jAcc;
} cpSimpleMotor;

typedef struct cpDampedSpring {
    cpConstraint constraint;
    cpVect anchorA, anchorB;
    double restLength, stiffness, damping;
    double (*springForceFunc)(cpConstraint *, double);
    double target_vrn, v_coef;
    cpVect r1, r2;
    double nMass;
    cpVect n;
    double jAcc;
} cpDampedSpring;

#endif
