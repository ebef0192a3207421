// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Constraint rows with bounds (mixed linear complementarity problem).
//
// Problem: where λ of a row of a `saddle_point` has bounds, J v reaches the target of the row, or λ is at a bound and
// J v is on the other side of the target.
// Method: block principal pivoting (J. J. Júdice and F. M. Pires, "A block principal pivoting algorithm for large-scale
// strictly monotone linear complementarity problems", Computers & Operations Research 1994): all rows on the wrong side
// change it at once, as long as their count falls; else the one that is furthest on it does.
// Scope: many rows, sparse; `lcp.c` solves the few of an impact.

#include "mixed_lcp.h"

// Rounding of J v: a row is on the wrong side of its target beyond that [m/s], or [m] of positions.
static const double rounding_of_rows = 1e-7;
// Rounding of λ, as a share of the greatest one.
static const double share_of_rounding = 1e-9;

// Exchanges, at most: a belt that is spanned over its wheels takes some ten in a step in which a link meets a wheel.
enum { MIXED_EXCHANGES = 40 };

// Whether the softness of a row is meant, and not to vanish.
static bool is_spring(const Problem *problem, int row) {
    return problem->springs != NULL && problem->springs[row];
}

// Put a row into the matrix where it has to reach its target, else take it out.
static void use_row(System *system, const Problem *problem, int row, bool active) {
    double unit = active ? row_softness_unit(system, problem->jacobians, row) : 0.0;
    set_row(system, row, active ? problem->jacobians : NULL, unit > 0.0 ? problem->softness[row] * unit : 1.0);
}

// Find the rows on the wrong side, the furthest one among them, and their count; `sides` gets what each ought to be on.
static void find_wrong(const System *system, const Problem *problem, Solution *solution, int8_t *sides, int *furthest) {
    double greatest_impulse = 0.0, most = 0.0;
    for (int row = 0; row < system->row_count; row++) {
        greatest_impulse = greatest(greatest_impulse, fabs(solution->impulses[row]));
    }
    double slack = share_of_rounding * greatest_impulse;
    solution->wrong_count = 0;
    for (int row = 0; row < system->row_count; row++) {
        assert(problem->lower[row] <= problem->upper[row]);
        double impulse = solution->impulses[row], lower = problem->lower[row], upper = problem->upper[row];
        double outside = greatest(lower - impulse, impulse - upper), beyond = 0.0;
        if (solution->sides[row] != 0 && lower < upper) {
            double reached = row_rate(system, problem->jacobians, row, solution->changes);
            beyond = (reached - problem->wanted[row]) * solution->sides[row];
        }
        solution->wrong[row] = outside > slack || beyond > rounding_of_rows;
        if (solution->wrong[row]) {
            double distance = greatest(beyond, outside * row_softness_unit(system, problem->jacobians, row));
            sides[row] = (int8_t)(outside <= slack ? 0 : impulse < lower ? -1 : 1);
            *furthest = distance > most || solution->wrong_count == 0 ? row : *furthest;
            most = greatest(most, distance);
            solution->wrong_count++;
        }
    }
}

// Exchange rows that are on the wrong side, all or the furthest alone.
static void exchange_sides(System *system, const Problem *problem, Solution *solution, const int8_t *right, bool all,
                           int furthest) {
    for (int row = 0; row < system->row_count; row++) {
        if (all ? solution->wrong[row] : row == furthest) {
            bool active = right[row] == 0;
            if ((solution->sides[row] == 0) != active) {
                use_row(system, problem, row, active);
            }
            solution->sides[row] = right[row];
        }
    }
    ldl_factor(&system->factors);
}

// Solve the rows for their sides.
static void solve_sides(System *system, const Problem *problem, Solution *solution, Twist *momenta) {
    for (int body = 0; body < system->body_count; body++) {
        momenta[body] = (Twist){0};
    }
    for (int row = 0; row < system->row_count; row++) {
        if (solution->sides[row] != 0) {
            double bound = solution->sides[row] < 0 ? problem->lower[row] : problem->upper[row];
            solution->impulses[row] = bound;
            add_row_momenta(system, problem->jacobians, row, bound, momenta);
        }
    }
    solve_with(system, solution->sides, problem->wanted, momenta, solution->impulses, solution->changes);
}

