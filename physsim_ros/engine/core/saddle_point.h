// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_SADDLE_POINT_H
#define PHYSSIM_SADDLE_POINT_H

#include "arena.h"
#include "ldl.h"
#include "vector.h"
#include <stdbool.h>
#include <stdint.h>

// J of a row: of the first and the second body.
typedef struct Jacobian {
    Twist a, b;
} Jacobian;

// The two bodies of a row, as places among those of the system.
typedef struct Ends {
    int a, b;
} Ends;

// What forces change: 0 for bodies that they do not move [1/kg, 1/(kg m²)].
typedef struct Inverse {
    double mass, moment;
} Inverse;

// Which bodies a set of rows has.
typedef struct Layout {
    int body_count, row_count;
    const Inverse *inverses; // (body_count)
    const Ends *ends;        // (link_count)
    const int *further;      // (row_count + 1): the first further link of each row, from `row_count` on
    const int *groups;       // (row_count): rows of a joint or of a pair of bodies have one, and follow one another
} Layout;

// A set of rows, whose Jacobian may change. A row has a link between two bodies, with its own number, and may have
// further ones, whose J v is added.
typedef struct System {
    int body_count, row_count, link_count;
    const Inverse *inverses; // (body_count)
    const Ends *ends;        // (link_count)
    const int *further;      // (row_count + 1)
    const int *groups;       // (row_count)
    int *body_unknowns;      // (body_count): the first of three unknowns of each; -1 for those that do not move
    int *row_unknowns;       // (row_count)
    int (*places)[6];        // (link_count): of the entries of J among the values of the matrix; -1 for none
    Ldl factors;
    double *side; // the right side, then the solution
} System;

// Rows with targets and bounds.
typedef struct Problem {
    const Jacobian *jacobians;   // (link_count)
    const double *wanted;        // target - J v [m/s, rad/s]
    const double *lower, *upper; // of λ [N s, N m s]
    const double *softness;      // E as a share of `softness_unit`
    const double *prior;         // λ that E draws a solution to; NULL is 0
    const bool *springs;         // rows whose softness is meant; that of others is to vanish. NULL is none
} Problem;

typedef struct Solution {
    double *impulses; // (row_count): λ
    Twist *changes;   // (body_count): of velocities
    int8_t *sides;    // (row_count): -1 and 1 where λ is at the lower and at the upper bound, else 0
    bool *wrong;      // (row_count): still on the wrong side
    int wrong_count;
} Solution;

// Whether a system has the pattern of a layout.
bool has_layout(const System *system, Layout layout);

// Return the system of rows, in memory of an arena.
System system_of(Arena *arena, Layout layout);

// Begin a sub-step, with the masses of now: all has to be factored anew.
void begin_system(System *system, const Inverse *inverses);

Solution solution_for(const System *system, Arena *arena);

// J v of a link.
static inline double link_rate(Jacobian jacobian, Ends ends, const Twist *velocities) {
    Twist a = velocities[ends.a], b = velocities[ends.b];
    return dot(jacobian.a.v, a.v) + jacobian.a.w * a.w + dot(jacobian.b.v, b.v) + jacobian.b.w * b.w;
}

// Add Jᵀ λ of a link to momenta [N s, N m s].
static inline void add_momenta(Jacobian jacobian, Ends ends, double impulse, Twist *momenta) {
    Twist *a = momenta + ends.a, *b = momenta + ends.b;
    a->v = add(a->v, scaled(jacobian.a.v, impulse));
    a->w += jacobian.a.w * impulse;
    b->v = add(b->v, scaled(jacobian.b.v, impulse));
    b->w += jacobian.b.w * impulse;
}

// J v of a row.
static inline double row_rate(const System *system, const Jacobian *jacobians, int row, const Twist *velocities) {
    double sum = link_rate(jacobians[row], system->ends[row], velocities);
    for (int link = system->further[row]; link < system->further[row + 1]; link++) {
        sum += link_rate(jacobians[link], system->ends[link], velocities);
    }
    return sum;
}

// Add Jᵀ λ of a row to momenta [N s, N m s].
static inline void add_row_momenta(const System *system, const Jacobian *jacobians, int row, double impulse,
                                   Twist *momenta) {
    add_momenta(jacobians[row], system->ends[row], impulse, momenta);
    for (int link = system->further[row]; link < system->further[row + 1]; link++) {
        add_momenta(jacobians[link], system->ends[link], impulse, momenta);
    }
}

// Return u M v of two changes of velocities [J].
double mass_product(const System *system, const Twist *u, const Twist *v);

// What the softness of a row is a share of [1/kg, 1/(kg m²)]: J M⁻¹ Jᵀ as if the row acted at the centres of mass, so
// that rows between the same bodies are equally soft, and share a load that statics leaves open equally.
double softness_unit(Jacobian jacobian, Inverse a, Inverse b);
// The sum of those of the links of a row.
double row_softness_unit(const System *system, const Jacobian *jacobians, int row);

// Set J and E of a row in the matrix; without `jacobians` J is 0.
void set_row(System *system, int row, const Jacobian *jacobians, double stiffness);

// Solve the factored system for λ of active rows, given the momenta that the others bring; NULL is none.
void solve_with(System *system, const int8_t *sides, const double *wanted, const Twist *momenta, double *impulses,
                Twist *changes);

// Solve active rows with the factors of the last solution: λ of the others is 0.
void solve_active(System *system, const int8_t *sides, const double *wanted, double *impulses, Twist *changes);

#endif
