// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Constraint rows of joints: each kind returns a number x of the poses of two bodies, and its Jacobian J = dx/dq.
//
// Poses are those of the centres of mass. The excess C of a row is how far x lies outside of its bounds [m, rad].
// Source: E. Catto, "Modeling and Solving Constraints", GDC 2009.

// A rope leaves a wheel along a tangent. Where a row begins or ends at a wheel, the rope does not slip on it, and its
// path has the length that the wheel has wound up; a wheel between them lets it slide.

#include "joint_rows.h"

Anchors anchors_turned(const Joint *joint, Vec a, Rotation of_a, Vec b, Rotation of_b) {
    Anchors anchors = {.of_b = of_b};
    anchors.arm_a = rotated(vec(joint->anchor_a[0], joint->anchor_a[1]), of_a);
    anchors.arm_b = rotated(vec(joint->anchor_b[0], joint->anchor_b[1]), of_b);
    anchors.apart = sub(add(a, anchors.arm_a), add(b, anchors.arm_b));
    return anchors;
}

Anchors anchors_at(const Joint *joint, Pose a, Pose b) {
    return anchors_turned(joint, a.p, rotation(a.yaw), b.p, rotation(b.yaw));
}

Jacobian along(Vec direction, Vec arm_a, Vec arm_b) {
    return (Jacobian){{direction, cross(arm_a, direction)}, {negated(direction), -cross(arm_b, direction)}};
}

// x = direction . (p_a - p_b), where the direction turns with the second body, as a line that reaches from it to where
// the first anchor is.
static double position_on_line(Vec direction, const Anchors *anchors, Jacobian *jacobian) {
    *jacobian = along(direction, anchors->arm_a, add(anchors->arm_b, anchors->apart));
    return dot(direction, anchors->apart);
}

double row_at(const Row *row, const Joint *joint, const Anchors *anchors, Pose a, Pose b, Jacobian *jacobian) {
    Vec axis = vec(joint->axis[0], joint->axis[1]);
    switch (row->kind) {
    case ROW_X:
        *jacobian = along(vec(1.0, 0.0), anchors->arm_a, anchors->arm_b);
        return anchors->apart.x;
    case ROW_Y:
        *jacobian = along(vec(0.0, 1.0), anchors->arm_a, anchors->arm_b);
        return anchors->apart.y;
    case ROW_ANGLE:
        *jacobian = (Jacobian){{{0.0, 0.0}, -1.0}, {{0.0, 0.0}, joint->ratio}};
        return joint->ratio * b.yaw - a.yaw;
    case ROW_DISTANCE: {
        double distance = length(anchors->apart);
        // Anchors on each other have no direction; any one parts them.
        Vec direction = distance > 0.0 ? scaled(anchors->apart, 1.0 / distance) : vec(1.0, 0.0);
        *jacobian = along(direction, anchors->arm_a, anchors->arm_b);
        return distance;
    }
    case ROW_ACROSS:
        return position_on_line(perpendicular(rotated(axis, anchors->of_b)), anchors, jacobian);
    case ROW_ROLL: {
        double x = position_on_line(rotated(axis, anchors->of_b), anchors, jacobian);
        jacobian->a.w += joint->ratio;
        jacobian->b.w -= joint->ratio;
        return x + joint->ratio * (a.yaw - b.yaw);
    }
    default:
        assert(row->kind == ROW_ALONG);
        return position_on_line(rotated(axis, anchors->of_b), anchors, jacobian);
    }
}

double carrier_at(const Joint *joint, Pose carrier, Jacobian *jacobian) {
    // ratio (yaw_b - yaw_c) - (yaw_a - yaw_c), of which `row_at` has the rest.
    *jacobian = (Jacobian){.a = {.w = 1.0 - joint->ratio}};
    return (1.0 - joint->ratio) * carrier.yaw;
}

// The direction of a rope from one guide to the next, along their common tangent, and its length.
static Vec tangent_between(Vec from, double radius, Vec to, double other_radius, double *span) {
    Vec apart = sub(to, from);
    double distance = length(apart), across = radius - other_radius;
    if (distance <= fabs(across)) {
        // Wheels that lie in each other have no common tangent.
        *span = 0.0;
        return distance > 0.0 ? scaled(apart, 1.0 / distance) : vec(1.0, 0.0);
    }
    *span = sqrt(distance * distance - across * across);
    return rotated(scaled(apart, 1.0 / distance), (Rotation){*span / distance, across / distance});
}

double span_at(const Row *row, const Guide *guides, int number, Pose a, Pose b, Jacobian *jacobian) {
    const Guide *from = guides + row->first_guide + number, *to = from + 1;
    Vec arm_a = rotated(from->anchor, rotation(a.yaw)), arm_b = rotated(to->anchor, rotation(b.yaw));
    double span = 0.0;
    Vec along_rope = tangent_between(add(a.p, arm_a), from->radius, add(b.p, arm_b), to->radius, &span);
    Vec outward = negated(perpendicular(along_rope));
    arm_a = add(arm_a, scaled(outward, from->radius));
    arm_b = add(arm_b, scaled(outward, to->radius));
    *jacobian = along(negated(along_rope), arm_a, arm_b);
    double heading = atan2(along_rope.y, along_rope.x);
    double x = span;
    x += from->radius * remainder(heading - from->heading_out, full_turn);
    x -= to->radius * remainder(heading - to->heading_in, full_turn);
    x -= number == 0 ? from->radius * (a.yaw - from->yaw) : 0.0;
    x += number == row->guide_count - 2 ? to->radius * (b.yaw - to->yaw) : 0.0;
    return x;
}
