// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// One-way bodies: others pass them in one direction, and are stopped where they come against it.
//
// Problem: a jump leads up through a platform, a chute lets things out and none in.
// Method: a contact acts where its normal leads in the direction in which others pass, or across it where the sides
// are closed, and where the other body was outside as the sub-step began, within the slop of contacts; else Chipmunk
// ignores it (Godot: one-way collision with a margin; Box2D and Chipmunk leave it to a callback). What passes one shape
// of a body passes all of them. A pair of shapes that carried a load in the sub-step before stays in contact, however
// deep that has pressed it, and at whichever corner. So nothing outlives a sub-step but the impulses of contacts, which
// checkpoints have. Continuous collision stops a fast body by the same rule, at the normal of its impact
// (`time_of_impact.c`).
// Limit: a corner that goes further in a sub-step than a segment is thick has entered it by the side of the least
// depth.
// Cost: 1 ns a contact where there are one-way bodies, 20 ns one of such a body.

#include "one_way.h"
#include "contact.h"
#include "stages.h"

// The cosine of the angle from the direction that others pass in, up to which a contact is on top of a body: 78°.
static const double least_rise = 0.2;

static bool has_load(const cpArbiter *arbiter) {
    bool loaded = false;
    for (int number = 0; number < arbiter->count; number++) {
        loaded = loaded || arbiter->contacts[number].jnAcc > 0.0;
    }
    return loaded;
}

void find_loaded(World *world) {
    int count = world->own->has_one_way ? arbiter_count(world) : 0;
    world->own->now.loaded = TAKE(&world->own->arena, Pair, count);
    world->own->now.loaded_count = 0;
    for (int number = 0; number < count; number++) {
        const cpArbiter *arbiter = arbiter_at(world, number);
        if (is_of_one_way(arbiter) && has_load(arbiter)) {
            world->own->now.loaded[world->own->now.loaded_count++] = pair_of(arbiter->a->hashid, arbiter->b->hashid);
        }
    }
    sort_pairs(world->own->now.loaded, world->own->now.loaded_count);
}

bool was_loaded(const World *world, const cpShape *a, const cpShape *b) {
    return has_pair(world->own->now.loaded, world->own->now.loaded_count, pair_of(a->hashid, b->hashid));
}

// How far a normal leads in the direction in which others pass a body; 1 is along it.
static double rise_of(const Body *body, double yaw, Vec normal) {
    return dot(normal, rotated(body->one_way, rotation(yaw)));
}

bool is_closed(const Body *body, double yaw, Vec normal) {
    double rise = rise_of(body, yaw, normal);
    return !is_one_way(body) || rise > least_rise || (body->closed_sides && rise >= -least_rise);
}

// Whether the bodies of a contact approach, and were outside of each other as the sub-step began, within the slop.
static bool comes_from_outside(const World *world, const cpArbiter *arbiter) {
    double nearest = INFINITY, fastest = 0.0;
    for (int number = 0; number < arbiter->count; number++) {
        const cpContact *point = arbiter->contacts + number;
        Vec parting = parting_velocity(point, twist_of(arbiter->body_a), twist_of(arbiter->body_b));
        double approach = greatest(-dot(parting, arbiter->n), 0.0);
        nearest = least(nearest, gap_at(arbiter, point) + approach * world->dt);
        fastest = greatest(fastest, approach);
    }
    return fastest > 0.0 && nearest >= -slop_of(arbiter);
}

// Whether a contact has carried a load; bodies that wake in this sub-step have no pair in the list, but their impulses.
static bool carries_load(const World *world, const cpArbiter *arbiter) {
    return has_load(arbiter) || was_loaded(world, arbiter->a, arbiter->b);
}

// Whether both bodies of a contact are closed there.
static bool are_closed_at(const cpArbiter *arbiter) {
    const cpBody *a = arbiter->body_a, *b = arbiter->body_b;
    return is_closed(body_of(a), a->a, arbiter->n) && is_closed(body_of(b), b->a, negated(arbiter->n));
}

// Whether a contact is where the bodies pass: at the side that others enter by, or within a one-way body.
static bool is_where_bodies_pass(const World *world, const cpArbiter *arbiter) {
    const cpBody *a = arbiter->body_a, *b = arbiter->body_b;
    double rise = least(rise_of(body_of(a), a->a, arbiter->n), rise_of(body_of(b), b->a, negated(arbiter->n)));
    return rise < -least_rise || (are_closed_at(arbiter) && !comes_from_outside(world, arbiter));
}

// List the pairs of bodies that pass each other, by places; return their number.
static int list_passing(const World *world, Pair *passing) {
    int count = 0;
    for (int number = 0; number < arbiter_count(world); number++) {
        const cpArbiter *arbiter = arbiter_at(world, number);
        if (is_of_one_way(arbiter) && !carries_load(world, arbiter) && is_where_bodies_pass(world, arbiter)) {
            passing[count++] = bodies_of(world, arbiter);
        }
    }
    sort_pairs(passing, count);
    return count;
}

void ignore_passing(World *world) {
    if (!world->own->has_one_way) {
        return;
    }
    Pair *passing = TAKE(&world->own->arena, Pair, arbiter_count(world));
    int count = list_passing(world, passing);
    for (int number = 0; number < arbiter_count(world); number++) {
        cpArbiter *arbiter = arbiter_at(world, number);
        bool passes = !carries_load(world, arbiter) && has_pair(passing, count, bodies_of(world, arbiter));
        if (is_of_one_way(arbiter) && (passes || !are_closed_at(arbiter))) {
            ignore(arbiter);
        }
    }
}
