// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Steep friction: contacts whose friction changes their normal velocity as much as their load does.
//
// Problem: Chipmunk finds the changes of normal impulse and friction of a point from one velocity (Jacobi). Where
// friction lifts a corner by more than the load beneath it does, each round takes back what the one before has given:
// after an even number of rounds nothing is left, and the corner sinks. A rod does so from a friction of 4/3 on, where
// P. Painlevé has found his paradox ("Sur les lois du frottement de glissement", 1895).
// Method: a round of a point that slips multiplies the error by 1 - (K_nn + μ |K_nt|) m, where K_nn and K_nt are the
// changes of its normal velocity by impulses of 1 along normal and face. Chipmunk's effective mass is m = 1 / K_nn,
// with which that factor is -μ |K_nt| m; where it is too great, a lesser m bounds it (damped Jacobi).
// Law: 78, boxes that tip; without this stage the corner of a box of 1 m sinks by 26 mm from a friction of 2 on.
// Cost: 5 ns a contact.

#include "stages.h"

// The greatest factor by which a round multiplies an error [1]: that of a rod at a friction of 1. Up to it, Chipmunk's
// own rounds converge.
static const double greatest_factor = 0.75;

static void damp_rounds(const cpArbiter *arbiter, cpContact *point) {
    const cpBody *a = arbiter->body_a, *b = arbiter->body_b;
    Vec normal = arbiter->n, tangent = perpendicular(normal);
    double across = a->i_inv * cross(point->r1, normal) * cross(point->r1, tangent) +
                    b->i_inv * cross(point->r2, normal) * cross(point->r2, tangent);
    double factor = arbiter->u * fabs(across) * point->nMass;
    if (factor > greatest_factor) {
        point->nMass *= (1.0 + greatest_factor) / (1.0 + factor);
    }
}

void damp_steep_friction(World *world) {
    for (int number = 0; number < arbiter_count(world); number++) {
        const cpArbiter *each = arbiter_at(world, number);
        for (int point = 0; point < each->count; point++) {
            damp_rounds(each, each->contacts + point);
        }
    }
}
