// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Calls of parts of the core with plain arrays, as `calls.c` makes them; cffi reads this file.

// Replace `x` by the solution of a symmetric matrix by `diagonal` and the entries above it, column by column.
void call_ldl(int size, const int *starts, const int *rows, double *values, double *diagonal, double *x);

_Bool call_lcp(int count, double matrix[8][8], const double *rates, double *impulses);

// Rows between two bodies each: `inverses` (bodies, 2), `ends` (rows, 2), `jacobians` (rows, 6), `changes` (bodies, 3).
// Return the count of rows that are left on the wrong side.
int call_mixed_lcp(int body_count, const double *inverses, int row_count, const int *ends, const int *groups,
                   const double *jacobians, const double *wanted, const double *lower, const double *upper,
                   const double *softness, double *impulses, double *changes);

void call_elimination_order(int count, const int *weights, const int *starts, const int *neighbours, int *order);

// Boxes (count, 4) are low x and y, high x and y. Replace one, find those that overlap another one, return their count.
int call_boxes(int count, const double *boxes, int changed, const double *replacement, const double *box, int *found);

// A convex shape (count, 2), counter-clockwise, with its radius, and its motion: a pose, and its change in the step.
typedef struct Case {
    const double *corners, *normals;
    int count;
    double radius;
    double pose[3], change[3];
} Case;
double call_time_of_impact(const Case *one, const Case *other, double slop, double depth);

// Return the area of a convex shape, by the pose of its case, that lies in a polygon whose pose is the origin [m²].
double call_immersed(const Case *given, const Case *region);

// Have pairs of discs meet at half a step, far from other pairs; return the count of discs that have met.
int call_join_impacts(int pair_count);
