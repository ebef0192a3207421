// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Contacts are those of the impact.
//
// Problem: Chipmunk finds a contact where the sub-step ends. Until then the line of centres of two discs has turned,
// and a corner has come in by v dt: through the side of a tile, or so far that a face overlaps several tiles.
// Method: a disc is a corner that is rounded by its radius. The displacement of a corner in the sub-step, as the other
// body sees it, is a line. The contact gets normal and arms of the moment at which a corner of one shape first meets
// the other on that (Ericson, "Real-Time Collision Detection", 5.5.7).
// Scope: pairs that overlap where the sub-step begins keep those of Chipmunk. So do polygons that meet by faces, and
// those that approach slowly; and segments, of which Chipmunk knows the neighbours in a chain.
// Cost, and what fails without it: `first_touch.c`.

#include "contact.h"
#include "touch_stages.h"

// The slope up to which faces meet by two points [1]: by one, a box that falls flat on a stack would turn.
static const double slope_of_faces = 0.02;

// Where a corner first meets a shape on a straight line.
typedef struct CornerHit {
    double share; // of the displacement; infinite for never
    Vec normal;   // of the shape
    bool on_face;
} CornerHit;

// Where a disc, or else the body of a shape, was as the sub-step began, where it would be freely as it ends, and where
// it is. That a disc turns does not matter.
typedef struct Moments {
    Vec begin, end, now;
    double begin_yaw, end_yaw, now_yaw;
} Moments;

// The first impact of two shapes in the sub-step.
typedef struct FirstImpact {
    CornerHit hit;
    int side;   // of the shape whose corner meets the other one
    Vec corner; // in the frame of `Moments`
    Vec point;  // of it, where the other shape has the yaw and point of now
} FirstImpact;

static Moments moments_of(const World *world, const Touch *touch, int side) {
    const cpShape *shape = touch->shapes[side];
    const Body *body = body_of(touch->engines[side]);
    bool is_disc = kind_of(shape) == SHAPE_CIRCLE;
    Vec offset = is_disc ? ((const cpCircleShape *)shape)->c : vec(0.0, 0.0);
    Pose poses[3] = {body->own->begin, moved(body->own->begin, body->own->twist, world->dt),
                     pose_of(touch->engines[side])};
    Vec points[3];
    for (int number = 0; number < 3; number++) {
        points[number] = add(poses[number].p, rotated(offset, rotation(poses[number].yaw)));
    }
    double counts = is_disc ? 0.0 : 1.0;
    return (Moments){
        points[0], points[1], points[2], poses[0].yaw * counts, poses[1].yaw * counts, poses[2].yaw * counts};
}

static double yaw_then(const Moments *moments, double share) {
    return moments->begin_yaw + (moments->end_yaw - moments->begin_yaw) * share;
}

static void keep_first(CornerHit *hit, CornerHit other) {
    if (other.share >= 0.0 && other.share <= 1.0 && other.share < hit->share) {
        *hit = other;
    }
}

// Where a circle first meets a shape, on a displacement from `start` that both see from the shape.
static CornerHit first_hit(Vec start, Vec displacement, const cpShape *shape, double radius) {
    CornerHit hit = {.share = INFINITY};
    int count = corner_count(shape);
    // Faces, moved outwards by the radius: t of n . (ahead + displacement t) = r, between their corners.
    for (int number = 0; number < count && count > 1; number++) {
        Corner corner = corner_in_world(shape, number);
        Vec edge = sub(corner_in_world(shape, (number + count - 1) % count).point, corner.point);
        Vec ahead = sub(start, corner.point);
        double height = dot(corner.normal, ahead) - radius, share = height / -dot(corner.normal, displacement);
        double beside = cross(corner.normal, add(ahead, scaled(displacement, share)));
        if (height >= 0.0 && beside <= 0.0 && beside >= cross(corner.normal, edge)) {
            keep_first(&hit, (CornerHit){share, corner.normal, true});
        }
    }
    // Corners: t of |ahead + displacement t| = r. Two that are not rounded meet by no normal.
    for (int number = 0; number < count && radius > 0.0; number++) {
        Vec ahead = sub(start, corner_in_world(shape, number).point);
        double a = dot(displacement, displacement), b = dot(ahead, displacement);
        double share = (-b - sqrt(b * b - a * (dot(ahead, ahead) - radius * radius))) / a;
        keep_first(&hit, (CornerHit){share, scaled(add(ahead, scaled(displacement, share)), 1.0 / radius), false});
    }
    return hit;
}

