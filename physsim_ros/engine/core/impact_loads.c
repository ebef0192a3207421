// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Loads outlive impacts: the next sub-step starts from the impulses of loads, not from those of impacts.
//
// Problem: the solver starts from the impulses of the sub-step before (warm starting), which for a load are nearly
// those of now. The impulse of an impact acts once; a solver that starts from it has to take it back, and few
// iterations do not: a disc of clay that falls on a light plate on the floor is thrown up by half a metre.
// Method: our own. A load grows step by step, an impact comes at once. A contact starts the next sub-step with at most
// four times the impulse with which it started this one, and what stops the slowest impact; one that begins starts the
// next with none, or with the least number that tells a one-way body that it has carried one.
// Law: each contact is bounded by itself, so that a pile bears its load while things still fall onto it.
// Limit: with a bound of twice the impulse, one crowd in a hundred gains 5 % of its energy, since more of the loads are
// bounded beside others that are not.
// Cost: 5 ns a contact.
// Without it clay rises from a light plate (law 44), and boxes that meet head on without restitution part again (law
// 3).

#include "contact.h"
#include "one_way.h"
#include "stages.h"
#include <float.h>

// Growth of a load in a sub-step, at most.
static const double growth = 4.0;

typedef struct Load {
    cpContact *contact;
    double most; // impulse along the normal [N s]
} Load;

void list_load_bounds(World *world) {
    int points = 0;
    for (int number = 0; number < arbiter_count(world); number++) {
        points += arbiter_at(world, number)->count;
    }
    world->own->now.loads = TAKE(&world->own->arena, Load, points);
    for (int number = 0; number < arbiter_count(world); number++) {
        const cpArbiter *each = arbiter_at(world, number);
        double least_load = is_of_one_way(each) ? DBL_MIN : 0.0;
        for (int point = 0; point < each->count; point++) {
            cpContact *contact = each->contacts + point;
            double most = growth * greatest(contact->jnAcc, 0.0) + slowest_impact * contact->nMass;
            assert(world->own->now.load_count < points);
            world->own->now.loads[world->own->now.load_count++] = (Load){contact, begins(each) ? least_load : most};
        }
    }
}

void remove_impact_impulses(World *world) {
    for (int number = 0; number < world->own->now.load_count; number++) {
        const Load *load = world->own->now.loads + number;
        if (load->contact->jnAcc > load->most) {
            load->contact->jtAcc *= load->most / load->contact->jnAcc;
            load->contact->jnAcc = load->most;
        }
    }
}
