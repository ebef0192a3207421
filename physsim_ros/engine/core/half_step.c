// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Half-step velocity: exact free flight (leapfrog; Störmer, Verlet).
//
// Problem: Chipmunk moves a body with the velocity of its last step and then accelerates it, so that a thrown ball
// falls ½ g t dt too far (law 1: 4 cm in 2 s at 240 Hz).
// Method: while a body is in free flight, its velocity in the engine leads the true one by half a sub-step of its
// acceleration; what is reported is the true one. A body is in free flight if its velocity changed in the last sub-step
// by its acceleration and by nothing else. True velocities do not jump when a body begins or ceases to fly. One whose
// velocity is set flies unless a contact that pressed on it in the last sub-step still holds it.
//
// A body on a spring is never in free flight. As it begins, its velocity gets half a sub-step of what its weight and
// its springs change that by; from then on it leads, as that of a body on a rod does.
//
// Reports.
// Law: the impulses of contacts and joints, with gravity, are what changes the momentum of a body, but for m times a
// lead: a body whose contact is lost flies without a jump of the engine's velocity, and lands without one.
// Problem: a body whose velocity was set begins with such a jump, and what carries it takes that back: a body that is
// put at rest on a floor would press with half a sub-step of weight too much.
// Method: of an impulse in the first sub-step of such a body that share is reported with which the true velocity goes
// into the velocity of the engine, along the impulse; at most the momenta of both leads are taken off.
//
// Cost: a comparison of velocities before and after each sub-step.

#include "contact.h"
#include "lost_support.h"
#include "springs.h"
#include "stages.h"

// Difference of a sum in another order, as a share of the velocity.
static const double rounding_of_velocity = 1e-12;

// Whether springs or motors hold the island of a body.
static bool is_held(const Body *body) {
    return body->own->sprung || body->own->motored;
}

// Whether a contact that pressed on a body in the last sub-step parts by less than the sub-step pulls its bodies
// together.
static bool keeps_contact(const Body *body) {
    for (const cpArbiter *each = body->engine->arbiterList; each != NULL; each = next_of(each, body->engine)) {
        Twist a = true_twist(each->body_a), b = true_twist(each->body_b);
        for (int number = 0; number < each->count && presses(each); number++) {
            double parting = dot(parting_velocity(each->contacts + number, a, b), each->n);
            if (parting <= length(body->own->lead.v)) {
                return true;
            }
        }
    }
    return false;
}

// Find the free flight that the next sub-step begins with, and the bodies whose support was removed (body_count).
static void find_start(World *world, uint8_t *free, uint8_t *unsupported) {
    if (world->own->all_active) {
        find_leads(world);
    }
    turn_leads(world);
    bool released = false;
    for (int number = 0; number < active_count(world); number++) {
        const Body *body = active_at(world, number);
        bool stays = body->state.thrown && !is_loose(body) && keeps_contact(body);
        free[place_of(world, body->engine)] = body->state.free && !stays && !is_held(body);
        released = released || is_loose(body);
    }
    if (!released || !has_stage(world, STAGE_SUPPORT)) {
        return;
    }
    find_unsupported(world, unsupported);
    for (int place = 0; place < world->body_count; place++) {
        free[place] = free[place] || unsupported[place];
    }
}

// The velocity of a body that begins or ceases to fly.
static Twist with_lead(const Body *body, bool flies) {
    double sign = (double)flies - (double)body->state.free;
    return twist_plus(twist_of(body->engine), body->own->lead, sign);
}

static void forget_impulses(const Body *body) {
    for (cpArbiter *each = body->engine->arbiterList; each != NULL; each = next_of(each, body->engine)) {
        for (int number = 0; number < each->count; number++) {
            each->contacts[number].jnAcc = each->contacts[number].jtAcc = 0.0;
        }
    }
}

// Whether a body that hangs on springs begins its first sub-step.
static bool begins_on_spring(const Body *body) {
    return body->state.free && body->dynamic && body->own->sprung && !body->own->motored;
}

// Find half of what the coming sub-step changes velocities by, of bodies that begin on springs (body_count; the rest is
// 0); NULL if none begins.
static const Twist *half_changes(World *world) {
    Twist *changes = NULL;
    bool *begins = NULL;
    for (int number = 0; number < active_count(world); number++) {
        const Body *body = active_at(world, number);
        if (begins_on_spring(body)) {
            changes = changes == NULL ? TAKE(&world->own->arena, Twist, world->body_count) : changes;
            begins = begins == NULL ? TAKE(&world->own->arena, bool, world->body_count) : begins;
            int place = place_of(world, body->engine);
            begins[place] = true;
            changes[place] = body->own->lead;
        }
    }
    if (changes != NULL) {
        pull_springs(world, begins, changes, world->dt / 2.0);
    }
    return changes;
}

