// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Reports of joints on a step: the impulses of their parts, how far apart they still are, and which broke.

#include "joint_parts.h"
#include "joint_rows.h"
#include "saddle_point.h"
#include "stages.h"

// An unstepped joint has come together where its rows are no more than this out of their bounds [m, rad]: ten times the
// slop of limits.
static const double drawn_apart = 1e-3;
// The least speed at which it is drawn together [m/s, rad/s], a quarter of the greatest (`joint_positions.c`): a joint
// that comes nearer more slowly is held apart by others.
static const double drawn_least = 5.0;

static double joint_impulse(const World *world, const Joint *joint) {
    double most = 0.0;
    for (int number = 0; number < joint->part_count; number++) {
        most = greatest(most, length(world->parts[joint->first_part + number].total));
    }
    return most;
}

// The point of an anchor in the world [m].
static Vec world_point(const cpBody *body, Vec anchor) {
    return add(body->p, rotated(anchor, rotation(body->a)));
}

// The unit vector from the first anchor of a constraint to the second.
static Vec between(const cpConstraint *constraint, Vec at_a, Vec at_b) {
    Vec apart = sub(world_point(constraint->b, at_b), world_point(constraint->a, at_a));
    double distance = length(apart);
    return distance > 0.0 ? scaled(apart, 1.0 / distance) : vec(0.0, 0.0);
}

// The unit vector along which a constraint about an axis acts on the second body of its joint.
//
// Pin and limit have the bodies of the joint the other way round, and their anchors are put anew in each step, so
// that their lines are taken from the axis. Chipmunk turns the normal of a limit round at the lesser distance.
static Vec by_axis(const World *world, const Joint *joint, const Part *part) {
    const cpBody *a = world->bodies[joint->a].engine, *b = world->bodies[joint->b].engine;
    Vec axis = rotated(vec(joint->axis[0], joint->axis[1]), rotation(b->a));
    if (part->kind == PART_PIN) {
        return negated(perpendicular(axis));
    }
    if (part->kind == PART_DRIVE) {
        return negated(axis);
    }
    const cpSlideJoint *limit = (cpSlideJoint *)part->constraint;
    Vec at_a = world_point(a, vec(joint->anchor_a[0], joint->anchor_a[1]));
    // From the point beyond the upper limit, the anchor lies against the axis.
    double distance = dot(sub(at_a, world_point(b, limit->anchorA)), axis);
    bool at_lesser = 2.0 * fabs(distance) < limit->min + limit->max;
    return at_lesser == (distance > 0.0) ? axis : negated(axis);
}

// Whether a part acts along a line: that of a rod, a rope, a spring, a limit or a drive.
static bool is_axial(const Part *part) {
    return part->kind == PART_PIN || part->kind == PART_SLIDE || part->kind == PART_SPRING || part->kind == PART_ROPE ||
           part->kind == PART_DRIVE;
}

// The unit vector along which a rope with guides comes to its second end.
static Vec by_path(const World *world, const Joint *joint) {
    const Row *row = world->rows + joint->first_row + joint->row_count - 1;
    int span = row->guide_count - 2;
    const Guide *guide = world->guides + row->first_guide + span;
    Pose a = pose_of(world->bodies[guide[0].body].engine), b = pose_of(world->bodies[guide[1].body].engine);
    Jacobian jacobian;
    span_at(row, world->guides, span, a, b, &jacobian);
    return jacobian.b.v;
}

// The unit vector along which an axial part pushes the second body of its joint.
static Vec line_of(const World *world, const Joint *joint, const Part *part) {
    if (part->kind == PART_ROPE) {
        return by_path(world, joint);
    }
    // The anchors of all other kinds lie in the same place.
    const cpPinJoint *axial = (cpPinJoint *)part->constraint;
    bool by_line = joint->has_axis || part->kind == PART_DRIVE;
    return by_line ? by_axis(world, joint, part) : between(part->constraint, axial->anchorA, axial->anchorB);
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

// Return x of a row.
static double x_of_row(const World *world, const Joint *joint, const Row *row) {
    Pose a = pose_of(world->bodies[joint->a].engine), b = pose_of(world->bodies[joint->b].engine);
    const Guide *guide = world->guides + row->first_guide;
    Jacobian jacobian;
    double x = row->offset;
    if (row->kind == ROW_PATH) {
        for (int span = 0; span < row->guide_count - 1; span++, guide++) {
            a = pose_of(world->bodies[guide[0].body].engine);
            b = pose_of(world->bodies[guide[1].body].engine);
            x += span_at(row, world->guides, span, a, b, &jacobian);
        }
        return x;
    }
    Anchors anchors = anchors_at(joint, a, b);
    x += row_at(row, joint, &anchors, a, b, &jacobian);
    return row->guide_count == 0 ? x : x + carrier_at(joint, pose_of(world->bodies[guide->body].engine), &jacobian);
}

// How far the row of a joint that is furthest out of its bounds is out of them [m, rad].
static double apart_by(const World *world, const Joint *joint) {
    double most = 0.0;
    for (const Row *row = world->rows + joint->first_row, *end = row + joint->row_count; row < end; row++) {
        double x = x_of_row(world, joint, row);
        most = greatest(most, row->law == LAW_BOUNDS ? greatest(x - row->upper, row->lower - x) : 0.0);
    }
    return most;
}

void measure_drawn_joints(World *world) {
    for (int number = 0; number < world->joint_count; number++) {
        Joint *joint = world->joints + number;
        double apart = joint->unstepped ? apart_by(world, joint) : 0.0;
        joint->apart = apart > drawn_apart ? apart : 0.0;
    }
}

// Whether an unstepped joint has come nearer in the step, and is still apart.
static bool is_drawn(const World *world, const Joint *joint) {
    double apart = apart_by(world, joint);
    return apart > drawn_apart && joint->apart - apart > drawn_least * (double)SUB_STEPS * world->dt;
}

void find_broken(World *world) {
    world->has_broken = false;
    for (int number = 0; number < world->joint_count; number++) {
        Joint *joint = world->joints + number;
        // The first step of a joint takes back the half-step lead of a body that was in free flight: that impulse is no
        // load.
        joint->broken = !joint->unstepped && joint->most < INFINITY && joint_impulse(world, joint) > joint->most;
        joint->unstepped = joint->unstepped && is_drawn(world, joint);
        world->has_broken = world->has_broken || joint->broken;
    }
}
