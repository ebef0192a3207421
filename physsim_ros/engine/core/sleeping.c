// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Sleeping by island, as Chipmunk has it: an island at rest costs next to nothing until something wakes it.
//
// Problem: a settled pile costs as much as a falling one.
// Method: Chipmunk's sleeping (contact graph and joints make islands; an island whose bodies all had little energy
// for a while is taken out of the solver; Box2D does the same). Bodies that are slow for another reason than rest
// stay awake: in free flight nothing would stop them (Newton's first law), at the turn of a swing they have only
// stopped for a moment, a floor that moves carries them on, and a field that changes will move them. A checkpoint
// wakes all, so that a restored space and the one that went on are in the same state.
// Cost: a look at each body in the stages of fields, floors, sensors and sweeps; the others see only bodies that are
// awake (`active_at`).
// Without it 1,000 bodies at rest cost as much as 1,000 that move.

#include "stages.h"

// A body on a spring, or afloat, that is no faster than this while its island falls asleep is at rest [m/s, rad/s]: one
// that sinks on a damper does so by 1 mm in 160 s, and one that swings in 40 s is within 1 mm of where it rests, or it
// would be faster before the idle time of half a second has passed.
static const double rest_speed = 6e-6;

// Count of sub-steps of idle time that one in which a body is too fast for rest takes back, not all. In a pile a
// contact that bears next to nothing is lost now and then, and its body falls for one sub-step, which would reset the
// timer.
static const double taken_back = 8.0;

static double most_of(Twist twist) {
    return greatest(fabs(twist.v.x), greatest(fabs(twist.v.y), fabs(twist.w)));
}

static bool moves_on(const Body *body) {
    Twist now = twist_of(body->engine);
    if (most_of(body->own->under) > 0.0 || body->own->stirred) {
        return true;
    }
    double slowest = body->own->on_spring || body->own->afloat ? rest_speed : INFINITY;
    return (body->state.free && most_of(now) > 0.0) || most_of(now) > slowest;
}

void ignore_jitter(World *world) {
    for (int number = 0; number < active_count(world); number++) {
        const Body *body = active_at(world, number);
        if (body->dynamic && body->own->idle > 0.0 && !sleeps(body) && body->engine->idle_time == 0.0) {
            body->engine->idle_time = greatest(body->own->idle - taken_back * world->dt, 0.0);
        }
    }
}

void keep_awake(World *world) {
    for (int number = 0; number < active_count(world); number++) {
        const Body *body = active_at(world, number);
        if (body->dynamic && body->engine->idle_time > 0.0 && !sleeps(body) && moves_on(body)) {
            // Chipmunk begins to count idle time anew, of what it touches too.
            world->chipmunk.body_activate(body->engine);
        }
    }
}
