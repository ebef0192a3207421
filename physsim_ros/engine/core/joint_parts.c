// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The constraints that a joint consists of in Chipmunk: what they need before a sub-step, and where their impulses are.

#include "joint_parts.h"
#include "joint_rows.h"
#include "stages.h"

// Length of the arm with which a pin pulls a slider across its line [m]; any will do.
static const double across_arm = 1.0;
// The constraint of a slider that limits its travel, after those across its line and of its turn.
enum { LIMIT_PART = 2 };

double *impulse_at(const Part *part, int component) {
    switch (part->kind) {
    case PART_PIVOT: {
        cpPivotJoint *pivot = (cpPivotJoint *)part->constraint;
        return component == 0 ? &pivot->jAcc.x : &pivot->jAcc.y;
    }
    case PART_PIN:
        return &((cpPinJoint *)part->constraint)->jnAcc;
    case PART_SLIDE:
        return &((cpSlideJoint *)part->constraint)->jnAcc;
    case PART_GEAR:
        return &((cpGearJoint *)part->constraint)->jAcc;
    case PART_ROTARY_LIMIT:
        return &((cpRotaryLimitJoint *)part->constraint)->jAcc;
    case PART_MOTOR:
    case PART_OWN:
    case PART_ROPE:
    case PART_DRIVE:
        return &((cpSimpleMotor *)part->constraint)->jAcc;
    default:
        assert(part->kind == PART_SPRING);
        return &((cpDampedSpring *)part->constraint)->jAcc;
    }
}

Vec impulse_of_part(const Part *part) {
    return vec(*impulse_at(part, 0), part->kind == PART_PIVOT ? *impulse_at(part, 1) : 0.0);
}

// Put the point from which a limit measures on the axis through the first anchor, as far along it as it was, so that it
// acts along the axis however far the anchor is off its line.
static void put_on_axis(const Joint *joint, const Anchors *anchors, cpSlideJoint *limit) {
    Vec axis = joint->axis, across = perpendicular(axis);
    Vec second = joint->anchor_b;
    double along = dot(axis, sub(limit->anchorA, second));
    double beside = dot(across, rotated_back(anchors->offset, anchors->of_b));
    limit->anchorA = add(second, add(scaled(axis, along), scaled(across, beside)));
}

void prepare_parts(World *world) {
    for (int number = 0; number < world->joint_count; number++) {
        const Joint *joint = world->joints + number;
        // A slider that is locked has a pivot instead.
        if (!joint->has_axis || joint->part_count == 0 || world->parts[joint->first_part].kind != PART_PIN) {
            continue;
        }
        cpPinJoint *pin = (cpPinJoint *)world->parts[joint->first_part].constraint;
        Pose a = pose_after(world->bodies[joint->a].engine, world->dt);
        Pose b = pose_after(world->bodies[joint->b].engine, world->dt);
        Anchors anchors = anchors_at(joint, a, b);
        Vec across = perpendicular(anchors.axis);
        Vec beside = sub(add(anchors.arm_b, anchors.offset), scaled(across, across_arm));
        pin->anchorA = rotated_back(beside, anchors.of_b);
        const Part *limit = world->parts + joint->first_part + LIMIT_PART;
        if (joint->part_count > LIMIT_PART && limit->kind == PART_SLIDE) {
            put_on_axis(joint, &anchors, (cpSlideJoint *)limit->constraint);
        }
    }
}

void core_read_impulses(const World *world, cpVect *impulses) {
    for (int number = 0; number < world->part_count; number++) {
        impulses[number] = impulse_of_part(world->parts + number);
    }
}

void core_write_impulses(World *world, const cpVect *impulses) {
    for (int number = 0; number < world->part_count; number++) {
        const Part *part = world->parts + number;
        *impulse_at(part, 0) = impulses[number].x;
        if (part->kind == PART_PIVOT) {
            *impulse_at(part, 1) = impulses[number].y;
        }
    }
}
