// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Velocities of jointed bodies.
//
// Problem: ten iterations of Chipmunk leave velocities that do not keep to the rows of an island.
// Method: the impulses that Chipmunk gave to the rows are taken back, and all are found together
// (`velocity_rows.c`), with the bounces of contacts (`joint_bounces.c`).
//
// Curvature: a point on a circle leaves its tangent in half a sub-step, so that rows are solved for
// J v = - dt / 2 (dJ/dt) v, as SHAKE has it (Ryckaert, Ciccotti and Berendsen, J. Comput. Phys. 23, 1977); without that
// a pendulum loses (w dt)² / 2 of its energy in a sub-step. An island gets no more energy by this than its rows take
// from the velocities with which the sub-step began: those of a point that follows its circle are half a sub-step
// behind it, and pay for it; those of a taut straight chain, whose rows are singular, get no energy. A limit that
// holds, as a taut rope does, also gets the curvature term if that loads it more.
// Cost: that of `joint_solver.c`.

#include "joint_bounces.h"
#include "mixed_lcp.h"
#include "stages.h"

// Velocities without the impulses that Chipmunk gave to the rows.
static void take_back(const Solve *solve, Twist *without) {
    const Island *island = solve->island;
    for (int row = 0; row < island->joint_row_count; row++) {
        double impulse = *island->impulses[row] * factor_of(island->rows[row], solve->excess[row]);
        add_row_momenta(&solve->system, solve->jacobians, row, -impulse, without);
    }
    for (int number = 0; number < island->bearing_count; number++) {
        const cpContact *point = island->bearings[number].point;
        Ends ends = island->ends[normal_row(island, number)];
        add_momenta(solve->jacobians[normal_row(island, number)], ends, -point->jnAcc, without);
        add_momenta(solve->jacobians[tangent_row(island, number)], ends, -point->jtAcc, without);
    }
    for (int body = 0; body < island->body_count; body++) {
        Inverse inverse = island->inverses[body];
        without[body].v = add(solve->velocities[body].v, scaled(without[body].v, inverse.mass));
        without[body].w = solve->velocities[body].w + without[body].w * inverse.moment;
    }
}

// Return the velocities by which the rates of the rows that hold in a solution change, whose factors the system has.
static Twist *changed_by(Solve *solve, const Solution *solution, const double *rates) {
    Twist *changes = TAKE(solve->arena, Twist, solve->island->body_count);
    double *impulses = TAKE(solve->arena, double, solve->island->row_count);
    solve_active(&solve->system, solution->sides, rates, impulses, changes);
    return changes;
}

// Twice the energy of that [J].
static double energy_of(Solve *solve, const Solution *solution, const double *rates) {
    Twist *changes = changed_by(solve, solution, rates);
    return mass_product(&solve->system, changes, changes);
}

// Add the impulses of the curvature to a solution; λ stay within their bounds.
static void bend(Solve *solve, VelocityRows *rows, Solution *solution, Twist *velocities) {
    const Island *island = solve->island;
    Arena *arena = solve->arena;
    Twist *begun = TAKE(arena, Twist, island->body_count), *straight = TAKE(arena, Twist, island->body_count);
    Pose *halfway = TAKE(arena, Pose, island->body_count);
    for (int body = 0; body < island->body_count; body++) {
        straight[body] = twist_plus(velocities[body], solution->changes[body], 1.0);
        halfway[body] = moved(solve->poses[body], straight[body], solve->dt / 2.0);
        begun[body] = body_of(island->engine[body])->own->twist;
    }
    double *excess = TAKE(arena, double, island->joint_row_count);
    Jacobian *jacobians = TAKE(arena, Jacobian, solve->system.link_count);
    read_rows(island, halfway, excess, jacobians);
    double *before = TAKE(arena, double, island->row_count), *bent = TAKE(arena, double, island->row_count);
    for (int row = 0; row < island->joint_row_count; row++) {
        double more = row_rate(&solve->system, solve->jacobians, row, straight) -
                      row_rate(&solve->system, jacobians, row, straight);
        bool pressed_on = !is_of_rate(island->rows[row]) && solve->excess[row] * more < 0.0;
        if (solution->sides[row] == 0 && (is_equality(island->rows[row]) || pressed_on)) {
            before[row] = bound_rate(island->rows[row]) - row_rate(&solve->system, solve->jacobians, row, begun);
            bent[row] = more;
        }
    }
    double taken = energy_of(solve, solution, before), given = energy_of(solve, solution, bent);
    double share = sqrt(paid_share(taken, given));
    for (int row = 0; row < island->joint_row_count; row++) {
        rows->wanted[row] += bent[row] * share;
    }
    refine(&solve->system, &rows->problem, solution, arena);
    for (int body = 0; body < island->body_count; body++) {
        velocities[body] = twist_plus(velocities[body], solution->changes[body], 1.0);
    }
}

