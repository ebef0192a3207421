// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Constraint rows of joints: each kind returns a number x of the poses of two bodies, and its Jacobian J = dx/dq.
//
// Poses are those of the centres of mass.
// Source: E. Catto, "Modeling and Solving Constraints", GDC 2009.
//
// A rope leaves a wheel along a tangent. Where a row begins or ends at a wheel, the rope does not slip on it, and its
// path has the length that the wheel has wound up; a wheel between them lets it slide.

#include "joint_rows.h"

Anchors anchors_turned(const Joint *joint, Vec a, Rotation of_a, Vec b, Rotation of_b) {
    Anchors anchors = {.of_b = of_b};
    anchors.arm_a = rotated(joint->anchor_a, of_a);
    anchors.arm_b = rotated(joint->anchor_b, of_b);
    anchors.offset = sub(add(a, anchors.arm_a), add(b, anchors.arm_b));
    anchors.axis = rotated(joint->axis, of_b);
    return anchors;
}

Anchors anchors_at(const Joint *joint, Pose a, Pose b) {
    return anchors_turned(joint, a.p, rotation(a.yaw), b.p, rotation(b.yaw));
}

Jacobian line_jacobian(Vec direction, Vec arm_a, Vec arm_b) {
    return (Jacobian){{direction, cross(arm_a, direction)}, {negated(direction), -cross(arm_b, direction)}};
}

// x = direction . (p_a - p_b), where the direction turns with the second body, as a line that reaches from it to where
// the first anchor is.
static double position_on_line(Vec direction, const Anchors *anchors, Jacobian *jacobian) {
    *jacobian = line_jacobian(direction, anchors->arm_a, add(anchors->arm_b, anchors->offset));
    return dot(direction, anchors->offset);
}

// x of the first link of a row that is no path, and its Jacobian.
static double first_link_at(const Row *row, const Anchors *anchors, Pose a, Pose b, Jacobian *jacobian) {
    switch (row->kind) {
    case ROW_X:
        *jacobian = line_jacobian(vec(1.0, 0.0), anchors->arm_a, anchors->arm_b);
        return anchors->offset.x;
    case ROW_Y:
        *jacobian = line_jacobian(vec(0.0, 1.0), anchors->arm_a, anchors->arm_b);
        return anchors->offset.y;
    case ROW_ANGLE:
        *jacobian = (Jacobian){{{0.0, 0.0}, -1.0}, {{0.0, 0.0}, row->ratio}};
        return row->ratio * b.yaw - a.yaw;
    case ROW_DISTANCE: {
        // Anchors on each other have no direction; any one parts them.
        Vec direction = unit_or(anchors->offset, vec(1.0, 0.0));
        *jacobian = line_jacobian(direction, anchors->arm_a, anchors->arm_b);
        return length(anchors->offset);
    }
    case ROW_ACROSS:
        return position_on_line(perpendicular(anchors->axis), anchors, jacobian);
    case ROW_ROLL: {
        double x = position_on_line(anchors->axis, anchors, jacobian);
        jacobian->a.w += row->ratio;
        jacobian->b.w -= row->ratio;
        return x + row->ratio * (a.yaw - b.yaw);
    }
    default:
        assert(row->kind == ROW_ALONG);
        return position_on_line(anchors->axis, anchors, jacobian);
    }
}

// What a carrier adds to x of a gear that turns about it, and its Jacobian.
static double carrier_at(const Row *row, Pose carrier, Jacobian *jacobian) {
    // ratio (yaw_b - yaw_c) - (yaw_a - yaw_c), of which the first link has the rest.
    *jacobian = (Jacobian){.a = {.w = 1.0 - row->ratio}};
    return (1.0 - row->ratio) * carrier.yaw;
}

// The direction of a rope from one guide to the next, along their common tangent, and its length.
static Vec tangent_between(Vec from, double radius, Vec to, double other_radius, double *span) {
    Vec apart = sub(to, from);
    double distance = length(apart), across = radius - other_radius;
    if (distance <= fabs(across)) {
        // Wheels that lie in each other have no common tangent.
        *span = 0.0;
        return unit_or(apart, vec(1.0, 0.0));
    }
    *span = sqrt(distance * distance - across * across);
    return rotated(scaled(apart, 1.0 / distance), (Rotation){*span / distance, across / distance});
}

// What a span of a rope, from the guide of a number to the next one, adds to the length of its path, and its Jacobian.
static double span_at(const Row *row, const Guide *guides, int number, Pose a, Pose b, Jacobian *jacobian) {
    const Guide *from = guides + row->first_guide + number, *to = from + 1;
    Vec arm_a = rotated(from->anchor, rotation(a.yaw)), arm_b = rotated(to->anchor, rotation(b.yaw));
    double span = 0.0;
    Vec along_rope = tangent_between(add(a.p, arm_a), from->radius, add(b.p, arm_b), to->radius, &span);
    Vec outward = negated(perpendicular(along_rope));
    arm_a = add(arm_a, scaled(outward, from->radius));
    arm_b = add(arm_b, scaled(outward, to->radius));
    *jacobian = line_jacobian(negated(along_rope), arm_a, arm_b);
    double heading = atan2(along_rope.y, along_rope.x);
    double x = span;
    x += from->radius * remainder(heading - from->heading_out, full_turn);
    x -= to->radius * remainder(heading - to->heading_in, full_turn);
    x -= number == 0 ? from->radius * (a.yaw - from->yaw) : 0.0;
    x += number == row->guide_count - 2 ? to->radius * (b.yaw - to->yaw) : 0.0;
    return x;
}

double row_at(const Row *row, const Guide *guides, const Anchors *anchors, Links links, Jacobian *jacobians) {
    bool is_path = row->kind == ROW_PATH;
    double x = row->offset;
    for (int number = 0; number <= further_count(row); number++) {
        int link = number == 0 ? links.first : links.further + number - 1;
        Pose a = links.poses[links.ends[link].a], b = links.poses[links.ends[link].b];
        if (is_path) {
            x += span_at(row, guides, number, a, b, jacobians + link);
        } else {
            x += number == 0 ? first_link_at(row, anchors, a, b, jacobians + link)
                             : carrier_at(row, a, jacobians + link);
        }
    }
    return x;
}

double row_after(const World *world, const Joint *joint, const Row *row, double lapse, Jacobian *last) {
    Arena *arena = &world->own->arena;
    size_t mark = arena_mark(arena);
    int link_count = 1 + further_count(row), first_guide = row->kind == ROW_PATH ? 0 : 2;
    int count = first_guide + row->guide_count;
    Pose *poses = TAKE(arena, Pose, count);
    for (int number = 0; number < count; number++) {
        int place = number >= first_guide ? world->guides[row->first_guide + number - first_guide].body
                    : number == 0         ? joint->a
                                          : joint->b;
        poses[number] = pose_after(world->bodies[place].engine, lapse);
    }
    Ends *ends = TAKE(arena, Ends, link_count);
    Jacobian *jacobians = TAKE(arena, Jacobian, link_count);
    for (int link = 0; link < link_count; link++) {
        ends[link] = row->kind == ROW_PATH ? (Ends){link, link + 1} : (Ends){2 * link, link == 0 ? 1 : 2};
    }
    Anchors anchors = row->kind == ROW_PATH ? (Anchors){0} : anchors_at(joint, poses[0], poses[1]);
    double x = row_at(row, world->guides, &anchors, (Links){0, 1, ends, poses}, jacobians);
    *last = jacobians[link_count - 1];
    arena_release(arena, mark);
    return x;
}
