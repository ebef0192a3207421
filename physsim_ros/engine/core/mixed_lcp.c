// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Constraint rows with bounds (mixed linear complementarity problem).
//
// Where λ of a row of a `saddle_point` has bounds, J v reaches the target of the row, or λ is at a bound and J v is on
// the other side of the target. Block principal pivoting (J. J. Júdice and F. M. Pires, "A block principal pivoting
// algorithm for large-scale strictly monotone linear complementarity problems", Computers & Operations Research 1994):
// all rows on the wrong side change it at once. That may go in a circle, even with three rows of one body; an interior
// point method (`interior_point`) then finds the sides, and they are exchanged once more from there.

#include "mixed_lcp.h"
#include "interior_point.h"

// Rounding of J v: a row is on the wrong side of its target beyond that [m/s], or [m] of positions.
static const double rounding = 1e-7;
// Rounding of λ, as a share of the greatest one.
static const double share_of_rounding = 1e-9;

// Factorisations by which rows are exchanged, at most.
enum { ROUNDS = 8 };

static void factor(System *system, const Problem *problem, const int8_t *sides) {
    for (int row = 0; row < system->row_count; row++) {
        Jacobian used = sides[row] == 0 ? problem->jacobians[row] : (Jacobian){0};
        Ends ends = system->ends[row];
        double own = softness_unit(used, system->inverses[ends.a], system->inverses[ends.b]);
        set_row(system, row, used, own > 0.0 ? problem->softness[row] * own : 1.0);
    }
    ldl_factor(&system->factors);
}

// Find the rows on the wrong side, and return their count; `sides` gets what each ought to be on.
static int find_wrong(const System *system, const Problem *problem, Solution *solution, int8_t *sides) {
    double greatest_impulse = 0.0;
    for (int row = 0; row < system->row_count; row++) {
        greatest_impulse = greatest(greatest_impulse, fabs(solution->impulses[row]));
    }
    double slack = share_of_rounding * greatest_impulse;
    solution->wrong_count = 0;
    for (int row = 0; row < system->row_count; row++) {
        double impulse = solution->impulses[row], lower = problem->lower[row], upper = problem->upper[row];
        bool below = impulse<lower - slack, above = impulse> upper + slack, inward = false;
        if (solution->sides[row] != 0 && lower < upper) {
            double rate_of_row = rate(problem->jacobians[row], system->ends[row], solution->changes);
            double beyond = rate_of_row - problem->wanted[row];
            inward = solution->sides[row] < 0 ? beyond < -rounding : beyond > rounding;
        }
        sides[row] = (int8_t)(below ? -1 : above ? 1 : 0);
        solution->wrong[row] = below || above || inward;
        solution->wrong_count += solution->wrong[row];
    }
    return solution->wrong_count;
}

// Exchange the rows that are on the wrong side, until none is.
static void pivot(System *system, const Problem *problem, Solution *solution, int rounds, Arena *arena) {
    size_t mark = arena_mark(arena);
    int8_t *right = TAKE(arena, int8_t, system->row_count);
    Twist *momenta = TAKE(arena, Twist, system->body_count);
    for (int round = 0; round < rounds; round++) {
        for (int row = 0; row < system->row_count && round > 0; row++) {
            solution->sides[row] = solution->wrong[row] ? right[row] : solution->sides[row];
        }
        for (int body = 0; body < system->body_count; body++) {
            momenta[body] = (Twist){0};
        }
        for (int row = 0; row < system->row_count; row++) {
            if (solution->sides[row] != 0) {
                double bound = solution->sides[row] < 0 ? problem->lower[row] : problem->upper[row];
                solution->impulses[row] = bound;
                add_momenta(problem->jacobians[row], system->ends[row], bound, momenta);
            }
        }
        factor(system, problem, solution->sides);
        solve_with(system, solution->sides, problem->wanted, momenta, solution->impulses, solution->changes);
        if (find_wrong(system, problem, solution, right) == 0) {
            break;
        }
    }
    arena_release(arena, mark);
}

void solve_problem(System *system, const Problem *problem, Solution *solution, Arena *arena) {
    pivot(system, problem, solution, ROUNDS, arena);
    if (solution->wrong_count > 0) {
        find_sides(system, problem, solution, arena);
        pivot(system, problem, solution, ROUNDS, arena);
    }
}

void refine(System *system, const Problem *problem, Solution *solution, Arena *arena) {
    size_t mark = arena_mark(arena);
    double *left = TAKE(arena, double, system->row_count), *impulses = TAKE(arena, double, system->row_count);
    Twist *changes = TAKE(arena, Twist, system->body_count);
    for (int row = 0; row < system->row_count; row++) {
        Ends ends = system->ends[row];
        left[row] = problem->wanted[row] - rate(problem->jacobians[row], ends, solution->changes);
        if (problem->springs != NULL && problem->springs[row]) {
            const Inverse *inverses = system->inverses;
            double own = softness_unit(problem->jacobians[row], inverses[ends.a], inverses[ends.b]);
            left[row] -= problem->softness[row] * own * solution->impulses[row];
        }
    }
    solve_active(system, solution->sides, left, impulses, changes);
    for (int row = 0; row < system->row_count; row++) {
        solution->impulses[row] += impulses[row];
    }
    for (int body = 0; body < system->body_count; body++) {
        solution->changes[body].v = add(solution->changes[body].v, changes[body].v);
        solution->changes[body].w += changes[body].w;
    }
    arena_release(arena, mark);
}
