// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Constraint rows of joints: each kind returns a number x of the poses of two bodies, and its Jacobian J = dx/dq.
//
// Poses are those of the centres of mass. The excess C of a row is how far x lies outside of its bounds [m, rad].
// Source: E. Catto, "Modeling and Solving Constraints", GDC 2009.

#include "joint_rows.h"

Anchors anchors_at(const Joint *joint, Pose a, Pose b) {
    Anchors anchors = {.of_b = rotation(b.yaw)};
    anchors.arm_a = rotated(vec(joint->anchor_a[0], joint->anchor_a[1]), rotation(a.yaw));
    anchors.arm_b = rotated(vec(joint->anchor_b[0], joint->anchor_b[1]), anchors.of_b);
    anchors.apart = sub(add(a.p, anchors.arm_a), add(b.p, anchors.arm_b));
    return anchors;
}

Jacobian along(Vec direction, Vec arm_a, Vec arm_b) {
    return (Jacobian){{direction, cross(arm_a, direction)}, {negated(direction), -cross(arm_b, direction)}};
}

// x = direction . (p_a - p_b), where the direction turns with the second body, as a line that reaches from it to where
// the first anchor is.
static double place_on_line(Vec direction, const Anchors *anchors, Jacobian *jacobian) {
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
    case ROW_SPIN:
        *jacobian = (Jacobian){{{0.0, 0.0}, -1.0}, {{0.0, 0.0}, joint->ratio}};
        return joint->ratio * b.yaw - a.yaw;
    case ROW_DISTANCE:
    case ROW_SPRING: {
        double distance = length(anchors->apart);
        // Anchors on each other have no direction; any one parts them.
        Vec direction = distance > 0.0 ? scaled(anchors->apart, 1.0 / distance) : vec(1.0, 0.0);
        *jacobian = along(direction, anchors->arm_a, anchors->arm_b);
        return distance;
    }
    case ROW_ACROSS:
        return place_on_line(perpendicular(rotated(axis, anchors->of_b)), anchors, jacobian);
    default:
        assert(row->kind == ROW_ALONG || row->kind == ROW_WAY);
        return place_on_line(rotated(axis, anchors->of_b), anchors, jacobian);
    }
}
