// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// First touch: a contact that begins has normal and points of the moment of its impact, not of the end of the sub-step.
//
// Problem: Chipmunk finds a contact where the sub-step ends, up to a safe depth inside. Until then the line of centres
// of two discs has turned, by v dt / (2 r) at most; a disc that hits a corner has come past it; a body that slides over
// the seam of two tiles has gone less far past the side of the next one than it lies below its top ("ghost collision":
// Catto, "Ghost Collisions", box2d.org 2020).
// And its GJK (`GJKRecurse` in `src/cpCollision.c`) tests with rounded numbers whether the origin is in a triangle: one
// pair in ten thousand of polygons that face each other exactly is said to have entered each other from the far sides,
// though they are apart.
//
// Method: between Chipmunk's narrow phase and its solver, for all contacts; parts 2 and 4 for those that begin:
//
// 1. False contacts: polygons whose normal points from the second to the first, and which a face separates (separating
//    axis theorem; Ericson, "Real-Time Collision Detection", 5.2.1); and polygons whose faces have met by rounding as
//    the sub-step ends: one corner alone is in, which turned boxes that slide on a floor. Chipmunk ignores the contact
//    in this sub-step, and in the next one what it finds counts as a first touch (`find_begun`).
// 2. Impact (`touch_impact.c`): the contact gets the normal and the arms of the moment at which a disc, or a corner,
//    first meets the other shape.
// 3. Internal edges (`touch_edges.c`): a contact at a corner gets the normal of the face that the shapes slide over; at
//    one behind a face that its shape has met before, it is ignored, as in part 1. That of a disc gets it in each
//    sub-step, since Chipmunk has it point to the corner until the disc has passed it.
// 4. What `cpArbiterPreStep` had made of the old contacts is made anew.
//
// Cost: 0.3 µs a contact that begins, and for two polygons that meet fast 20 ns a corner.
//
// Without part 1 law 3 (head-on impacts of squares) fails; without part 2 laws 6 (bodies part along the normal of their
// impact) and 35 (a fast bar hits all discs); without part 3 a body stumbles over seams
// (`test/engine/stages/test_internal_edges.py`). Part 1 can go when GJK is exact.

#include "contact.h"
#include "stages.h"
#include "touch_stages.h"

// The greatest overlap of faces that have met by rounding [m]: their bodies lie on others to 1e-10 rad.
static const double rounding_of_faces = 1e-8;

// Whether a contact begins in this sub-step, or was ignored in the one before.
static bool is_new(const cpArbiter *arbiter) {
    return begins(arbiter) || is_ignored(arbiter);
}

static Vec middle_of(const cpShape *shape) {
    return vec((shape->bb[0] + shape->bb[2]) / 2.0, (shape->bb[1] + shape->bb[3]) / 2.0);
}

// Whether a face separates two shapes, and their normal is turned.
static bool is_false(cpArbiter *arbiter) {
    if (kind_of(arbiter->a) == SHAPE_CIRCLE || kind_of(arbiter->b) == SHAPE_CIRCLE ||
        dot(sub(middle_of(arbiter->b), middle_of(arbiter->a)), arbiter->n) >= 0.0) {
        return false;
    }
    Touch touch = touch_of(arbiter);
    for (int side = 0; side < 2; side++) {
        for (int face = 0; face < corner_count(touch.shapes[side]); face++) {
            if (face_depth(&touch, side, face) < 0.0) {
                return true;
            }
        }
    }
    return false;
}

// Whether a disc touches a shape with edges; Chipmunk has the disc first.
static bool is_disc_on_edges(const cpArbiter *arbiter) {
    return kind_of(arbiter->a) == SHAPE_CIRCLE && kind_of(arbiter->b) != SHAPE_CIRCLE;
}

// Whether two corners of a polygon are its furthest in a direction, to rounding.
static bool has_face(const cpShape *polygon, Vec direction) {
    double first = -INFINITY, second = -INFINITY;
    for (int number = 0; number < corner_count(polygon); number++) {
        double height = dot(corner_in_world(polygon, number).point, direction);
        second = greatest(second, least(first, height));
        first = greatest(first, height);
    }
    return first - second < rounding_of_faces;
}

// Whether faces have met by rounding, as the sub-step ends: the next one finds whether by a face or a corner.
// Continuous collision has stopped others there.
static bool meets_next(const World *world, cpArbiter *arbiter) {
    bool stopped = body_of(arbiter->body_a)->own->remaining > 0.0 || body_of(arbiter->body_b)->own->remaining > 0.0;
    if (stopped || arbiter->count != 1 || kind_of(arbiter->a) == SHAPE_CIRCLE || kind_of(arbiter->b) == SHAPE_CIRCLE) {
        return false;
    }
    Touch touch = touch_of(arbiter);
    return -distance_of(&touch, 0) < rounding_of_faces && approach_of(arbiter) * world->dt > rounding_of_faces &&
           has_face(arbiter->a, touch.normal) && has_face(arbiter->b, negated(touch.normal));
}

void ignore_false_contacts(World *world) {
    for (int number = 0; number < arbiter_count(world); number++) {
        cpArbiter *arbiter = arbiter_at(world, number);
        if (arbiter->count > 0 && (is_false(arbiter) || (is_new(arbiter) && meets_next(world, arbiter)))) {
            ignore(arbiter);
        }
    }
}

void find_begun(World *world) {
    SubStep *now = &world->own->now;
    now->begun = TAKE(&world->own->arena, Touch, arbiter_count(world));
    for (int number = 0; number < arbiter_count(world); number++) {
        cpArbiter *arbiter = arbiter_at(world, number);
        // One without points is ignored.
        if (arbiter->count > 0 && is_new(arbiter)) {
            arbiter->data = NULL;
            arbiter->state = ARBITER_FIRST_COLLISION;
            now->begun[now->begun_count++] = touch_of(arbiter);
        }
    }
}

void move_to_impacts(World *world) {
    for (int number = 0; number < world->own->now.begun_count; number++) {
        move_to_impact(world, world->own->now.begun + number);
    }
}

// Turn the contacts of discs that have begun before.
static void roll_over_edges(World *world) {
    for (int number = 0; number < arbiter_count(world); number++) {
        cpArbiter *arbiter = arbiter_at(world, number);
        if (!is_new(arbiter) && is_disc_on_edges(arbiter)) {
            Touch touch = touch_of(arbiter);
            if (slide_over_edge(&touch)) {
                write_touch(&touch);
                prepare_contact(arbiter);
            }
        }
    }
}

void slide_over_edges(World *world) {
    roll_over_edges(world);
    SubStep *now = &world->own->now;
    bool *hidden = TAKE(&world->own->arena, bool, now->begun_count);
    const Touch **faces = TAKE(&world->own->arena, const Touch *, now->begun_count);
    int face_count = list_faces(now->begun, now->begun_count, faces), kept = 0;
    for (int number = 0; number < now->begun_count; number++) {
        hidden[number] = is_hidden(now->begun + number, faces, face_count);
    }
    for (int number = 0; number < now->begun_count; number++) {
        if (hidden[number]) {
            ignore(now->begun[number].arbiter);
        } else {
            slide_over_edge(now->begun + number);
            now->begun[kept++] = now->begun[number];
        }
    }
    now->begun_count = kept;
}

void prepare_begun(World *world) {
    for (int number = 0; number < world->own->now.begun_count; number++) {
        const Touch *touch = world->own->now.begun + number;
        write_touch(touch);
        prepare_contact(touch->arbiter);
    }
}
