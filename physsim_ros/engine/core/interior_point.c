// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Which rows of a problem are at a bound, where pivoting does not find it.
//
// Problem: exchanging all rows that are on the wrong side may go in a circle, and exchanging one at a time takes as
// many factorisations as there are rows: a rope on a drum has thirty contacts that slide, and light links between them.
// Method: a primal-dual interior point method (Wright, "Primal-Dual Interior-Point Methods", 1997, chapter 5). λ stays
// between its bounds, each bound has a multiplier z > 0, and Newton's steps lead to z (λ - bound) = μ for a μ that
// falls to a tenth each time. A row is at the bound whose multiplier is greater than the slack of λ. From there
// pivoting ends at once. Cost: some fifteen factorisations, whatever the count of rows.

#include "interior_point.h"

// Newton's steps, at most.
enum { STEPS = 40 };
// The share of the mean product of slack and multiplier that a step aims at.
static const double centering = 0.1;
// The share of the way to the nearest bound that a step goes, at most.
static const double boldness = 0.99;
// Residuals and products at which it ends, as a share of what is wanted.
static const double tolerance = 1e-8;

// An iterate.
typedef struct Interior {
    const System *system;
    const Problem *problem;
    double *own;           // (row_count): diagonal of J M⁻¹ Jᵀ [1/kg, 1/(kg m²)]
    double *impulses;      // (row_count): λ
    double *below, *above; // (row_count): multipliers of the bounds; 0 where there is no such bound
    double *residuals;     // (row_count): target of a row less what it reaches
    double *steps;         // (row_count): change of λ
    double mean;           // of products of slack and multiplier
    double worst;          // residual
    double most_wanted, most_impulse;
} Interior;

static bool is_open(const Problem *problem, int row) {
    return problem->lower[row] < problem->upper[row];
}

static double slack_below(const Interior *at, int row) {
    return at->impulses[row] - at->problem->lower[row];
}

static double slack_above(const Interior *at, int row) {
    return at->problem->upper[row] - at->impulses[row];
}

static Interior begin(const System *system, const Problem *problem, double *impulses, Arena *arena) {
    int count = system->row_count;
    Interior at = {.system = system, .problem = problem, .impulses = impulses};
    at.own = TAKE(arena, double, count);
    at.below = TAKE(arena, double, count);
    at.above = TAKE(arena, double, count);
    at.residuals = TAKE(arena, double, count);
    at.steps = TAKE(arena, double, count);
    for (int row = 0; row < count; row++) {
        Ends ends = system->ends[row];
        double own = softness_unit(problem->jacobians[row], system->inverses[ends.a], system->inverses[ends.b]);
        at.own[row] = is_open(problem, row) ? own : 0.0;
        if (at.own[row] > 0.0) {
            at.most_wanted = greatest(at.most_wanted, fabs(problem->wanted[row]));
            at.most_impulse = greatest(at.most_impulse, fabs(problem->wanted[row]) / own);
        }
    }
    for (int row = 0; row < count; row++) {
        double lower = problem->lower[row], upper = problem->upper[row];
        if (at.own[row] == 0.0) {
            impulses[row] = lower;
            continue;
        }
        double room = least(at.most_impulse, (upper - lower) / 2.0) / 2.0, weight = at.own[row] * at.most_impulse;
        impulses[row] = clamped(impulses[row], lower + room, upper - room);
        at.below[row] = lower > -INFINITY ? weight : 0.0;
        at.above[row] = upper < INFINITY ? weight : 0.0;
    }
    return at;
}

