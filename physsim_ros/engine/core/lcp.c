// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Linear complementarity problems of a few rows: λ >= 0, A λ + b >= 0, one of the two 0 in each row.
//
// Problem: A is symmetric and positive semidefinite, with a positive diagonal; λ are impulses of contacts, A is what
// they change the velocities of all contacts by.
// Method: block principal pivoting (J. J. Júdice and F. M. Pires, "A block principal pivoting algorithm for large-scale
// strictly monotone linear complementarity problems", 1994): all rows that are on the wrong side change it at once.
// Scope: at most `LCP_ROWS` rows. `mixed_lcp.c` has the same method for the rows of a machine, each of which couples
// few bodies of many: its factors are sparse, and laid out once for thousands of steps. Impacts are others in each
// sub-step, of a few points that all couple each other: a dense matrix on the stack is solved in less time than a
// layout is made in.

#include "lcp.h"
#include <assert.h>
#include <math.h>

// Part of the diagonal of A that is added to it: where many λ solve the problem, it chooses the most even ones in units
// of the effective masses (A. N. Tikhonov, regularisation).
static const double regularisation = 1e-10;
// Share of the greatest rate that is rounding, or comes from the regularisation.
static const double rounding_of_rates = 1e-8;
// Greatest λ in units of the effective masses, as a multiple of the greatest rate. A single point has 1, a body on
// another of an eighth of its mass 9. A problem that no λ solves exceeds it, as that of a body wedged between two that
// do not move.
static const double greatest_scaled = 1e6;
// Greatest count of exchanges: nearly all impacts take one or two, and at most five were seen.
enum { LCP_EXCHANGES = 10 };

// A problem in units of the effective masses, whose diagonal is 1.
typedef struct Scaled {
    int count;
    double matrix[LCP_ROWS][LCP_ROWS];
    double wanted[LCP_ROWS]; // -b
} Scaled;

// Factor the rows that are active, L Lᵀ (Cholesky); the others, and those that there are not, have a diagonal of 1.
static void factor_rows(const Scaled *problem, const bool *active, double lower[LCP_ROWS][LCP_ROWS]) {
    for (int i = 0; i < LCP_ROWS; i++) {
        for (int j = 0; j < i; j++) {
            double sum = active[i] && active[j] ? problem->matrix[i][j] : 0.0;
            for (int k = 0; k < j; k++) {
                sum -= lower[i][k] * lower[j][k];
            }
            lower[i][j] = sum / lower[j][j];
        }
        double sum = active[i] ? problem->matrix[i][i] * (1.0 + regularisation) : 1.0;
        for (int k = 0; k < i; k++) {
            sum -= lower[i][k] * lower[i][k];
        }
        lower[i][i] = sqrt(sum);
    }
}

// Solve the rows that are active; λ of the others is 0.
static void solve_rows_of_lcp(const Scaled *problem, const bool *active, double *found) {
    double lower[LCP_ROWS][LCP_ROWS] = {{0}};
    factor_rows(problem, active, lower);
    for (int i = 0; i < LCP_ROWS; i++) {
        double sum = active[i] ? problem->wanted[i] : 0.0;
        for (int k = 0; k < i; k++) {
            sum -= lower[i][k] * found[k];
        }
        found[i] = sum / lower[i][i];
    }
    for (int i = LCP_ROWS - 1; i >= 0; i--) {
        double sum = found[i];
        for (int k = i + 1; k < LCP_ROWS; k++) {
            sum -= lower[k][i] * found[k];
        }
        found[i] = sum / lower[i][i];
    }
}

// Exchange the rows that are on the wrong side; return whether there are any.
static bool exchange_wrong(const Scaled *problem, const double *found, double slack, bool *active) {
    bool any = false, wrong[LCP_ROWS] = {false};
    for (int i = 0; i < problem->count; i++) {
        double residual = -problem->wanted[i];
        for (int j = 0; j < problem->count; j++) {
            residual += problem->matrix[i][j] * found[j];
        }
        wrong[i] = (active[i] ? found[i] : residual) < -slack;
        any = any || wrong[i];
    }
    for (int i = 0; i < problem->count; i++) {
        active[i] = active[i] != wrong[i];
    }
    return any;
}

bool solve_lcp(int count, double matrix[LCP_ROWS][LCP_ROWS], const double *rates, double *impulses) {
    Scaled problem = {.count = count};
    double scale[LCP_ROWS] = {0}, found[LCP_ROWS] = {0}, most_wanted = 0.0, most_found = 0.0;
    bool active[LCP_ROWS] = {false};
    assert(count <= LCP_ROWS);
    for (int i = 0; i < count; i++) {
        scale[i] = 1.0 / sqrt(matrix[i][i]);
        problem.wanted[i] = -rates[i] * scale[i];
        most_wanted = fmax(most_wanted, fabs(problem.wanted[i]));
        active[i] = true;
    }
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < count; j++) {
            problem.matrix[i][j] = matrix[i][j] * scale[i] * scale[j];
        }
    }
    for (int number = 0; number < LCP_EXCHANGES; number++) {
        solve_rows_of_lcp(&problem, active, found);
        if (exchange_wrong(&problem, found, rounding_of_rates * most_wanted, active)) {
            continue;
        }
        for (int i = 0; i < count; i++) {
            most_found = fmax(most_found, found[i]);
            impulses[i] = fmax(found[i], 0.0) * scale[i];
        }
        return most_found <= greatest_scaled * most_wanted;
    }
    return false;
}
