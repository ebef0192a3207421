// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Bounces of islands of joints.
//
// Problem: without bounces the energy of an island can only fall; a contact that has to leave at some velocity, while
// joints hold its bodies, can make it rise.
// Method: the island has the greatest share of its bounces with which its impulses do no work. After an impact motors
// press on for the rest of the step, as weights do (`rest_of_step.c`).
// Cost: none without bounces; with them two solutions, and two more where motors drive.
// Without it law 17 (balls on rods between elastic walls) fails.

#include "joint_bounces.h"

// The work of the impulses of a solution [J].
//
// Velocities are relative to the surfaces that touch: the work that a kinematic body, a conveyor does is not counted.
// Chipmunk measures the approach before gravity and springs act on it, so that it may have been as fast as `bounce`.
static double work_of(const Solve *solve, const VelocityRows *rows, const Solution *solution) {
    const Island *island = solve->island;
    double work = 0.0;
    for (int row = 0; row < island->joint_row_count; row++) {
        double before = rows->rates[row];
        double after = before + row_rate(&solve->system, solve->jacobians, row, solution->changes);
        // A spring gives back what it has taken, and a drive gives energy.
        bool bounds = island->rows[row]->law == LAW_BOUNDS;
        work += bounds ? solution->impulses[row] * (before + after) / 2.0 : 0.0;
    }
    for (int number = 0; number < island->bearing_count; number++) {
        int left = normal_row(island, number), right = tangent_row(island, number);
        double friction = island->bearings[number].friction;
        double along = solution->impulses[left] + solution->impulses[right];
        double across = friction * (solution->impulses[left] - solution->impulses[right]);
        double before = (rows->rates[left] + rows->rates[right]) / 2.0;
        double after = before + link_rate(solve->jacobians[left], island->ends[left], solution->changes);
        double slip = rows->free_slips[number];
        double slip_after = slip + link_rate(solve->jacobians[right], island->ends[right], solution->changes);
        before = rows->bounce[number] > 0.0 ? least(before, -rows->bounce[number]) : before;
        work += along * (before + after) / 2.0 + across * (slip + slip_after) / 2.0;
    }
    return work;
}

// Mix two solutions, with and without bounces, so that the impulses do no work; it meets the bounds of both, which are
// convex. Work is a quadratic function of the share: bend share² + slope share + lost. Targets become what it reaches.
static void mix(const Solve *solve, VelocityRows *rows, Solution *elastic, const Solution *plastic, double gained,
                double lost) {
    const Island *island = solve->island;
    for (int body = 0; body < island->body_count; body++) {
        elastic->changes[body] = twist_plus(elastic->changes[body], plastic->changes[body], -1.0);
    }
    double bend = mass_product(&solve->system, elastic->changes, elastic->changes) / 2.0;
    lost = least(lost, 0.0);
    double slope = gained - lost - bend;
    double share = -2.0 * lost / greatest(slope + sqrt(slope * slope - 4.0 * bend * lost), 1e-300);
    for (int body = 0; body < island->body_count; body++) {
        elastic->changes[body] = twist_plus(plastic->changes[body], elastic->changes[body], share);
    }
    for (int row = 0; row < island->row_count; row++) {
        double difference = elastic->impulses[row] - plastic->impulses[row];
        elastic->impulses[row] = plastic->impulses[row] + difference * share;
        elastic->sides[row] = plastic->sides[row];
    }
    for (int row = island->joint_row_count; row < island->row_count; row++) {
        double reached = row_rate(&solve->system, rows->jacobians, row, elastic->changes);
        rows->wanted[row] = elastic->impulses[row] > 0.0 ? reached : rows->wanted[row];
    }
}

// Whether a contact is an impact after which its bodies part.
static bool bounces_off(const Island *island, const VelocityRows *rows, int number) {
    return island->bearings[number].remaining > 0.0 && rows->bounce[number] > 0.0;
}

// Whether a row is driven by a force that has a bound.
static bool is_bounded_drive(const Row *row) {
    return is_of_rate(row) && row->most < INFINITY;
}

// Whether there are both impacts and bounded drives.
static bool is_driven_in_impact(const Island *island, const VelocityRows *rows) {
    bool bounces = false, driven = false;
    for (int number = 0; number < island->bearing_count; number++) {
        bounces = bounces || bounces_off(island, rows, number);
    }
    for (int row = 0; row < island->joint_row_count; row++) {
        driven = driven || is_bounded_drive(island->rows[row]);
    }
    return bounces && driven;
}

// Have motors press bodies on each other for the rest of the step after an impact, as weights do (`rest_of_step.c`).
//
// A bounded force does nothing in the instant of an impact; from then on it acts on the velocities after that. The
// parting velocity changes by the difference of two solutions: of the impact without motors, and of motors with its
// impulses. A light finger that a motor presses on a body would bounce without end.
static void press_on(Solve *solve, VelocityRows *rows) {
    const Island *island = solve->island;
    if (!is_driven_in_impact(island, rows)) {
        return;
    }
    VelocityRows hit = copy_of_rows(solve, rows), after = copy_of_rows(solve, rows);
    for (int row = 0; row < island->joint_row_count; row++) {
        if (is_bounded_drive(island->rows[row])) {
            hit.lower[row] = hit.upper[row] = 0.0;
        }
    }
    Solution impact = solve_with_bounce(solve, &hit, rows->bounce);
    for (int number = 0; number < island->bearing_count; number++) {
        if (bounces_off(island, rows, number)) {
            int left = normal_row(island, number), right = tangent_row(island, number);
            after.lower[left] = after.upper[left] = impact.impulses[left];
            after.lower[right] = after.upper[right] = impact.impulses[right];
        }
    }
    Solution pressed = solve_with_bounce(solve, &after, rows->bounce);
    for (int number = 0; number < island->bearing_count; number++) {
        if (bounces_off(island, rows, number)) {
            Jacobian jacobian = solve->jacobians[normal_row(island, number)];
            Ends ends = island->ends[normal_row(island, number)];
            double gained = link_rate(jacobian, ends, pressed.changes) - link_rate(jacobian, ends, impact.changes);
            double share = island->bearings[number].remaining / solve->dt + 0.5;
            rows->bounce[number] = greatest(rows->bounce[number] + gained * share, 0.0);
        }
    }
}

Solution solve_bounces(Solve *solve, VelocityRows *rows) {
    press_on(solve, rows);
    Solution solution = solve_with_bounce(solve, rows, rows->bounce);
    bool bounces = false;
    double *none = TAKE(solve->arena, double, solve->island->bearing_count);
    for (int number = 0; number < solve->island->bearing_count; number++) {
        bounces = bounces || rows->bounce[number] > 0.0;
    }
    double gained = bounces ? work_of(solve, rows, &solution) : 0.0;
    if (gained > 0.0) {
        Solution plastic = solve_with_bounce(solve, rows, none);
        mix(solve, rows, &solution, &plastic, gained, work_of(solve, rows, &plastic));
    }
    return solution;
}
