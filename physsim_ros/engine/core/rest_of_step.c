// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The rest of a sub-step after an impact is made with the velocity after it.
//
// Problem: Chipmunk finds an impact where the sub-step ends: the bodies have entered each other by then, have lost the
// rest of the sub-step, and leave with the velocity of its end. A ball between two walls covers a fraction of its
// distance, each bounce on a floor gains the energy of its overlap, and the position bias pushes apart what has sunk
// in.
// Method: the time since an impact is the overlap by the approach velocity (of a corner: since it first met the other
// shape). The impact gets the approach velocity of that moment, and gravity acts on the new velocity from then on:
// parting velocity = -e v(t) + a (end - t), a the acceleration of one body against the other. After the solver the
// displacement that each body has made since then is replaced by that of its new velocity, as far as nothing is in
// between (time of impact once more, `impact_islands.h`): Newton's law of restitution at the time of impact, to first
// order in the sub-step. Impulses act on both bodies alike, so that momentum is kept with all forces on. Where joints
// hand an impact on, the displacements of an island are found together (`joint_velocities.c`), and the forces of its
// motors are added (`joint_bounces.c`). A body whose velocity was set while it touches another is in an impact as the
// sub-step begins.
// Scope: a body has one time since its impacts, the longest. Of two impacts in one sub-step the later one is taken for
// as early as the first: a body that is thrown at once against the floor that it lies on and at a wall that it reaches
// within the sub-step stops short of that by up to v dt.
//
// Cost: 20 ns an impact; where bodies are fast, 2 µs for each pair that could meet.
// Without it laws 7 (penetration), 45 (momentum in flight) and 46 (pressure of a gas) fail.

#include "contact.h"
#include "impact_islands.h"
#include "stages.h"
#include "touch.h"

static Vec acceleration(const World *world, const Body *body) {
    return scaled(body->own->lead.v, 2.0 / world->dt);
}

// The velocity at which two bodies part in a point, as the sub-step begins, and the acceleration of that.
static double true_parting(const World *world, const cpArbiter *arbiter, const cpContact *point, double *rate) {
    const cpBody *a = arbiter->body_a, *b = arbiter->body_b;
    *rate = dot(sub(acceleration(world, body_of(b)), acceleration(world, body_of(a))), arbiter->n);
    return dot(parting_velocity(point, true_twist(a), true_twist(b)), arbiter->n);
}

// Have an impact take place when it did; return whether the bodies bounce. The velocity of a body in free flight leads
// by half a sub-step (`half_step.c`).
static bool set_bounce(const World *world, const cpArbiter *arbiter, double remaining) {
    bool bounces = false;
    for (int number = 0; number < arbiter->count; number++) {
        cpContact *point = arbiter->contacts + number;
        double rate = 0.0, parting = true_parting(world, arbiter, point, &rate);
        double then = parting + rate * (world->dt - remaining);
        point->bounce = -greatest(-arbiter->e * then + rate * (remaining + world->dt / 2.0), 0.0);
        bounces = bounces || point->bounce < 0.0;
    }
    return bounces;
}

static double deepest_of(const Touch *touch) {
    return greatest(-distance_of(touch, 0), -distance_of(touch, 1));
}

// The time since an impact, as long as the bodies moved freely [s]; `remaining` is the rest of the sub-step.
static double since_impact(const Touch *touch, double approach, double remaining, double dt) {
    // The arms of a corner are those of its impact, so that its overlap leaves out that it has turned since.
    bool is_corner = touch->met > 0.0 && kind_of(touch->shapes[0]) == SHAPE_POLYGON;
    return is_corner ? (1.0 - touch->met) * dt - remaining : deepest_of(touch) / approach;
}

// The velocity at which bodies approach in a contact, as the sub-step begins.
static double true_approach(const World *world, const cpArbiter *arbiter) {
    double approach = -INFINITY, rate = 0.0;
    for (int number = 0; number < arbiter->count; number++) {
        approach = greatest(approach, -true_parting(world, arbiter, arbiter->contacts + number, &rate));
    }
    return approach;
}

