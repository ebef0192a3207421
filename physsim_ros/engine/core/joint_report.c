// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Reports of joints on a step: the impulses of their parts, how far apart they still are, and which broke.

#include "island_solve.h"
#include "joint_parts.h"
#include "stages.h"

// Slops of limits by which the rows of an unstepped joint that has come together are out of their bounds, at most.
static const double drawn_slops = 10.0;
// Share of the fastest correction below which an unstepped joint is held apart by others.
static const double least_drawn = 0.25;

static double joint_impulse(const World *world, const Joint *joint) {
    double most = 0.0;
    for (int number = 0; number < joint->part_count; number++) {
        most = greatest(most, length(world->parts[joint->first_part + number].total));
    }
    return most;
}

// Whether a part acts along a line: that of a rod, a rope, a spring, a limit or a drive.
static bool is_axial(const Part *part) {
    return part->kind == PART_PIN || part->kind == PART_SLIDE || part->kind == PART_SPRING || part->kind == PART_ROPE ||
           part->kind == PART_DRIVE;
}

// The vector by which the impulse that Chipmunk stores of an axial part acts on the second body of its joint.
static Vec line_of(const World *world, const Joint *joint, const Part *part) {
    // The row that a spring would have, where Chipmunk alone solves it.
    static const Row distance = {.kind = ROW_DISTANCE, .below = 1.0, .above = 1.0};
    const Row *row = world->rows + joint->first_row, *end = row + joint->row_count;
    while (row < end && row->part != part - world->parts) {
        row++;
    }
    row = row < end ? row : &distance;
    Jacobian jacobian;
    double x = row_after(world, joint, row, 0.0, &jacobian);
    return scaled(jacobian.b.v, factor_of(row, excess_of(row, x)));
}

static bool is_linear(const Part *part) {
    return part->kind == PART_PIVOT || is_axial(part);
}

// An impulse of a part on the second body of its joint; of one that acts on the turn of the bodies, the first number.
static Vec pull_of(const World *world, const Joint *joint, const Part *part, Vec impulse) {
    impulse = is_axial(part) ? scaled(line_of(world, joint, part), impulse.x) : impulse;
    const Body *a = world->bodies + joint->a, *b = world->bodies + joint->b;
    return is_linear(part) ? scaled(impulse, reported_share(a, b, impulse)) : impulse;
}

void clear_joint_reports(World *world) {
    for (int number = 0; number < world->part_count; number++) {
        world->parts[number].total = vec(0.0, 0.0);
    }
}

void report_joint_impulses(World *world) {
    for (int number = 0; number < world->joint_count; number++) {
        const Joint *joint = world->joints + number;
        for (Part *part = world->parts + joint->first_part, *end = part + joint->part_count; part < end; part++) {
            part->closing = vec(0.0, 0.0);
            part->total = add(part->total, pull_of(world, joint, part, impulse_of_part(part)));
        }
    }
}

void report_joint_closings(World *world) {
    for (int number = 0; number < world->joint_count; number++) {
        const Joint *joint = world->joints + number;
        for (Part *part = world->parts + joint->first_part, *end = part + joint->part_count; part < end; part++) {
            part->total = add(part->total, pull_of(world, joint, part, part->closing));
        }
    }
}

void core_read_joints(const World *world, double *impulses, cpVect *pulls, uint8_t *pressing) {
    for (int number = 0; number < world->joint_count; number++) {
        const Joint *joint = world->joints + number;
        impulses[number] = joint_impulse(world, joint);
        const Part *first = world->parts + joint->first_part;
        pulls[number] = vec(0.0, 0.0);
        for (const Part *part = first; part < first + joint->part_count; part++) {
            pulls[number] = is_linear(part) ? add(pulls[number], part->total) : pulls[number];
        }
        pressing[number] =
            joint->presses && joint->part_count > 0 && dot(first->total, line_of(world, joint, first)) > 0.0;
    }
}

// How far the row of a joint that is furthest out of its bounds is out of them [m, rad].
static double greatest_excess(const World *world, const Joint *joint) {
    double most = 0.0;
    for (const Row *row = world->rows + joint->first_row, *end = row + joint->row_count; row < end; row++) {
        Jacobian jacobian;
        double excess = excess_of(row, row_after(world, joint, row, 0.0, &jacobian));
        most = greatest(most, row->law == LAW_BOUNDS ? fabs(excess) : 0.0);
    }
    return most;
}

void measure_drawn_joints(World *world) {
    for (int number = 0; number < world->joint_count; number++) {
        Joint *joint = world->joints + number;
        double excess = joint->unstepped ? greatest_excess(world, joint) : 0.0;
        joint->excess = excess > drawn_slops * limit_slop ? excess : 0.0;
    }
}

// Whether an unstepped joint has come nearer in the step, and is still apart.
static bool is_drawn(const World *world, const Joint *joint) {
    double excess = greatest_excess(world, joint);
    return excess > drawn_slops * limit_slop &&
           joint->excess - excess > least_drawn * fastest_correction * (double)SUB_STEPS * world->dt;
}

void find_broken_joints(World *world) {
    for (int number = 0; number < world->joint_count; number++) {
        Joint *joint = world->joints + number;
        // The first step of a joint takes back the half-step lead of a body that was in free flight: that impulse is no
        // load.
        joint->broken = !joint->unstepped && joint->most < INFINITY && joint_impulse(world, joint) > joint->most;
        joint->unstepped = joint->unstepped && is_drawn(world, joint);
        world->has_broken = world->has_broken || joint->broken;
    }
}
