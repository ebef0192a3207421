// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Continuous collision: the coming sub-step of fast bodies ends where they first hit something.
//
// Problem: Chipmunk tests for overlap only where a sub-step ends. A disc of 0.1 m at 40 m/s jumps over a wall.
// Method: pairs that approach by more than a safe depth in a sub-step are found by a broad phase of swept boxes
// (`swept_boxes`), and advanced to their time of impact (`time_of_impact`). For the rest of the sub-step the two move
// as one rigid body with their common momentum and angular momentum (a perfectly plastic impact, of the positions
// only): a light body is carried along by a heavy one and by a kinematic one, and stops at an anchored one
// (`impact_islands`). Chipmunk then finds the contact where the sub-step ends, and resolves it from the velocities,
// which stay as they are.
// Laws: bodies that meet keep the displacement of their common centre of mass, unless one is anchored or kinematic; a
// pair that overlaps is stopped only where it would come deeper; islands that do not meet do not depend on each other.
// Cost: 2 µs for a single fast body near nothing; some 2 µs for each pair that could meet.
// Without it laws 25 (thin wall) and 35 (a fast bar hits all discs) fail.

#include "impact_islands.h"
#include "stages.h"

// Up to this many fast bodies, boxes are compared first: it saves time, and changes no result.
enum { FEW = 8 };

// The displacement of a body in the coming sub-step.
static Twist displacement_of(const World *world, const Body *body) {
    return twist_plus((Twist){0}, twist_of(body->engine), world->dt);
}

static bool is_fast(const World *world, const Body *body) {
    return is_far(world, body, displacement_of(world, body));
}

// Whether the swept box of a fast body overlaps that of another, or a static shape.
static bool boxes_meet(World *world, const Statics *statics) {
    Mover fast[FEW];
    int count = 0;
    for (int number = 0; number < active_count(world); number++) {
        Body *body = active_at(world, number);
        if (is_fast(world, body)) {
            assert(count < FEW);
            fast[count++] = mover_of(body, pose_of(body->engine), displacement_of(world, body));
        }
    }
    bool meet = false;
    for (int number = 0; number < count && !meet; number++) {
        meet = tree_meets(&statics->tree, fast[number].box);
    }
    for (int place = 0; place < world->body_count && !meet; place++) {
        Body *body = world->bodies + place;
        if (is_solid(body)) {
            Box box = box_ahead(body, world->dt);
            for (int number = 0; number < count; number++) {
                meet = meet || (fast[number].body != body && overlap(fast[number].box, box));
            }
        }
    }
    return meet;
}

// Set a body back, so that Chipmunk moves it to its first impact and no further.
static void set_back(World *world, const Mover *mover) {
    cpBody *engine = mover->body->engine;
    Vec pivot;
    Pose end = pose_at(mover, 1.0, &pivot), free_end = pose_after(engine, world->dt);
    mover->body->own->remaining = mover->body->dynamic ? (1.0 - mover->since) * world->dt : 0.0;
    mover->body->own->carried = (Twist){sub(end.p, mover->pose.p), end.yaw - mover->pose.yaw};
    Vec shift = sub(end.p, free_end.p);
    double turn = mover->turning > 0.0 ? end.yaw - free_end.yaw : 0.0;
    if (sleeps(mover->body)) {
        world->chipmunk.body_activate(engine);
    }
    set_pose(engine, (Pose){add(engine->p, shift), engine->a + turn});
}

void clamp_moves(World *world) {
    int fast = 0;
    for (int number = 0; number < active_count(world); number++) {
        fast += is_fast(world, active_at(world, number));
    }
    if (fast == 0) {
        return;
    }
    Arena *arena = &world->own->arena;
    size_t mark = arena_mark(arena);
    const Statics *statics = statics_of(world);
    if (fast > FEW || boxes_meet(world, statics)) {
        Sweep sweep = sweep_of(world, displacement_of);
        int *changed = TAKE(arena, int, sweep.count), count = 0;
        for (int number = 0; number < sweep.count; number++) {
            if (is_fast(world, sweep.movers[number].body)) {
                changed[count++] = number;
            }
        }
        join_impacts(&sweep, changed, count);
        for (int number = 0; number < sweep.count; number++) {
            if (sweep.movers[number].met) {
                set_back(world, sweep.movers + number);
            }
        }
    }
    arena_release(arena, mark);
}
