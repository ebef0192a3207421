// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Damping of resting contacts: the solver's own errors taken out of what friction locks in place.
//
// Problem: sequential impulses stop after a few iterations and warm start the next step. For the slow bending of a
// stack that is a spring without a damper: a stack of ten boxes sways for half a minute after it is put down (law
// 18), and never becomes slow enough to sleep.
// Method: our own. A body that lies with a face on something that does not move, its friction inside the cone, does
// not move either (Coulomb). Where such contacts lead from a body down to what is fixed, the velocity that it still
// has is error; a share of it is removed, several times a second. Bodies that slide, roll, fly, stand on a corner or
// on something that moves are never touched, nor those that are faster than such an error can be.
// Cost: one look at the contacts, 32 times a second of simulation.

#include "contact.h"
#include "stages.h"

// Rate of the damping [Hz].
static const double rate_of_damping = 32.0;
// Share of the velocity that is removed each time: two thirds in a tenth of a second.
static const double damped_share = 0.3;
// Greatest velocity of an error [m/s]: what the solver leaves of a stack that is put down.
static const double fastest_error = 0.1;
// Least velocity of an error that is damped, as a share of that below which bodies fall asleep by themselves.
static const double slowest_share = 1.0 / 20.0;
// Share of the friction cone inside which a contact sticks; one that slides lies on the cone to the last bit.
static const double inside = 0.999;

// A bound on the speed of any point of a body [m/s].
static double point_speed(const Body *body) {
    return length(body->engine->v) + fabs(body->engine->w) * body->reach;
}

static bool is_slow(const Body *body) {
    return body->anchored || (body->dynamic && !body->state.thrown && point_speed(body) < fastest_error);
}

// Whether friction locks two bodies: they touch by a face, which is no belt, and friction is inside the cone. At a
// first touch the impulse is that of an impact.
static bool sticks(const cpArbiter *arbiter) {
    bool carried = arbiter->surface_vr.x != 0.0 || arbiter->surface_vr.y != 0.0;
    if (arbiter->count != 2 || carried || begins(arbiter)) {
        return false;
    }
    double along = fabs(arbiter->contacts[0].jnAcc + arbiter->contacts[1].jnAcc);
    double across = fabs(arbiter->contacts[0].jtAcc + arbiter->contacts[1].jtAcc);
    return across < inside * arbiter->u * along;
}

void damp_resting(World *world) {
    double step = world->dt * (double)SUB_STEPS;
    int64_t period = llround(1.0 / (rate_of_damping * step));
    if (world->age % (period > 1 ? period : 1) != 0) {
        return;
    }
    int *parents = sets_of(world);
    bool *fixed = TAKE(&world->own->arena, bool, world->body_count);
    for (int number = 0; number < arbiter_count(world); number++) {
        const cpArbiter *each = arbiter_at(world, number);
        if (sticks(each) && is_slow(body_of(each->body_a)) && is_slow(body_of(each->body_b))) {
            unite(parents, place_of(world, each->body_a), place_of(world, each->body_b));
        }
    }
    for (int place = 0; place < world->body_count; place++) {
        if (world->bodies[place].anchored) {
            fixed[root_of(parents, place)] = true;
        }
    }
    double slowest = world->space->idleSpeedThreshold * slowest_share;
    for (int place = 0; place < world->body_count; place++) {
        Body *body = world->bodies + place;
        if (!body->anchored && fixed[root_of(parents, place)] && !sleeps(body) && point_speed(body) > slowest) {
            // Nor does it fall asleep before the error is gone.
            world->chipmunk.body_activate(body->engine);
            body->engine->v = scaled(body->engine->v, 1.0 - damped_share);
            body->engine->w *= 1.0 - damped_share;
        }
    }
}
