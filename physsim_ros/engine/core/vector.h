// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Vectors of the plane, rotations and poses, as values.

#ifndef PHYSSIM_VECTOR_H
#define PHYSSIM_VECTOR_H

#include "core.h"
#include <math.h>
#include <stdbool.h>

typedef cpVect Vec;

static const double pi = 3.14159265358979323846;
static const double full_turn = 6.283185307179586; // [rad]

typedef struct Rotation {
    double c, s; // cosine and sine of the angle
} Rotation;

static inline Vec vec(double x, double y) {
    return (Vec){x, y};
}

static inline Vec add(Vec a, Vec b) {
    return (Vec){a.x + b.x, a.y + b.y};
}

static inline Vec sub(Vec a, Vec b) {
    return (Vec){a.x - b.x, a.y - b.y};
}

static inline Vec scaled(Vec a, double s) {
    return (Vec){a.x * s, a.y * s};
}

static inline Vec negated(Vec a) {
    return (Vec){-a.x, -a.y};
}

static inline double dot(Vec a, Vec b) {
    return a.x * b.x + a.y * b.y;
}

static inline double cross(Vec a, Vec b) {
    return a.x * b.y - a.y * b.x;
}

static inline double length(Vec a) {
    return sqrt(a.x * a.x + a.y * a.y);
}

// The vector turned counter-clockwise by a quarter.
static inline Vec perpendicular(Vec a) {
    return (Vec){-a.y, a.x};
}

static inline Rotation rotation(double yaw) {
    return (Rotation){cos(yaw), sin(yaw)};
}

static inline Vec rotated(Vec a, Rotation by) {
    return (Vec){by.c * a.x - by.s * a.y, by.s * a.x + by.c * a.y};
}

static inline Vec rotated_back(Vec a, Rotation by) {
    return (Vec){by.c * a.x + by.s * a.y, by.c * a.y - by.s * a.x};
}

// Velocity of a point of a body that is `arm` away from the centre of mass.
static inline Vec velocity_at(Twist twist, Vec arm) {
    return (Vec){twist.v.x - twist.w * arm.y, twist.v.y + twist.w * arm.x};
}

// a + share * b.
static inline Twist twist_plus(Twist a, Twist b, double share) {
    return (Twist){add(a.v, scaled(b.v, share)), a.w + b.w * share};
}

static inline Twist twist_scaled(Twist a, double share) {
    return (Twist){scaled(a.v, share), a.w * share};
}

static inline bool is_zero(Twist a) {
    return a.v.x == 0.0 && a.v.y == 0.0 && a.w == 0.0;
}

// The unit vector along another one, which may have no direction.
static inline Vec unit_or(Vec a, Vec otherwise) {
    double size = length(a);
    return size > 0.0 ? scaled(a, 1.0 / size) : otherwise;
}

static inline double least(double a, double b) {
    return a < b ? a : b;
}

static inline double greatest(double a, double b) {
    return a > b ? a : b;
}

static inline double clamped(double value, double lower, double upper) {
    return greatest(lower, least(value, upper));
}

#endif
