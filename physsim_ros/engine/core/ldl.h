// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_LDL_H
#define PHYSSIM_LDL_H

#include "arena.h"

// A sparse symmetric matrix and its factors.
typedef struct Ldl {
    int size;
    const int *starts;   // (size + 1): where the entries above the diagonal of each column begin
    const int *rows;     // of these entries
    double *values;      // of these entries; set before each factorisation
    double *diagonal;    // (size); set before each factorisation
    int *pattern_starts; // (size + 1): where the columns of each row of L begin, ascending
    int *pattern;
    int *factor_starts; // (size + 1): where each column of L begins, without the diagonal
    int *factor_rows;   // ascending
    double *factors;
    int *filled;
    double *inverse_pivots;
    double *work;
} Ldl;

// Find where the factors are not 0; once for a pattern of `starts` and `rows`.
void ldl_analyse(Ldl *system, Arena *arena);

// Factor the matrix of `values` and `diagonal`.
void ldl_factor(Ldl *system);

// Replace a right side by the solution.
void ldl_solve(const Ldl *system, double *x);

#endif