// By how far two bodies can have approached in the sub-step, at most [m].
static double approach_in_step(const World *world, const Touch *touch) {
    double distance = 0.0;
    for (int side = 0; side < 2; side++) {
        Vec arm = sub(touch->points[0][side], touch->engines[side]->p);
        distance += length(touch->engines[side]->v) + fabs(touch->engines[side]->w) * length(arm);
    }
    return distance * world->dt;
}

// Whether a point is within a distance of the box of a shape.
static bool lies_near(const cpShape *shape, Vec point, double distance) {
    const double *box = shape->bb;
    return point.x > box[0] - distance && point.x < box[2] + distance && point.y > box[1] - distance &&
           point.y < box[3] + distance;
}

// Keep the first impact of the corners of one shape, if it comes before another one.
static void keep_first_impact(const Touch *touch, const Moments *moments, int side, FirstImpact *first) {
    const cpShape *shape = touch->shapes[side], *struck = touch->shapes[1 - side];
    const Moments *own = moments + side, *other = moments + 1 - side;
    Rotation at_begin = rotation(own->begin_yaw), at_end = rotation(own->end_yaw);
    Rotation from_begin = rotation(other->now_yaw - other->begin_yaw),
             from_end = rotation(other->now_yaw - other->end_yaw);
    double radius = radius_of(shape) + radius_of(struck);
    for (int number = 0; number < corner_count(shape); number++) {
        Vec corner = kind_of(shape) == SHAPE_CIRCLE ? vec(0.0, 0.0) : corner_on_body(shape, number).point;
        // The displacement of the corner in the frame that the other shape has where the sub-step ends.
        Vec start = rotated(sub(add(own->begin, rotated(corner, at_begin)), other->begin), from_begin);
        Vec stop = rotated(sub(add(own->end, rotated(corner, at_end)), other->end), from_end);
        Vec displacement = sub(stop, start);
        start = add(other->now, start);
        if (!lies_near(struck, start, length(displacement) + radius)) {
            continue;
        }
        CornerHit hit = first_hit(start, displacement, struck, radius);
        if (hit.share > 0.0 && hit.share < first->hit.share) {
            *first = (FirstImpact){hit, side, corner, add(start, scaled(displacement, hit.share))};
        }
    }
}

// Whether two polygons meet by a corner, and fast.
static bool meet_by_corner(const Touch *touch) {
    if (kind_of(touch->shapes[0]) != SHAPE_POLYGON || kind_of(touch->shapes[1]) != SHAPE_POLYGON) {
        return false;
    }
    double width = length(sub(touch->points[1][0], touch->points[0][0]));
    double tilt = fabs(distance_of(touch, 1) - distance_of(touch, 0));
    bool by_faces = touch->count == 2 && tilt < slope_of_faces * width;
    return !by_faces && approach_of(touch->arbiter) > slowest_impact;
}

// Give a contact the normal and the arms of an impact.
static void set_impact(Touch *touch, const Moments *moments, const FirstImpact *first) {
    const Moments *own = moments + first->side, *other = moments + 1 - first->side;
    double radius = radius_of(touch->shapes[first->side]), share = first->hit.share;
    Vec arm = rotated(first->corner, rotation(yaw_then(own, share)));
    Vec on_other = sub(first->point, scaled(first->hit.normal, radius));
    Rotation turn = rotation(yaw_then(other, share) - other->now_yaw);
    Vec outwards = rotated(first->hit.normal, turn);
    touch->count = 1;
    touch->normal = first->side == 0 ? negated(outwards) : outwards;
    for (int point = 0; point < 2; point++) {
        touch->points[point][first->side] = sub(add(own->now, arm), scaled(outwards, radius));
        touch->points[point][1 - first->side] = add(other->now, rotated(sub(on_other, other->now), turn));
    }
}

void move_to_impact(const World *world, Touch *touch) {
    // Chipmunk has the disc first. Pairs that are deeper than they can have approached overlapped before.
    bool is_disc = kind_of(touch->shapes[0]) == SHAPE_CIRCLE;
    if (-distance_of(touch, 0) > approach_in_step(world, touch) || !(is_disc || meet_by_corner(touch))) {
        return;
    }
    Moments moments[2] = {moments_of(world, touch, 0), moments_of(world, touch, 1)};
    FirstImpact first = {.hit = {.share = INFINITY}};
    keep_first_impact(touch, moments, 0, &first);
    if (!is_disc) {
        keep_first_impact(touch, moments, 1, &first);
    }
    if (first.hit.share > 1.0) {
        return;
    }
    touch->met = first.hit.share;
    touch->on_face = first.hit.on_face;
    touch->cornered = first.side;
    if (kind_of(touch->shapes[1]) != SHAPE_SEGMENT) {
        set_impact(touch, moments, &first);
    }
}
