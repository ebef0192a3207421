// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Attraction: of masses, and of charges of two signs, by a power of their distance.
//
// Problem: planets, stars, ions.
// Method: the force on a body is the sum over all others of (k q q' - G m m') r / (r² + ε²)^((p + 1) / 2), along r from
//   the other one: Newton and Coulomb for p = 2, line charges of the plane for p = 1. The softening ε (H. C. Plummer,
//   1911) bounds it where two bodies pass each other. Forces are those of the poses after the move, in each sub-step:
//   with the leads of `fields.c` the steps are symplectic, and an orbit stays closed.
// Scope: forces act at centres of mass; the plane's extent of a body does not count.
// Cost: 8 ns for each pair and sub-step, so that Python allows some hundreds of bodies.
// Without it law 72 fails: planets fly straight on.

#include "attraction.h"

// (r² + ε²)^(-(p + 1) / 2), by square roots for the powers of nature.
static double falloff(double square, double power) {
    if (power == 2.0) {
        return 1.0 / (square * sqrt(square));
    }
    if (power == 1.0) {
        return 1.0 / square;
    }
    return pow(square, -(power + 1.0) / 2.0);
}

Vec *attractions(World *world, double ahead) {
    Arena *arena = &world->own->arena;
    Vec *points = TAKE(arena, Vec, world->attractor_count), *forces = TAKE(arena, Vec, world->attractor_count);
    for (int number = 0; number < world->attractor_count; number++) {
        const Attractor *attractor = world->attractors + number;
        const Body *body = world->bodies + attractor->body;
        Twist twist = ahead > 0.0 ? twist_of(body->engine) : true_twist(body->engine);
        Pose pose = moved(pose_of(body->engine), twist, ahead);
        points[number] = add(pose.p, rotated(attractor->center, rotation(pose.yaw)));
    }
    double softening = world->softening * world->softening;
    for (int one = 0; one < world->attractor_count; one++) {
        const Attractor *a = world->attractors + one;
        for (int other = one + 1; other < world->attractor_count; other++) {
            const Attractor *b = world->attractors + other;
            Vec offset = sub(points[one], points[other]);
            double square = dot(offset, offset) + softening;
            // Two bodies at one point do not attract each other.
            if (square > 0.0) {
                double strength = world->coulomb * a->charge * b->charge - world->gravitation * a->mass * b->mass;
                Vec force = scaled(offset, strength * falloff(square, world->attraction_power));
                forces[one] = add(forces[one], force);
                forces[other] = sub(forces[other], force);
            }
        }
    }
    return forces;
}
