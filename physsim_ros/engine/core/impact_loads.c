// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Loads outlive impacts: the next step starts from the impulses of before.
//
// Problem: the solver starts from the impulses of the step before (warm starting), which for a load are nearly those of
// now. The impulse of an impact acts once; a solver that starts from it has to take it back, and few iterations do not:
// a disc of clay that falls on a light plate on the floor is thrown up by half a metre.
// Method: our own. In a step with an impact, the contacts of all bodies that it reaches keep the impulses with which
// they began the step for the start of the next one; those that begin have none. Cost: 10 ns a contact, in such steps.

#include "impact_propagation.h"
#include "stages.h"

typedef struct Load {
    cpContact *contact;
    double normal, friction;
} Load;

// An impact reaches the island of a body that forces move.
static void mark_hit(const World *world, int *parents, const cpBody *engine, bool *hit) {
    if (engine->m_inv > 0.0) {
        hit[root_of(parents, place_of(world, engine))] = true;
    }
}

void keep_loads(World *world) {
    world->own->load_count = 0;
    bool any = false;
    for (int number = 0; number < arbiter_count(world) && !any; number++) {
        any = is_impact(arbiter_at(world, number));
    }
    if (!any) {
        return;
    }
    int *parents = sets_of(world);
    bool *hit = TAKE(&world->own->arena, bool, world->body_count);
    for (int number = 0; number < arbiter_count(world); number++) {
        const cpArbiter *each = arbiter_at(world, number);
        if (each->body_a->m_inv > 0.0 && each->body_b->m_inv > 0.0) {
            unite(parents, place_of(world, each->body_a), place_of(world, each->body_b));
        }
    }
    int points = 0;
    for (int number = 0; number < arbiter_count(world); number++) {
        const cpArbiter *each = arbiter_at(world, number);
        points += each->count;
        if (is_impact(each)) {
            mark_hit(world, parents, each->body_a, hit);
            mark_hit(world, parents, each->body_b, hit);
        }
    }
    world->own->loads = TAKE(&world->own->arena, Load, points);
    for (int number = 0; number < arbiter_count(world); number++) {
        const cpArbiter *each = arbiter_at(world, number);
        if (hit[root_of(parents, place_of(world, each->body_a))] ||
            hit[root_of(parents, place_of(world, each->body_b))]) {
            for (int point = 0; point < each->count; point++) {
                cpContact *contact = each->contacts + point;
                world->own->loads[world->own->load_count++] = (Load){contact, contact->jnAcc, contact->jtAcc};
            }
        }
    }
}

void restore_loads(World *world) {
    for (int number = 0; number < world->own->load_count; number++) {
        const Load *load = world->own->loads + number;
        load->contact->jnAcc = load->normal;
        load->contact->jtAcc = load->friction;
    }
}
