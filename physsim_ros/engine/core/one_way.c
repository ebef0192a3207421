// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// One-way bodies: others pass them in one direction, and are borne where they come against it.
//
// Problem: a jump leads up through a platform, a chute lets things out and none in.
// Method: a contact bears where its normal leads in the direction in which others pass, or across it where the sides
// are closed, and where the other body was outside as the sub-step began, within the slop of contacts; else Chipmunk
// ignores it (Godot: one-way collision with a margin; Box2D and Chipmunk leave it to a callback). A contact that has
// borne a load in the step before bears on, however deep that has pressed it. So nothing outlives a step but the
// impulses of contacts, which checkpoints have.
// Continuous collision stops a fast body only where it comes from above all of a one-way body.
// Cost: 1 ns a contact, 20 ns one of a one-way body.

#include "one_way.h"
#include "outline.h"

// The cosine of the angle from the direction that others pass in, up to which a contact is on top of a body: 78°.
static const double least_rise = 0.2;

static bool is_one_way(const Body *body) {
    return body->one_way.x != 0.0 || body->one_way.y != 0.0;
}

// Whether the other body was outside as the sub-step began, or is borne already.
static bool holds_out(const World *world, const cpArbiter *arbiter) {
    double nearest = INFINITY;
    bool borne = false;
    for (int number = 0; number < arbiter->count; number++) {
        const cpContact *point = arbiter->contacts + number;
        const cpBody *a = arbiter->body_a, *b = arbiter->body_b;
        Vec apart = sub(add(b->p, point->r2), add(a->p, point->r1));
        Vec velocity = sub(velocity_at(twist_of(b), point->r2), velocity_at(twist_of(a), point->r1));
        double approach = greatest(-dot(velocity, arbiter->n), 0.0);
        nearest = least(nearest, dot(apart, arbiter->n) + approach * world->dt);
        borne = borne || point->jnAcc > 0.0;
    }
    return borne || nearest >= -slop_of(arbiter);
}

// Whether the contact of a one-way body is on a side that is closed; the normal leads out of it.
static bool is_closed(const Body *body, Vec normal) {
    double rise = dot(normal, rotated(body->one_way, rotation(body->engine->a)));
    return rise > least_rise || (body->closed_sides && rise >= -least_rise);
}

bool passes(const World *world, const cpArbiter *arbiter) {
    const Body *a = body_of(arbiter->body_a), *b = body_of(arbiter->body_b);
    if (!is_one_way(a) && !is_one_way(b)) {
        return false;
    }
    bool closed = (!is_one_way(a) || is_closed(a, arbiter->n)) && (!is_one_way(b) || is_closed(b, negated(arbiter->n)));
    return !closed || !holds_out(world, arbiter);
}

// The furthest that a body reaches in a direction [m].
static double reach_along(const Body *body, Pose pose, Vec direction) {
    Vec on_body = rotated_back(direction, rotation(pose.yaw));
    double furthest = -INFINITY;
    for (const cpShape *shape = body->engine->shapeList; shape != NULL; shape = shape->next) {
        for (int number = 0; number < corner_count(shape); number++) {
            double reach = dot(corner_on_body(shape, number).place, on_body) + radius_of(shape);
            furthest = greatest(furthest, reach);
        }
    }
    return furthest + dot(pose.p, direction);
}

bool is_passed(const Body *body, Pose pose, const Body *other, Pose other_pose, Vec way) {
    if (!is_one_way(body)) {
        return false;
    }
    Vec up = rotated(body->one_way, rotation(pose.yaw));
    double lowest = -reach_along(other, other_pose, negated(up));
    return dot(way, up) >= 0.0 || lowest < reach_along(body, pose, up) - least(body->slop, other->slop);
}