void begin_flights(World *world) {
    Arena *arena = &world->own->arena;
    uint8_t *free = TAKE(arena, uint8_t, world->body_count), *unsupported = TAKE(arena, uint8_t, world->body_count);
    find_start(world, free, unsupported);
    const Twist *changes = half_changes(world);
    for (int number = 0; number < active_count(world); number++) {
        Body *body = active_at(world, number);
        int place = place_of(world, body->engine);
        if (free[place] != body->state.free) {
            world->chipmunk.body_activate(body->engine);
            Twist twist = with_lead(body, free[place]);
            set_twist(body->engine, changes == NULL ? twist : twist_plus(twist, changes[place], 1.0));
            body->state.free = free[place];
        }
        if (unsupported[place]) {
            forget_impulses(body);
        }
    }
}

static bool begins_to_fly(const Body *body) {
    return body->own->thrown && body->state.free && body->dynamic;
}

double reported_share(const Body *a, const Body *b, Vec impulse) {
    const Body *bodies[2] = {a, b};
    double load = 0.0, all = 0.0, taken_back = 0.0, size = length(impulse);
    for (int end = 0; end < 2; end++) {
        const Body *body = bodies[end], *other = bodies[1 - end];
        if (begins_to_fly(body) && size > 0.0) {
            Vec against = begins_to_fly(other) ? vec(0.0, 0.0) : other->own->twist.v;
            // Without the impulse, the true velocity and that of the engine would be these.
            Vec true_end = add(body->own->twist.v, body->own->lead.v), engine_end = add(true_end, body->own->lead.v);
            double lead = body->own->bounces ? 0.0 : fabs(dot(body->own->lead.v, impulse)) / size;
            load += fabs(dot(sub(lead > 0.0 ? true_end : engine_end, against), impulse));
            all += fabs(dot(sub(engine_end, against), impulse));
            taken_back += body->engine->m * lead;
        }
    }
    if (all == 0.0) {
        return 1.0;
    }
    // Bodies that part are slower in the engine than in truth, so that the share would exceed 1.
    return least(greatest(load / all, 1.0 - taken_back / size), 1.0);
}

void find_free(World *world) {
    for (int number = 0; number < active_count(world); number++) {
        Body *body = active_at(world, number);
        body->state.free = false;
        if (!body->dynamic || is_held(body) || body->braking > 0.0 || sleeps(body)) {
            continue;
        }
        Twist after = twist_of(body->engine), flown = body->own->lead;
        flown = twist_plus(twist_scaled(body->own->twist, world->own->kept), flown, 2.0);
        body->state.free = fabs(flown.v.x - after.v.x) <= rounding_of_velocity * (1.0 + fabs(after.v.x)) &&
                           fabs(flown.v.y - after.v.y) <= rounding_of_velocity * (1.0 + fabs(after.v.y)) &&
                           fabs(flown.w - after.w) <= rounding_of_velocity * (1.0 + fabs(after.w));
    }
}

void core_read_state(World *world, Motion *motions, uint8_t *free, uint8_t *unsupported) {
    reset_memory(world);
    uint8_t *flies = TAKE(&world->own->arena, uint8_t, world->body_count);
    uint8_t *falls = TAKE(&world->own->arena, uint8_t, world->body_count);
    find_start(world, flies, falls);
    for (int place = 0; place < world->body_count - 1; place++) {
        const Body *body = world->bodies + place;
        // What is still to begin on a spring begins in the next sub-step of a space that is built from this state, too.
        free[place] = flies[place] || begins_on_spring(body);
        // A sleeping body does not move, whatever velocity Chipmunk keeps for it.
        Twist twist = sleeps(body) ? (Twist){0} : with_lead(body, free[place]);
        motions[place] = (Motion){pose_of(body->engine), twist};
        unsupported[place] = falls[place];
    }
}

void core_observe(World *world, Pose *poses, Twist *twists) {
    reset_memory(world);
    uint8_t *flies = TAKE(&world->own->arena, uint8_t, world->body_count);
    find_start(world, flies, TAKE(&world->own->arena, uint8_t, world->body_count));
    for (int place = 0; place < world->body_count - 1; place++) {
        const Body *body = world->bodies + place;
        Pose pose = pose_of(body->engine);
        if (body->offset.x != 0.0 || body->offset.y != 0.0) {
            pose.p = sub(pose.p, rotated(body->offset, rotation(pose.yaw)));
        }
        poses[place] = pose;
        Twist twist = sleeps(body) ? (Twist){0} : with_lead(body, flies[place]);
        // The same sum as in a space that is built from this state, to the bit.
        twists[place] = flies[place] ? twist_plus(twist, body->own->lead, -1.0) : twist;
    }
}

void core_write_state(World *world, const Motion *motions) {
    for (int place = 0; place < world->body_count - 1; place++) {
        assert(!sleeps(world->bodies + place));
        set_pose(world->bodies[place].engine, motions[place].pose);
        set_twist(world->bodies[place].engine, motions[place].twist);
    }
}