// The problem whose targets draw λ to its prior.
static Problem drawn(const System *system, const Problem *problem, Arena *arena) {
    Problem drawn = *problem;
    if (problem->prior != NULL) {
        double *wanted = TAKE(arena, double, system->row_count);
        for (int row = 0; row < system->row_count; row++) {
            double stiffness = problem->softness[row] * row_softness_unit(system, problem->jacobians, row);
            wanted[row] = problem->wanted[row] + stiffness * problem->prior[row];
        }
        drawn.wanted = wanted;
    }
    return drawn;
}

void solve_again(System *system, const Problem *problem, Solution *solution, Arena *arena) {
    size_t mark = arena_mark(arena);
    Problem aimed = drawn(system, problem, arena);
    int8_t *right = TAKE(arena, int8_t, system->row_count);
    Twist *momenta = TAKE(arena, Twist, system->body_count);
    int fewest = system->row_count + 1, furthest = 0;
    for (int round = 0; round < MIXED_EXCHANGES; round++) {
        solve_sides(system, &aimed, solution, momenta);
        find_wrong(system, &aimed, solution, right, &furthest);
        if (solution->wrong_count == 0 || round == MIXED_EXCHANGES - 1) {
            break;
        }
        bool fewer = solution->wrong_count < fewest;
        exchange_sides(system, problem, solution, right, fewer, furthest);
        fewest = fewer ? solution->wrong_count : fewest;
    }
    arena_release(arena, mark);
}

void solve_problem(System *system, const Problem *problem, Solution *solution, Arena *arena) {
    for (int row = 0; row < system->row_count; row++) {
        use_row(system, problem, row, solution->sides[row] == 0);
    }
    ldl_factor(&system->factors);
    solve_again(system, problem, solution, arena);
}

// Whether all λ are within their bounds after a change, up to rounding.
static bool keeps_bounds(const System *system, const Problem *problem, const double *impulses, const double *changes) {
    double most = 0.0;
    for (int row = 0; row < system->row_count; row++) {
        most = greatest(most, fabs(impulses[row]));
    }
    for (int row = 0; row < system->row_count; row++) {
        double impulse = impulses[row] + changes[row];
        double outside = greatest(problem->lower[row] - impulse, impulse - problem->upper[row]);
        if (changes[row] != 0.0 && outside > share_of_rounding * most) {
            return false;
        }
    }
    return true;
}

// Solve rows again, λ drawn to that of a solution: a step of the proximal point method.
static void solve_drawn(System *system, const Problem *problem, Solution *solution, Arena *arena) {
    double *prior = TAKE(arena, double, system->row_count);
    for (int row = 0; row < system->row_count; row++) {
        prior[row] = is_spring(problem, row) ? 0.0 : solution->impulses[row];
    }
    Problem drawn = *problem;
    drawn.prior = prior;
    solve_again(system, &drawn, solution, arena);
}

void refine(System *system, const Problem *problem, Solution *solution, Arena *arena) {
    size_t mark = arena_mark(arena);
    double *residuals = TAKE(arena, double, system->row_count), *impulses = TAKE(arena, double, system->row_count);
    Twist *changes = TAKE(arena, Twist, system->body_count);
    for (int row = 0; row < system->row_count; row++) {
        residuals[row] = problem->wanted[row] - row_rate(system, problem->jacobians, row, solution->changes);
        if (is_spring(problem, row)) {
            residuals[row] -=
                problem->softness[row] * row_softness_unit(system, problem->jacobians, row) * solution->impulses[row];
        }
    }
    solve_active(system, solution->sides, residuals, impulses, changes);
    if (keeps_bounds(system, problem, solution->impulses, impulses)) {
        for (int row = 0; row < system->row_count; row++) {
            solution->impulses[row] += impulses[row];
        }
        for (int body = 0; body < system->body_count; body++) {
            solution->changes[body] = twist_plus(solution->changes[body], changes[body], 1.0);
        }
    } else {
        solve_drawn(system, problem, solution, arena);
    }
    arena_release(arena, mark);
}
