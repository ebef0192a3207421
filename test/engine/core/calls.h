// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Calls of parts of the core with plain arrays, as `calls.c` makes them; cffi reads this file.

// Take pieces of memory in some steps, and those from a number on once more in each; return whether all were aligned
// and empty, and whether steps after the first needed no more memory.
_Bool call_arena(int count, const int *sizes, int kept);

// Find the roots of sets of numbers (count), of which pairs (pair_count, 2) are united.
void call_sets(int count, int pair_count, const int *pairs, int *roots);

// Replace `x` by the solution of a symmetric matrix by `diagonal` and the entries above it, column by column. The
// matrix is factored anew where it differs from a former one, with other values in the same places.
void call_ldl(int size, const int *starts, const int *rows, double *former_values, double *former_diagonal,
              double *values, double *diagonal, double *x);

_Bool call_lcp(int count, double matrix[8][8], const double *rates, double *impulses);

// Rows between two bodies each: `inverses` (bodies, 2), `ends` (rows, 2), `jacobians` (rows, 6), `changes` (bodies, 3).
// The last sub-step had rows between `former_ends`. Return the count of rows that are left on the wrong side.
int call_mixed_lcp(int body_count, const double *inverses, int row_count, const int *ends, const int *former_ends,
                   const int *groups, const double *jacobians, const double *wanted, const double *lower,
                   const double *upper, const double *softness, double *impulses, double *changes);

void call_elimination_order(int count, const int *weights, const int *starts, const int *neighbours, int *order);

// Boxes (count, 4) are low x and y, high x and y. Replace one, find those that overlap another one, up to a number, and
// return their count.
int call_boxes(int count, const double *boxes, int changed, const double *replacement, const double *box, int most,
               int *found);

// A convex shape (count, 2), counter-clockwise, with its radius, and its motion: a pose, and its change in the step.
// One of one corner is a disc, of two a segment.
typedef struct Case {
    const double *corners, *normals;
    int count;
    double radius;
    double pose[3], change[3];
} Case;
double call_time_of_impact(const Case *one, const Case *other, double slop, double depth);

// Find what of a convex shape, by the pose of its case, lies in a region whose pose is the origin: area [m²], first
// moment about the pose [m³], and length of its outline [m]. Without a region that is all of it, but for the area.
void call_immersed(const Case *given, const Case *region, double *found);

// Have pairs of discs meet at half a step, far from other pairs; return the count of discs that have met.
int call_join_impacts(int pair_count);
