// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// A contact that begins in this sub-step, read from Chipmunk and written to it.

#include "touch.h"
#include "contact.h"

Touch touch_of(cpArbiter *arbiter) {
    assert(arbiter->count > 0);
    Touch touch = {.arbiter = arbiter,
                   .shapes = {arbiter->a, arbiter->b},
                   .engines = {arbiter->body_a, arbiter->body_b},
                   .count = arbiter->count,
                   .normal = arbiter->n};
    for (int point = 0; point < 2; point++) {
        // Where there is but one, it stands for both.
        const cpContact *contact = arbiter->contacts + (point < arbiter->count ? point : 0);
        touch.points[point][0] = add(arbiter->body_a->p, contact->r1);
        touch.points[point][1] = add(arbiter->body_b->p, contact->r2);
    }
    return touch;
}

void write_touch(const Touch *touch) {
    touch->arbiter->n = touch->normal;
    touch->arbiter->count = touch->count;
    for (int point = 0; point < touch->count; point++) {
        touch->arbiter->contacts[point].r1 = sub(touch->points[point][0], touch->engines[0]->p);
        touch->arbiter->contacts[point].r2 = sub(touch->points[point][1], touch->engines[1]->p);
    }
}

double face_depth(const Touch *touch, int side, int face) {
    const cpShape *other = touch->shapes[1 - side];
    Corner corner = corner_in_world(touch->shapes[side], face);
    double nearest = INFINITY;
    for (int number = 0; number < corner_count(other); number++) {
        nearest = least(nearest, dot(corner.normal, corner_in_world(other, number).point));
    }
    return dot(corner.normal, corner.point) - nearest + radius_of(other) + radius_of(touch->shapes[side]);
}

void prepare_contact(cpArbiter *arbiter) {
    const cpBody *a = arbiter->body_a, *b = arbiter->body_b;
    Vec normal = arbiter->n, tangent = perpendicular(normal);
    double mass = a->m_inv + b->m_inv;
    for (int number = 0; number < arbiter->count; number++) {
        cpContact *point = arbiter->contacts + number;
        double an = cross(point->r1, normal), bn = cross(point->r2, normal);
        double at = cross(point->r1, tangent), bt = cross(point->r2, tangent);
        point->nMass = 1.0 / (mass + a->i_inv * an * an + b->i_inv * bn * bn);
        point->tMass = 1.0 / (mass + a->i_inv * at * at + b->i_inv * bt * bt);
        point->bounce = dot(parting_velocity(point, true_twist(a), true_twist(b)), normal) * arbiter->e;
    }
}
