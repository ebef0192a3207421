// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Rows of jointed bodies in velocities: those of joints, and of the contacts of an island with friction.
//
// Problem: Chipmunk bounds friction by the normal impulse of its iteration, which is wrong where joints load a
// contact, and a solution of normals and friction in turn lets the floor pull.
// Method: joints, normals and friction are one problem. In two dimensions the friction cone of a contact has two edges,
// so that Coulomb friction is two rows with λ >= 0 (Anitescu, "Optimization-based simulation of nonsmooth rigid
// multibody dynamics", Mathematical Programming 105, 2006). A contact that slides by v would lift by μ |v|; its target
// is lowered by that, until v is what the solution has (De Saxcé and Feng, "The bipotential method", Mathematical and
// Computer Modelling 28, 1998). Load that statics does not determine stays where it was: each contact is drawn to its
// impulse of the sub-step before (proximal point method: Rockafellar, SIAM Journal on Control and Optimization 14,
// 1976). `docs/decisions/joint_friction.md` has what else was tried.
//
// Springs: those with a damper, and those that are too stiff for the sub-step (`joints/stiffness.py`), are soft rows:
// the impulse of the sub-step is -dt (k x + c v), x the strain before it and v the velocity after it (implicit Euler of
// the damper; Catto, "Soft Constraints", GDC 2011), with all loads and joints that act.
// Cost: that of `joint_solver.c`.

#include "velocity_rows.h"
#include "contact.h"
#include "mixed_lcp.h"
#include <string.h>

// E, as a share of `softness_unit`. Of joints it keeps the impulses of those that contradict each other from being of
// any size. Of contacts it draws λ to that of the sub-step before; a belt of 75 links is solved with a third of the
// factorisations that 1e-4 needs.
static const double joint_softness = 1e-6, contact_softness = 1e-2;
// Refinements of a solution against E where contacts are soft. The curvature brings one more.
enum { REFINEMENTS = 2 };
// Solutions whose targets follow the slips, at most.
enum { PASSES = 8 };
// Share of the normal impulse below which an impulse along an edge is rounding.
static const double rounding_of_edges = 1e-9;
// Slips that are solved as rest: contacts lift by less than μ times that [m/s]. Light links of a loaded rope tremble
// by some 0.1 mm/s.
static const double least_slip = 1e-3;
// Difference of slips that needs no further solution, in m/s and as a share of the slip.
static const double slip_error = 1e-4, slip_share = 1e-3;
// Share of its rate that a damper takes in a sub-step, at least: the row of a spring without one is soft by this, and
// swings on for a million seconds.
static const double least_damping = 1e-9;

static double damping_of(const Solve *solve, int row) {
    double unit = row_softness_unit(&solve->system, solve->jacobians, row);
    return greatest(solve->island->rows[row]->damping, least_damping / (solve->dt * unit));
}

static double softness_of(const Solve *solve, int row) {
    const Row *of_joint = solve->island->rows[row];
    if (of_joint->law != LAW_SPRING) {
        return joint_softness;
    }
    double unit = row_softness_unit(&solve->system, solve->jacobians, row);
    return 1.0 / (solve->dt * damping_of(solve, row) * unit);
}

// The impulses along the two edges of a cone, by those along and across its normal.
typedef struct Edges {
    double left, right;
} Edges;

static Edges edges_of(double friction, double normal, double tangent) {
    double across = friction > 0.0 ? tangent / friction : normal;
    // Rounding leaves no impulse on the edge that a contact does not slide along.
    double least_edge = rounding_of_edges * normal, left = (normal + across) / 2.0, right = (normal - across) / 2.0;
    return (Edges){left > least_edge ? left : 0.0, right > least_edge ? right : 0.0};
}

static Jacobian edge_jacobian(Jacobian normal, Jacobian tangent, double share) {
    return (Jacobian){twist_plus(normal.a, tangent.a, share), twist_plus(normal.b, tangent.b, share)};
}

