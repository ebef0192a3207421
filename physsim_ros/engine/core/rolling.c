// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Rolling resistance: what rolls comes to rest, since tyre and ground yield where they bear each other.
//
// Problem: a disc rolls on for ever, and starts to roll on the slightest slope.
// Method: at each contact of a disc, a torque of any size up to c r N stops the spin of the two bodies against each
// other: c is the greater coefficient of the two, r the radius, N the load (rolling friction of Box2D 3.1; the load
// acts c r ahead of the centre). It is a row of Chipmunk's iterations, after the contacts, which bound it by their
// loads of the moment; the contacts of jointed bodies have theirs in the joint solver (`joint_islands.c`). Before the
// first iteration it is solved once with the loads of the sub-step before: a disc at rest on a slope is then in balance
// from the start. Munk2D has no hook in its iterations but that of constraints: the class of the hook constraint is
// replaced within a sub-step.
// Law: a disc of radius of gyration k rolls on for v² (1 + k²/r²) / (2 c g), a cart of light wheels for v² / (2 c g),
// and both stand on slopes below c.
// Cost: 5 ns a contact, nothing where no body has it.
// Without it law 75 (rolling resistance) fails.

#include "outline.h"
#include "stages.h"

typedef struct Roll {
    const cpArbiter *arbiter;
    double arm;     // c r [m]
    double inverse; // of the moments of inertia [1/(kg m²)]
    double impulse; // on the second body [N m s]
} Roll;

static double round_radius(const cpShape *shape) {
    return kind_of(shape) == SHAPE_CIRCLE ? radius_of(shape) : 0.0;
}

double rolling_arm(const cpArbiter *arbiter) {
    double a = body_of(arbiter->body_a)->rolling, b = body_of(arbiter->body_b)->rolling;
    double inverse = arbiter->body_a->i_inv + arbiter->body_b->i_inv;
    double radius = greatest(round_radius(arbiter->a), round_radius(arbiter->b));
    return inverse > 0.0 ? greatest(a, b) * radius : 0.0;
}

static void resist(cpConstraint *hook, double dt) {
    (void)dt;
    const World *world = hook->userData;
    for (int number = 0; number < world->own->now.roll_count; number++) {
        Roll *roll = world->own->now.rolls + number;
        const cpArbiter *arbiter = roll->arbiter;
        double load = 0.0;
        for (int point = 0; point < arbiter->count; point++) {
            load += arbiter->contacts[point].jnAcc;
        }
        double most = roll->arm * greatest(load, 0.0), former = roll->impulse;
        double stopped = former - (arbiter->body_b->w - arbiter->body_a->w) / roll->inverse;
        roll->impulse = clamped(stopped, -most, most);
        arbiter->body_a->w -= (roll->impulse - former) * arbiter->body_a->i_inv;
        arbiter->body_b->w += (roll->impulse - former) * arbiter->body_b->i_inv;
    }
}

// Whether the joint solver has the row of a contact.
static bool has_joint_row(const World *world, const cpArbiter *arbiter) {
    const bool *bearers = world->own->now.bearers;
    return bearers != NULL && (bearers[place_of(world, arbiter->body_a)] || bearers[place_of(world, arbiter->body_b)]);
}

void find_rolls(World *world) {
    Private *own = world->own;
    int count = own->has_rolling ? arbiter_count(world) : 0;
    own->now.rolls = TAKE(&own->arena, Roll, count);
    own->now.roll_count = 0;
    for (int number = 0; number < count; number++) {
        const cpArbiter *arbiter = arbiter_at(world, number);
        double arm = rolling_arm(arbiter), inverse = arbiter->body_a->i_inv + arbiter->body_b->i_inv;
        if (arm > 0.0 && !has_joint_row(world, arbiter)) {
            own->now.rolls[own->now.roll_count++] = (Roll){arbiter, arm, inverse, 0.0};
        }
    }
}

// The hook itself holds nothing, so that it has nothing to prepare.
static void prepare_nothing(cpConstraint *hook, double dt) {
    (void)hook;
    (void)dt;
}

void begin_rolling(World *world) {
    world->own->hook_class = world->own->hook->klass;
    world->own->rolling_class =
        (cpConstraintClass){prepare_nothing, resist, resist, world->own->hook_class->getImpulse};
    world->own->hook->klass = &world->own->rolling_class;
}

void end_rolling(World *world) {
    world->own->hook->klass = world->own->hook_class;
}