// Measure residuals and products; return whether they are small enough.
static bool measure(Interior *at, Arena *arena) {
    const System *system = at->system;
    size_t mark = arena_mark(arena);
    Twist *changes = TAKE(arena, Twist, system->body_count);
    for (int row = 0; row < system->row_count; row++) {
        add_momenta(at->problem->jacobians[row], system->ends[row], at->impulses[row], changes);
    }
    for (int body = 0; body < system->body_count; body++) {
        Inverse inverse = system->inverses[body];
        changes[body] = (Twist){scaled(changes[body].v, inverse.mass), changes[body].w * inverse.moment};
    }
    int bounds = 0;
    at->mean = at->worst = 0.0;
    for (int row = 0; row < system->row_count; row++) {
        if (at->own[row] == 0.0) {
            continue;
        }
        double reached = rate(at->problem->jacobians[row], system->ends[row], changes);
        reached += at->problem->softness[row] * at->own[row] * at->impulses[row] - at->below[row] + at->above[row];
        at->residuals[row] = at->problem->wanted[row] - reached;
        at->worst = greatest(at->worst, fabs(at->residuals[row]));
        at->mean += at->below[row] > 0.0 ? at->below[row] * slack_below(at, row) : 0.0;
        at->mean += at->above[row] > 0.0 ? at->above[row] * slack_above(at, row) : 0.0;
        bounds += (at->below[row] > 0.0) + (at->above[row] > 0.0);
    }
    at->mean = bounds > 0 ? at->mean / bounds : 0.0;
    arena_release(arena, mark);
    return at->worst <= tolerance * at->most_wanted && at->mean <= tolerance * at->most_wanted * at->most_impulse;
}

// Find Newton's step of λ towards products of `aim`.
static void find_step(Interior *at, System *system, double aim) {
    for (int row = 0; row < system->row_count; row++) {
        double stiffness = at->problem->softness[row] * at->own[row], wanted = at->residuals[row];
        if (at->below[row] > 0.0) {
            stiffness += at->below[row] / slack_below(at, row);
            wanted += aim / slack_below(at, row) - at->below[row];
        }
        if (at->above[row] > 0.0) {
            stiffness += at->above[row] / slack_above(at, row);
            wanted -= aim / slack_above(at, row) - at->above[row];
        }
        bool counts = at->own[row] > 0.0;
        set_row(system, row, counts ? at->problem->jacobians[row] : (Jacobian){0}, counts ? stiffness : 1.0);
        at->steps[row] = counts ? wanted : 0.0;
    }
    ldl_factor(&system->factors);
    solve_rows(system, at->steps, at->steps);
}

// The change of a multiplier with a step of λ, towards or away from its bound.
static double change_of(double multiplier, double slack, double step, double aim) {
    return (aim - multiplier * step) / slack - multiplier;
}

// The share of a step after which a value of this change is still positive.
static double share_for(double value, double change) {
    return change < 0.0 ? -boldness * value / change : 1.0;
}

static void make_step(Interior *at, double aim) {
    double share = 1.0;
    int count = at->system->row_count;
    for (int row = 0; row < count; row++) {
        double step = at->steps[row], below = slack_below(at, row), above = slack_above(at, row);
        if (at->below[row] > 0.0) {
            double change = change_of(at->below[row], below, step, aim);
            share = least(share, least(share_for(below, step), share_for(at->below[row], change)));
        }
        if (at->above[row] > 0.0) {
            double change = change_of(at->above[row], above, -step, aim);
            share = least(share, least(share_for(above, -step), share_for(at->above[row], change)));
        }
    }
    for (int row = 0; row < count; row++) {
        double step = at->steps[row], below = slack_below(at, row), above = slack_above(at, row);
        at->below[row] += at->below[row] > 0.0 ? share * change_of(at->below[row], below, step, aim) : 0.0;
        at->above[row] += at->above[row] > 0.0 ? share * change_of(at->above[row], above, -step, aim) : 0.0;
        at->impulses[row] += share * step;
    }
}

void find_sides(System *system, const Problem *problem, Solution *solution, Arena *arena) {
    size_t mark = arena_mark(arena);
    Interior at = begin(system, problem, solution->impulses, arena);
    for (int number = 0; number < STEPS && !measure(&at, arena); number++) {
        double aim = centering * at.mean;
        find_step(&at, system, aim);
        make_step(&at, aim);
    }
    for (int row = 0; row < system->row_count; row++) {
        if (at.own[row] > 0.0) {
            bool low = at.below[row] > at.own[row] * slack_below(&at, row);
            bool high = at.above[row] > at.own[row] * slack_above(&at, row);
            solution->sides[row] = (int8_t)(low ? -1 : high ? 1 : 0);
        }
    }
    arena_release(arena, mark);
}