// λ of the sub-step before.
static double *last_impulses(const Solve *solve) {
    const Island *island = solve->island;
    double *last = TAKE(solve->arena, double, island->row_count);
    for (int row = 0; row < island->joint_row_count; row++) {
        last[row] = island->last[row] * factor_of(island->rows[row], solve->excess[row]);
    }
    for (int number = 0; number < island->bearing_count; number++) {
        double along = island->last[normal_row(island, number)], across = island->last[tangent_row(island, number)];
        Edges edges = edges_of(island->bearings[number].friction, along, across);
        last[normal_row(island, number)] = edges.left;
        last[tangent_row(island, number)] = edges.right;
    }
    return last;
}

static void begin_joints(const Solve *solve, VelocityRows *rows, double *soft) {
    const Island *island = solve->island;
    memcpy(rows->jacobians, solve->jacobians, (size_t)solve->system.link_count * sizeof(Jacobian));
    for (int row = 0; row < island->joint_row_count; row++) {
        const Row *of_joint = island->rows[row];
        rows->lower[row] = greatest(lower_bound(of_joint, true, solve->excess[row]), -of_joint->most);
        rows->upper[row] = least(upper_bound(of_joint, true, solve->excess[row]), of_joint->most);
        soft[row] = softness_of(solve, row);
    }
}

// The rows of contacts. A slip begins as that of the sub-step before, less what friction can stop: where rest is
// possible, it is found.
static void begin_contacts(const Solve *solve, VelocityRows *rows, double *soft, double *prior, const Twist *without) {
    const Island *island = solve->island;
    for (int number = 0; number < island->bearing_count; number++) {
        const Bearing *bearing = island->bearings + number;
        int left = normal_row(island, number), right = tangent_row(island, number);
        Ends ends = island->ends[left];
        Jacobian along = solve->jacobians[left], across = solve->jacobians[right];
        rows->jacobians[left] = edge_jacobian(along, across, bearing->friction);
        rows->jacobians[right] = edge_jacobian(along, across, -bearing->friction);
        rows->upper[left] = is_deferred(bearing->point) ? 0.0 : INFINITY;
        rows->upper[right] = bearing->friction > 0.0 ? rows->upper[left] : 0.0;
        soft[left] = soft[right] = contact_softness;
        prior[left] = rows->last[left];
        prior[right] = rows->last[right];
        rows->free_slips[number] = link_rate(across, ends, without) + bearing->slide;
        Twist begun[] = {body_of(island->engine[ends.a])->own->twist, body_of(island->engine[ends.b])->own->twist};
        // Restitution is of approaches. Chipmunk permits bodies that part to approach by e times that velocity, so that
        // an elastic contact under a load trembles.
        rows->bounce[number] = greatest(-bearing->point->bounce, 0.0);
        double unit = softness_unit(across, island->inverses[ends.a], island->inverses[ends.b]);
        double stopped = unit * bearing->friction * (prior[left] + prior[right]);
        rows->slips[number] = greatest(fabs(link_rate(across, (Ends){0, 1}, begun) + bearing->slide) - stopped, 0.0);
    }
}

VelocityRows velocity_rows(Solve *solve, const Twist *without) {
    const Island *island = solve->island;
    Arena *arena = solve->arena;
    VelocityRows rows = {.jacobians = TAKE(arena, Jacobian, solve->system.link_count),
                         .wanted = TAKE(arena, double, island->row_count),
                         .lower = TAKE(arena, double, island->row_count),
                         .upper = TAKE(arena, double, island->row_count),
                         .rates = TAKE(arena, double, island->row_count),
                         .last = last_impulses(solve),
                         .bounce = TAKE(arena, double, island->bearing_count),
                         .free_slips = TAKE(arena, double, island->bearing_count),
                         .slips = TAKE(arena, double, island->bearing_count)};
    double *soft = TAKE(arena, double, island->row_count), *prior = TAKE(arena, double, island->row_count);
    begin_joints(solve, &rows, soft);
    begin_contacts(solve, &rows, soft, prior, without);
    for (int row = 0; row < island->row_count; row++) {
        rows.rates[row] = row_rate(&solve->system, rows.jacobians, row, without);
    }
    rows.problem = (Problem){rows.jacobians, rows.wanted, rows.lower, rows.upper, soft, prior, solve->springs};
    return rows;
}