// Time the impacts of bodies whose velocities were set while they touch others. Chipmunk has moved them by one sub-step
// since then, so that the overlap that is taken back is that of one sub-step at most.
static void time_throws(World *world) {
    for (int number = 0; number < active_count(world); number++) {
        const Body *body = active_at(world, number);
        cpArbiter *each = body->own->thrown && body->dynamic ? body->engine->arbiterList : NULL;
        for (; each != NULL; each = next_of(each, body->engine)) {
            double approach = true_approach(world, each);
            if (begins(each) || approach <= slowest_impact) {
                continue;
            }
            Touch touch = touch_of(each);
            Body *a = body_of(each->body_a), *b = body_of(each->body_b);
            double most = world->dt - greatest(a->own->remaining, b->own->remaining);
            double since = clamped(deepest_of(&touch) / approach, 0.0, most);
            a->own->since = greatest(a->own->since, since);
            b->own->since = greatest(b->own->since, since);
        }
    }
}

void time_impacts(World *world) {
    for (int number = 0; number < world->own->now.begun_count; number++) {
        const Touch *touch = world->own->now.begun + number;
        double approach = approach_of(touch->arbiter);
        if (approach <= slowest_impact) {
            continue;
        }
        Body *a = body_of(touch->engines[0]), *b = body_of(touch->engines[1]);
        double remaining = greatest(a->own->remaining, b->own->remaining);
        double since = clamped(since_impact(touch, approach, remaining, world->dt), 0.0, world->dt);
        bool bounces = set_bounce(world, touch->arbiter, least(since + remaining, world->dt));
        a->own->bounces |= bounces;
        b->own->bounces |= bounces;
        a->own->since = greatest(a->own->since, since);
        b->own->since = greatest(b->own->since, since);
    }
    time_throws(world);
}

double remaining_time(const Body *a, const Body *b) {
    double of_a = a->dynamic ? a->own->since + a->own->remaining : INFINITY;
    double of_b = b->dynamic ? b->own->since + b->own->remaining : INFINITY;
    return a->dynamic || b->dynamic ? least(of_a, of_b) : 0.0;
}

Twist displacement_gained(const Body *body, Twist after, double remaining, double dt) {
    double ahead = body->own->bounces ? remaining / dt + 1.0 : 0.0;
    Twist mean = twist_plus(after, body->own->lead, -ahead);
    return twist_plus((Twist){0}, twist_plus(mean, body->own->twist, -1.0), remaining);
}

void set_remaining_move(Body *body, Twist gained) {
    // Continuous collision has had it move with what it met.
    Twist kept = twist_plus(body->own->carried, body->own->twist, -body->own->remaining);
    body->own->remaining_move = twist_plus(gained, kept, -1.0);
    body->own->has_remaining_move = true;
}

// Find the displacements of bodies that no island of joints has found.
static void find_remaining_moves(World *world) {
    for (int number = 0; number < active_count(world); number++) {
        Body *body = active_at(world, number);
        double remaining = body->own->since + body->own->remaining;
        if (remaining > 0.0 && body->dynamic && !body->own->has_remaining_move) {
            set_remaining_move(body, displacement_gained(body, twist_of(body->engine), remaining, world->dt));
        }
    }
}

static Twist remaining_displacement(const World *world, const Body *body) {
    (void)world;
    return body->own->remaining_move;
}

// Have the remaining displacements of bodies end where they meet others.
static void stop_remaining_moves(World *world) {
    Sweep sweep = sweep_of(world, remaining_displacement);
    int *far = TAKE(&world->own->arena, int, sweep.count), count = 0;
    for (int number = 0; number < sweep.count; number++) {
        Mover *mover = sweep.movers + number;
        mover->movable = !is_zero(mover->rate);
        if (is_far(world, mover->body, mover->body->own->remaining_move)) {
            far[count++] = number;
        }
    }
    join_impacts(&sweep, far, count);
    for (int number = 0; number < sweep.count; number++) {
        const Mover *mover = sweep.movers + number;
        if (mover->met) {
            Twist *move = &mover->body->own->remaining_move;
            Pose begin = pose_of(mover->body->engine);
            Vec pivot;
            Pose end = pose_at(mover, 1.0, &pivot);
            *move = (Twist){sub(end.p, begin.p), mover->turning > 0.0 ? end.yaw - begin.yaw : move->w};
        }
    }
}

void finish_moves(World *world) {
    bool any_far = false;
    find_remaining_moves(world);
    for (int number = 0; number < active_count(world); number++) {
        const Body *body = active_at(world, number);
        any_far = any_far || is_far(world, body, body->own->remaining_move);
    }
    if (any_far) {
        stop_remaining_moves(world);
    }
    for (int number = 0; number < active_count(world); number++) {
        const Body *body = active_at(world, number);
        if (!is_zero(body->own->remaining_move)) {
            set_pose(body->engine, moved(pose_of(body->engine), body->own->remaining_move, 1.0));
        }
    }
}
