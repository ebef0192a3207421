// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Impact propagation: elastic contacts next to each other are solved one after the other.
//
// Problem: Chipmunk takes the restitution of a contact from the approach velocity before the sub-step and solves all
// contacts together. The second of two touching balls has no approach velocity against the third when the first hits
// it, so that contact is solved as inelastic, and the row takes the impact as one body. Where a body is in two
// impacts at once, the ten iterations of the solver do not converge, and energy is lost or gained.
// Method: sequential impacts: pairwise Newton restitution, the fastest approach first, each round being one step of
// Chipmunk (Smith, Kaufman, Vouga, Tamstorf and Grinspun, "Reflections on Simultaneous Impact", SIGGRAPH 2012,
// section 3, Gauss-Seidel impacts). A contact is deferred by a sub-step while one of its bodies is in a faster impact.
// The next sub-step finds the velocity that the impact has given, and passes it on.
// Scope: contacts of a restitution from `elastic` on. Contacts under load, as in a stack, and deep ones are not
// deferred, nor contacts that are equally fast: what is symmetric stays so. Each decision depends on the contacts in
// this sub-step of the two bodies, and of those that rigid joints tie to them.
// Cost: 20 ns an elastic contact.
// Without it laws 17 (Newton's cradle), 21 (elastic discs keep their energy) and 36 (elastic rows) fail.
// Limits: a contact that is deferred sinks by a sub-step of the impact. Elastic piles overlap for another reason: four
// iterations in a sub-step do not carry an impact through a column (`docs/physics.md`, Piles).

#include "contact.h"
#include "joint_rows.h"
#include "stages.h"

// Restitution from which an impact is passed on, rather than taken together: below it, more than 7 / 16 of the energy
// of an impact is lost anyway.
static const double elastic = 0.75;
// Approach velocities of this ratio are equal but for rounding.
static const double alike = 1.0 - 1e-9;
// Share of the impact next to a contact that its impulse of the last sub-step has to stop, so that it is under load.
static const double load_share = 0.05;

static double depth_of(const cpArbiter *arbiter) {
    double depth = -INFINITY;
    for (int number = 0; number < arbiter->count; number++) {
        depth = greatest(depth, -gap_at(arbiter, arbiter->contacts + number));
    }
    return depth;
}

static bool is_elastic(const cpArbiter *arbiter) {
    return arbiter->count > 0 && arbiter->e >= elastic;
}

// Have bodies that rigid joints tie together share their fastest impact, which passes through joints at once.
static void share_impacts(World *world, double *impacts) {
    int *parents = sets_of(world);
    for (int number = 0; number < world->joint_count; number++) {
        const Joint *joint = world->joints + number;
        bool rigid = joint->row_count > 0 && is_equality(world->rows + joint->first_row);
        if (rigid && world->bodies[joint->a].dynamic && world->bodies[joint->b].dynamic) {
            int a = root_of(parents, joint->a), b = root_of(parents, joint->b);
            double fastest = greatest(impacts[a], impacts[b]);
            unite(parents, a, b);
            impacts[root_of(parents, a)] = fastest;
        }
    }
    for (int number = 0; number < world->own->jointed_count; number++) {
        int place = world->own->jointed[number];
        impacts[place] = impacts[root_of(parents, place)];
    }
}

// The fastest approach of each body; bodies that forces do not move take no impact.
static double *fastest_impacts(World *world) {
    double *impacts = TAKE(&world->own->arena, double, world->body_count);
    for (int number = 0; number < arbiter_count(world); number++) {
        const cpArbiter *each = arbiter_at(world, number);
        double approach = is_elastic(each) ? approach_of(each) : 0.0;
        if (approach > slowest_impact) {
            const cpBody *ends[2] = {each->body_a, each->body_b};
            for (int end = 0; end < 2; end++) {
                double *impact = impacts + place_of(world, ends[end]);
                *impact = ends[end]->m_inv > 0.0 ? greatest(*impact, approach) : 0.0;
            }
        }
    }
    if (world->own->jointed_count > 0) {
        share_impacts(world, impacts);
    }
    return impacts;
}

// Exclude a contact from this sub-step, unless it is as fast as the impact or under load.
//
// `bounce` is set to e v_n by `cpArbiterPreStep`, v_n < 0 being approach; the solver seeks an impulse `jnAcc` >= 0 for
// which v_n >= -bounce, from that of the sub-step before on. An infinite `bounce` permits any approach.
static void defer(cpArbiter *arbiter, double impact) {
    for (int number = 0; number < arbiter->count; number++) {
        const cpContact *point = arbiter->contacts + number;
        if (-point->bounce >= alike * impact * arbiter->e) {
            return;
        }
        // An impulse of the last sub-step where bodies do not part is a load, as in a stack.
        if (point->bounce < slowest_impact * arbiter->e && point->jnAcc > load_share * impact * point->nMass) {
            return;
        }
    }
    for (int number = 0; number < arbiter->count; number++) {
        cpContact *point = arbiter->contacts + number;
        point->bounce = INFINITY;
        point->jnAcc = point->jtAcc = 0.0;
    }
}

static double impact_of(const World *world, const double *impacts, const cpArbiter *arbiter) {
    return greatest(impacts[place_of(world, arbiter->body_a)], impacts[place_of(world, arbiter->body_b)]);
}

// Whether a contact is next to a faster impact. One that is deeper than two sub-steps of the impact take it is solved
// with the others.
static bool is_weaker(const World *world, const cpArbiter *arbiter, double impact) {
    double deepest = slop_of(arbiter) + 2.0 * impact * world->dt;
    return is_elastic(arbiter) && approach_of(arbiter) < alike * impact && depth_of(arbiter) < deepest;
}

void defer_contacts(World *world) {
    const double *impacts = fastest_impacts(world);
    Pair *weaker = TAKE(&world->own->arena, Pair, arbiter_count(world));
    int count = 0;
    for (int number = 0; number < arbiter_count(world); number++) {
        const cpArbiter *each = arbiter_at(world, number);
        if (is_weaker(world, each, impact_of(world, impacts, each))) {
            weaker[count++] = bodies_of(world, each);
        }
    }
    // Two bodies may touch in several contacts: all of them are deferred, or none.
    sort_pairs(weaker, count);
    for (int number = 0; number < arbiter_count(world); number++) {
        cpArbiter *each = arbiter_at(world, number);
        if (is_elastic(each) && has_pair(weaker, count, bodies_of(world, each))) {
            defer(each, impact_of(world, impacts, each));
        }
    }
}