// Find the displacements in the rest of the sub-step since impacts (`rest_of_step.c`). The rows of an impact get the
// difference of velocities that their bodies have by it; what holds beside them holds on these displacements, too.
static void find_rest_of_step(Solve *solve, const VelocityRows *rows, const Solution *solution,
                              const Twist *velocities) {
    const Island *island = solve->island;
    double *wanted = TAKE(solve->arena, double, island->row_count);
    bool late = false;
    for (int number = 0; number < island->bearing_count; number++) {
        double remaining = island->bearings[number].remaining;
        Ends ends = island->ends[normal_row(island, number)];
        Twist displacements[] = {
            displacement_gained(body_of(island->engine[ends.a]), velocities[ends.a], remaining, solve->dt),
            displacement_gained(body_of(island->engine[ends.b]), velocities[ends.b], remaining, solve->dt)};
        wanted[normal_row(island, number)] =
            link_rate(rows->jacobians[normal_row(island, number)], (Ends){0, 1}, displacements);
        wanted[tangent_row(island, number)] =
            link_rate(rows->jacobians[tangent_row(island, number)], (Ends){0, 1}, displacements);
        late = late || remaining > 0.0;
    }
    if (late) {
        Twist *gained = changed_by(solve, solution, wanted);
        for (int number = 0; number < island->body_count; number++) {
            set_remaining_move(body_of(island->engine[number]), gained[number]);
        }
    }
}

static void write_impulses(Solve *solve, const Solution *solution) {
    const Island *island = solve->island;
    for (int row = 0; row < island->joint_row_count; row++) {
        *island->impulses[row] = solution->impulses[row] / factor_of(island->rows[row], solve->excess[row]);
    }
    for (int number = 0; number < island->bearing_count; number++) {
        double left = solution->impulses[normal_row(island, number)],
               right = solution->impulses[tangent_row(island, number)];
        island->bearings[number].point->jnAcc = left + right;
        island->bearings[number].point->jtAcc = island->bearings[number].friction * (left - right);
    }
}

// A joint of which a row has reached its greatest force does not hold; one that drives or springs holds all the same.
static void find_yielded(Solve *solve, const Solution *solution) {
    const Island *island = solve->island;
    int last = 0;
    for (int first = 0; first < island->joint_row_count; first = last) {
        bool yields = false;
        // Rows of a joint follow one another.
        for (; last < island->joint_row_count && island->joint_of_row[last] == island->joint_of_row[first]; last++) {
            const Row *row = island->rows[last];
            yields = yields || (row->law == LAW_BOUNDS && fabs(solution->impulses[last]) >= row->most);
        }
        for (int row = first; row < last && yields; row++) {
            solve->holds[row] = false;
        }
    }
}

void solve_velocities(Solve *solve) {
    const Island *island = solve->island;
    size_t mark = arena_mark(solve->arena);
    Twist *velocities = TAKE(solve->arena, Twist, island->body_count);
    take_back(solve, velocities);
    VelocityRows rows = velocity_rows(solve, velocities);
    Solution solution = solve_bounces(solve, &rows);
    bend(solve, &rows, &solution, velocities);
    find_rest_of_step(solve, &rows, &solution, velocities);
    for (int body = 0; body < island->body_count; body++) {
        velocities[body] = twist_plus(velocities[body], solve->velocities[body], -1.0);
    }
    change_velocities(solve, velocities, 1.0);
    write_impulses(solve, &solution);
    find_yielded(solve, &solution);
    arena_release(solve->arena, mark);
}
