// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_LDL_H
#define PHYSSIM_LDL_H

#include "arena.h"
#include <stdbool.h>

// A sparse symmetric matrix and its factors.
typedef struct Ldl {
    int size;
    const int *starts;   // (size + 1): where the entries above the diagonal of each column begin
    const int *rows;     // of these entries
    double *values;      // of these entries
    double *diagonal;    // (size)
    bool *changed;       // (size): columns whose entries have changed since the last factorisation
    int *parents;        // (size): in the elimination tree; -1 is a root
    int *pattern_starts; // (size + 1): where the columns of each row of L begin, ascending
    int *pattern;
    int *places;        // of the entries of `pattern` among the factors
    int *factor_starts; // (size + 1): where each column of L begins, without the diagonal
    int *factor_rows;   // ascending
    double *factors;
    double *inverse_pivots;
    double *work;
} Ldl;

// Find where the factors are not 0; once for a pattern of `starts` and `rows`. All columns count as changed.
void ldl_analyse(Ldl *ldl, Arena *arena);

// Factor the matrix of `values` and `diagonal` anew where it has changed.
void ldl_factor(Ldl *ldl);

// Replace a right side by the solution.
void ldl_solve(const Ldl *ldl, double *x);

#endif