// Aim at the targets of joints, and at those of contacts that slide by `slips`.
static void set_targets(const Solve *solve, VelocityRows *rows, const double *bounce) {
    const Island *island = solve->island;
    for (int row = 0; row < island->joint_row_count; row++) {
        const Row *of_joint = island->rows[row];
        double pull = solve->springs[row] ? of_joint->stiffness * solve->excess[row] / damping_of(solve, row) : 0.0;
        rows->wanted[row] = bound_rate(of_joint) - pull - rows->rates[row];
    }
    for (int number = 0; number < island->bearing_count; number++) {
        const Bearing *bearing = island->bearings + number;
        double least_rate = bounce[number] - bearing->friction * rows->slips[number];
        double slide = bearing->friction * bearing->slide;
        rows->wanted[normal_row(island, number)] = least_rate - slide - rows->rates[normal_row(island, number)];
        rows->wanted[tangent_row(island, number)] = least_rate + slide - rows->rates[tangent_row(island, number)];
    }
}

// Take slips from a solution; return whether targets change by it.
static bool update_slips(const Solve *solve, VelocityRows *rows, const Solution *solution) {
    const Island *island = solve->island;
    bool changed = false;
    for (int number = 0; number < island->bearing_count; number++) {
        Ends ends = island->ends[tangent_row(island, number)];
        double change = link_rate(solve->jacobians[tangent_row(island, number)], ends, solution->changes);
        double slip = fabs(rows->free_slips[number] + change);
        slip = slip < least_slip ? 0.0 : slip;
        changed = changed || fabs(slip - rows->slips[number]) > slip_error + slip_share * slip;
        rows->slips[number] = slip;
    }
    return changed;
}

// Guess the sides of rows: of joints by λ of the sub-step before, of contacts by the impulses that Chipmunk found,
// since a body that rattles on a machine touches it in every other sub-step.
static void guess_sides(const Solve *solve, const VelocityRows *rows, int8_t *sides) {
    const Island *island = solve->island;
    for (int row = 0; row < island->joint_row_count; row++) {
        sides[row] = side_by_guess(rows->last[row], rows->lower[row], rows->upper[row]);
    }
    for (int number = 0; number < island->bearing_count; number++) {
        const Bearing *bearing = island->bearings + number;
        int left = normal_row(island, number), right = tangent_row(island, number);
        Edges edges = edges_of(bearing->friction, bearing->point->jnAcc, bearing->point->jtAcc);
        sides[left] = side_by_guess(edges.left, rows->lower[left], rows->upper[left]);
        sides[right] = side_by_guess(edges.right, rows->lower[right], rows->upper[right]);
    }
}

Solution solve_with_bounce(Solve *solve, VelocityRows *rows, const double *bounce) {
    Solution solution = solution_for(&solve->system, solve->arena);
    guess_sides(solve, rows, solution.sides);
    set_targets(solve, rows, bounce);
    solve_problem(&solve->system, &rows->problem, &solution, solve->arena);
    for (int pass = 1; pass < PASSES && update_slips(solve, rows, &solution); pass++) {
        set_targets(solve, rows, bounce);
        solve_again(&solve->system, &rows->problem, &solution, solve->arena);
    }
    for (int number = 0; number < (solve->island->bearing_count > 0 ? REFINEMENTS : 0); number++) {
        refine(&solve->system, &rows->problem, &solution, solve->arena);
    }
    return solution;
}

VelocityRows copy_of_rows(const Solve *solve, const VelocityRows *rows) {
    const Island *island = solve->island;
    VelocityRows copy = *rows;
    copy.slips = TAKE(solve->arena, double, island->bearing_count);
    copy.lower = TAKE(solve->arena, double, island->row_count);
    copy.upper = TAKE(solve->arena, double, island->row_count);
    memcpy(copy.slips, rows->slips, (size_t)island->bearing_count * sizeof(double));
    memcpy(copy.lower, rows->lower, (size_t)island->row_count * sizeof(double));
    memcpy(copy.upper, rows->upper, (size_t)island->row_count * sizeof(double));
    copy.problem.lower = copy.lower;
    copy.problem.upper = copy.upper;
    return copy;
}
