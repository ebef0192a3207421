// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Projection: the overlap of a contact that begins is taken back along its normal, but for the slop.
//
// By no more than the pair approached in this step, and shared by inverse mass, so that the common centre of mass stays
// (Müller et al. 2007, "Position Based Dynamics", 3.3). Of two bodies the deepest contact counts; contacts are taken
// one after the other, the deepest first (Gauss-Seidel). A body that has no joints gets the velocity of the place where
// it is set back to.

#include "touch_stages.h"
#include "work_correction.h"
#include <stdlib.h>

// The deepest contact of two bodies.
typedef struct Excess {
    const Touch *touch;
    int a, b;        // places of the bodies, the lesser first
    double depth;    // beyond the slop, and no more than the approach in the step [m]
    double ahead[2]; // by how far each body has come towards the other one in the step [m]
} Excess;

// By how far a body is moved, and which part of that is its own way of the step [m].
typedef struct Shift {
    Vec way, back;
} Shift;

static int by_pair_and_depth(const void *one, const void *other) {
    const Excess *x = one, *y = other;
    if (x->a != y->a || x->b != y->b) {
        return x->a != y->a ? (x->a > y->a) - (x->a < y->a) : (x->b > y->b) - (x->b < y->b);
    }
    return (x->depth < y->depth) - (x->depth > y->depth);
}

static int by_depth(const void *one, const void *other) {
    const Excess *x = one, *y = other;
    return x->depth == y->depth ? by_pair_and_depth(one, other) : (x->depth < y->depth) - (x->depth > y->depth);
}

static Excess excess_of(const World *world, const Touch *touch) {
    int deepest = distance_of(touch, 1) < distance_of(touch, 0);
    int a = place_of(world, touch->engines[0]), b = place_of(world, touch->engines[1]);
    Excess excess = {.touch = touch, .a = a < b ? a : b, .b = a < b ? b : a};
    for (int side = 0; side < 2; side++) {
        Vec velocity = velocity_on(touch, side, touch->places[deepest][side]);
        excess.ahead[side] = dot(velocity, touch->normal) * (side == 0 ? 1.0 : -1.0) * world->dt;
    }
    excess.depth = least(-distance_of(touch, deepest) - world->space->collisionSlop, excess.ahead[0] + excess.ahead[1]);
    return excess;
}

static bool is_loose(const Touch *touch) {
    for (int side = 0; side < 2; side++) {
        const Body *body = body_of(touch->engines[side]);
        if (body->joined && body->dynamic) {
            return false;
        }
    }
    return true;
}

static void set_apart(const World *world, const Excess *excess, Shift *shifts) {
    const Touch *touch = excess->touch;
    const cpBody *const *engines = (const cpBody *const *)touch->engines;
    int places[2] = {place_of(world, engines[0]), place_of(world, engines[1])};
    Vec before = sub(shifts[places[1]].way, shifts[places[0]].way);
    double left = excess->depth - dot(before, touch->normal), total = engines[0]->m_inv + engines[1]->m_inv;
    bool loose = is_loose(touch);
    for (int side = 0; side < 2 && left > 0.0; side++) {
        Shift *shift = shifts + places[side];
        double part = left * engines[side]->m_inv / total, sign = side == 0 ? -1.0 : 1.0;
        // The rest of the way is that of the other body.
        double own = loose ? least(part, greatest(excess->ahead[side], 0.0)) : 0.0;
        shift->way = add(shift->way, scaled(touch->normal, sign * part));
        shift->back = add(shift->back, scaled(touch->normal, sign * own));
    }
}

void project_touches(World *world, const Touch *touches, int count, bool *moved) {
    Arena *arena = &world->own->arena;
    Excess *found = TAKE(arena, Excess, count);
    int deep = 0, pairs = 0;
    for (int number = 0; number < count; number++) {
        const Touch *touch = touches + number;
        Excess excess = excess_of(world, touch);
        if (excess.depth > 0.0 && touch->engines[0]->m_inv + touch->engines[1]->m_inv > 0.0) {
            found[deep++] = excess;
        }
    }
    if (deep == 0) {
        return;
    }
    qsort(found, (size_t)deep, sizeof(Excess), by_pair_and_depth);
    for (int number = 0; number < deep; number++) {
        if (number == 0 || found[number].a != found[number - 1].a || found[number].b != found[number - 1].b) {
            found[pairs++] = found[number];
        }
    }
    qsort(found, (size_t)pairs, sizeof(Excess), by_depth);
    Shift *shifts = TAKE(arena, Shift, world->body_count);
    for (int number = 0; number < pairs; number++) {
        set_apart(world, found + number, shifts);
    }
    for (int place = 0; place < world->body_count; place++) {
        cpBody *engine = world->bodies[place].engine;
        Shift shift = shifts[place];
        moved[place] = shift.way.x != 0.0 || shift.way.y != 0.0;
        if (moved[place]) {
            set_twist(engine, corrected_twist(world, engine, shift.back));
            set_pose(engine, (Pose){add(engine->p, shift.way), engine->a});
        }
    }
}
