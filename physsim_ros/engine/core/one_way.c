// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// One-way bodies: others pass them in one direction, and are borne where they come against it.
//
// Problem: a jump leads up through a platform, a chute lets things out and none in.
// Method: a contact bears where its normal leads in the direction in which others pass, or across it where the sides
// are closed, and where the other body was outside as the sub-step began, within the slop of contacts; else Chipmunk
// ignores it (Godot: one-way collision with a margin; Box2D and Chipmunk leave it to a callback). A pair of shapes that
// has borne a load in the sub-step before bears on, however deep that has pressed it, and at whichever corner. So nothing
// outlives a sub-step but the impulses of contacts, which checkpoints have.
// Continuous collision stops a fast body by the same rule, at the normal of its impact (`time_of_impact.c`).
// Cost: 1 ns a contact, 20 ns one of a one-way body.

#include "one_way.h"
#include "stages.h"
#include <stdlib.h>

// The cosine of the angle from the direction that others pass in, up to which a contact is on top of a body: 78°.
static const double least_rise = 0.2;

bool is_one_way(const Body *body) {
    return body->one_way.x != 0.0 || body->one_way.y != 0.0;
}

bool is_of_one_way(const cpArbiter *arbiter) {
    return is_one_way(body_of(arbiter->body_a)) || is_one_way(body_of(arbiter->body_b));
}

// The numbers of two shapes, the lesser first.
typedef struct Pair {
    uintptr_t low, high;
} Pair;

static Pair pair_of(const cpShape *a, const cpShape *b) {
    return a->hashid < b->hashid ? (Pair){a->hashid, b->hashid} : (Pair){b->hashid, a->hashid};
}

static int by_numbers(const void *one, const void *other) {
    const Pair *a = one, *b = other;
    if (a->low != b->low) {
        return a->low < b->low ? -1 : 1;
    }
    return (a->high > b->high) - (a->high < b->high);
}

static bool has_load(const cpArbiter *arbiter) {
    bool loaded = false;
    for (int number = 0; number < arbiter->count; number++) {
        loaded = loaded || arbiter->contacts[number].jnAcc > 0.0;
    }
    return loaded;
}

void find_borne(World *world) {
    world->own->borne = TAKE(&world->own->arena, Pair, arbiter_count(world));
    world->own->borne_count = 0;
    for (int number = 0; number < arbiter_count(world); number++) {
        const cpArbiter *arbiter = arbiter_at(world, number);
        if (is_of_one_way(arbiter) && has_load(arbiter)) {
            world->own->borne[world->own->borne_count++] = pair_of(arbiter->a, arbiter->b);
        }
    }
    sort(world->own->borne, world->own->borne_count, sizeof(Pair), by_numbers);
}

bool is_borne(const World *world, const cpShape *a, const cpShape *b) {
    Pair pair = pair_of(a, b);
    size_t count = (size_t)world->own->borne_count;
    return count > 0 && bsearch(&pair, world->own->borne, count, sizeof(Pair), by_numbers) != NULL;
}

// Whether the other body comes from outside, where it was as the sub-step began, or is borne already.
static bool holds_out(const World *world, const cpArbiter *arbiter) {
    double nearest = INFINITY, fastest = 0.0;
    for (int number = 0; number < arbiter->count; number++) {
        const cpContact *point = arbiter->contacts + number;
        const cpBody *a = arbiter->body_a, *b = arbiter->body_b;
        Vec apart = sub(add(b->p, point->r2), add(a->p, point->r1));
        Vec velocity = sub(velocity_at(twist_of(b), point->r2), velocity_at(twist_of(a), point->r1));
        double approach = greatest(-dot(velocity, arbiter->n), 0.0);
        nearest = least(nearest, dot(apart, arbiter->n) + approach * world->dt);
        fastest = greatest(fastest, approach);
    }
    // Bodies that wake in this sub-step have no pair in the list, but their impulses.
    return (fastest > 0.0 && nearest >= -slop_of(arbiter)) || has_load(arbiter) ||
           is_borne(world, arbiter->a, arbiter->b);
}

bool is_closed(const Body *body, double yaw, Vec normal) {
    double rise = dot(normal, rotated(body->one_way, rotation(yaw)));
    return !is_one_way(body) || rise > least_rise || (body->closed_sides && rise >= -least_rise);
}

bool passes(const World *world, const cpArbiter *arbiter) {
    if (!is_of_one_way(arbiter)) {
        return false;
    }
    const Body *a = body_of(arbiter->body_a), *b = body_of(arbiter->body_b);
    bool closed = is_closed(a, a->engine->a, arbiter->n) && is_closed(b, b->engine->a, negated(arbiter->n));
    return !closed || !holds_out(world, arbiter);
}
