// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Contacts of discs are those of their impact.
//
// Problem: Chipmunk finds a contact where the step ends, in which the line of centres has turned since the impact.
// Method: the displacement of a disc in the step, as the other body sees it, is a line. Where a circle of its radius
// first meets the other shape on that (Ericson, "Real-Time Collision Detection", 5.5.7), the contact gets the normal
// and the arms of that moment.
// Scope: pairs that overlap where the step begins keep those of Chipmunk, and so do polygons among themselves, and
// segments, of which it knows the neighbours in a chain.
// Cost, and what fails without it: `first_touch.c`.

#include "touch_stages.h"

// Where a disc first meets a shape on a straight line.
typedef struct DiscHit {
    double share; // of the displacement; infinite for never
    Vec normal;   // of the shape
    bool on_face;
} DiscHit;

// Where a shape was as the step began, where it would end freely, and where it is.
typedef struct Moments {
    Vec begin, end, now;
    double begin_yaw, end_yaw, now_yaw;
} Moments;

static Moments moments_of(const World *world, const Touch *touch, int side) {
    const cpShape *shape = touch->shapes[side];
    const Body *body = body_of(touch->engines[side]);
    bool is_disc = kind_of(shape) == SHAPE_CIRCLE;
    Vec offset = is_disc ? ((const cpCircleShape *)shape)->c : vec(0.0, 0.0);
    Pose poses[3] = {body->scratch.begin, moved(body->scratch.begin, body->scratch.twist, world->dt),
                     pose_of(touch->engines[side])};
    Vec points[3];
    for (int number = 0; number < 3; number++) {
        points[number] = add(poses[number].p, rotated(offset, rotation(poses[number].yaw)));
    }
    // That a disc turns does not matter.
    double counts = is_disc ? 0.0 : 1.0;
    return (Moments){
        points[0], points[1], points[2], poses[0].yaw * counts, poses[1].yaw * counts, poses[2].yaw * counts};
}

static void keep_first(DiscHit *hit, DiscHit other) {
    if (other.share >= 0.0 && other.share <= 1.0 && other.share < hit->share) {
        *hit = other;
    }
}

// Where a circle first meets a shape, on a displacement from `start` that both see from the shape.
static DiscHit first_hit(Vec start, Vec displacement, const cpShape *shape, double radius) {
    DiscHit hit = {.share = INFINITY};
    int count = corner_count(shape);
    // Faces, moved outwards by the radius: t of n . (ahead + displacement t) = r, between their corners.
    for (int number = 0; number < count && count > 1; number++) {
        Corner corner = corner_in_world(shape, number);
        Vec edge = sub(corner_in_world(shape, (number + count - 1) % count).point, corner.point);
        Vec ahead = sub(start, corner.point);
        double height = dot(corner.normal, ahead) - radius, share = height / -dot(corner.normal, displacement);
        double beside = cross(corner.normal, add(ahead, scaled(displacement, share)));
        if (height >= 0.0 && beside <= 0.0 && beside >= cross(corner.normal, edge)) {
            keep_first(&hit, (DiscHit){share, corner.normal, true});
        }
    }
    // Corners: t of |ahead + displacement t| = r.
    for (int number = 0; number < count; number++) {
        Vec ahead = sub(start, corner_in_world(shape, number).point);
        double a = dot(displacement, displacement), b = dot(ahead, displacement);
        double share = (-b - sqrt(b * b - a * (dot(ahead, ahead) - radius * radius))) / a;
        keep_first(&hit, (DiscHit){share, scaled(add(ahead, scaled(displacement, share)), 1.0 / radius), false});
    }
    return hit;
}

// By how far two bodies can have approached in the step, at most [m].
static double approach_in_step(const World *world, const Touch *touch) {
    double distance = 0.0;
    for (int side = 0; side < 2; side++) {
        Vec arm = sub(touch->points[0][side], touch->engines[side]->p);
        distance += length(touch->engines[side]->v) + fabs(touch->engines[side]->w) * length(arm);
    }
    return distance * world->dt;
}

void move_to_impact(const World *world, Touch *touch) {
    // Chipmunk has the disc first. Pairs that are deeper than they can have approached overlapped before.
    if (kind_of(touch->shapes[0]) != SHAPE_CIRCLE || -distance_of(touch, 0) > approach_in_step(world, touch)) {
        return;
    }
    Moments disc = moments_of(world, touch, 0), other = moments_of(world, touch, 1);
    double radius = radius_of(touch->shapes[0]);
    // The displacement of the disc in the frame that the other shape has where the step ends.
    Vec start = rotated(sub(disc.begin, other.begin), rotation(other.now_yaw - other.begin_yaw));
    Vec stop = rotated(sub(disc.end, other.end), rotation(other.now_yaw - other.end_yaw));
    Vec displacement = sub(stop, start);
    start = add(other.now, start);
    DiscHit hit = first_hit(start, displacement, touch->shapes[1], radius + radius_of(touch->shapes[1]));
    if (!(hit.share > 0.0 && hit.share <= 1.0)) {
        return;
    }
    touch->met = hit.share;
    touch->on_face = hit.on_face;
    if (kind_of(touch->shapes[1]) == SHAPE_SEGMENT) {
        return;
    }
    Vec on_other = sub(add(start, scaled(displacement, hit.share)), scaled(hit.normal, radius));
    // To the yaw of the impact.
    double yaw = other.begin_yaw + (other.end_yaw - other.begin_yaw) * hit.share;
    Rotation turn = rotation(yaw - other.now_yaw);
    Vec outwards = rotated(hit.normal, turn);
    touch->normal = negated(outwards);
    for (int point = 0; point < 2; point++) {
        touch->points[point][0] = sub(disc.now, scaled(outwards, radius));
        touch->points[point][1] = add(other.now, rotated(sub(on_other, other.now), turn));
    }
}
