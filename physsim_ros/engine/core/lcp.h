// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_LCP_H
#define PHYSSIM_LCP_H

#include <stdbool.h>

enum { LCP_ROWS = 8 };

// Find λ of a linear complementarity problem; return false if there is none, or one too large to be an impulse.
bool solve_lcp(int count, double matrix[LCP_ROWS][LCP_ROWS], const double *rates, double *impulses);

#endif
