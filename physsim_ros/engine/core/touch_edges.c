// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Internal edges: what slides over the seam of two shapes does not hit the side of the next one.
//
// Problem: at a seam a corner is in contact, whose normal stops what slides ("ghost collision").
// Method: a contact at a corner, while a face is entered by no more than the slop and under no more than 10 degrees,
// gets the normal of that face (`btInternalEdgeUtility` in Bullet). A disc or corner that has met a face lies before
// its plane: what its shape meets later in the sub-step, in that plane or behind it, is none that it can touch.
// Cost, and what fails without it: `first_touch.c`.

#include "touch_stages.h"

// Distance from a corner within which overlaps of the slop along two faces lie, in slops: the diagonal of their
// rhombus, for faces that enclose 30 degrees or more.
static const double near_slops = 4.0;
// Approach by speed up to which a body slides over a face [1]: the sine of 10 degrees.
static const double gliding = 0.17;

// A face over which two shapes slide.
typedef struct Slide {
    int side;
    double approach; // velocity against it [m/s]
    double depth;    // of the other shape behind it [m]
    Vec outwards;
} Slide;

static bool is_within(Vec point, Vec corner, double reach) {
    return length(sub(corner, point)) <= reach;
}

static double reach_of(const Touch *touch, int side) {
    return near_slops * slop_of(touch->arbiter) + radius_of(touch->shapes[side]);
}

static bool is_at_corner(const Touch *touch, int side) {
    double reach = reach_of(touch, side);
    for (int number = 0; number < corner_count(touch->shapes[side]); number++) {
        if (is_within(touch->points[0][side], corner_in_world(touch->shapes[side], number).point, reach)) {
            return true;
        }
    }
    return false;
}

// Whether a shape has met a face before another contact, which lies in the plane of the face or behind it.
static bool hides(const Touch *face, const Touch *touch, int side) {
    Vec outwards = face->cornered == 0 ? negated(face->normal) : face->normal;
    Vec other = side == 0 ? negated(touch->normal) : touch->normal;
    // Two corners of a polygon may meet one face.
    bool may_be_hidden = kind_of(touch->shapes[side]) == SHAPE_CIRCLE || length(sub(outwards, other)) > same_normal;
    Vec offset = sub(touch->points[0][1 - side], face->points[0][1 - face->cornered]);
    return may_be_hidden && face->met <= touch->met && dot(outwards, offset) <= slop_of(touch->arbiter);
}

static uintptr_t cornered_shape(const Touch *face) {
    return face->shapes[face->cornered]->hashid;
}

static int by_shape(const void *one, const void *other) {
    uintptr_t first = cornered_shape(*(const Touch *const *)one), second = cornered_shape(*(const Touch *const *)other);
    return compared(1, (double[][2]){{(double)first, (double)second}});
}

int list_faces(const Touch *touches, int count, const Touch **faces) {
    int face_count = 0;
    for (int number = 0; number < count; number++) {
        if (touches[number].on_face) {
            faces[face_count++] = touches + number;
        }
    }
    sort((void *)faces, face_count, sizeof(const Touch *), by_shape);
    return face_count;
}

// The number of the first face that a shape has met, or that of the next shape.
static int first_of(uintptr_t shape, const Touch *const *faces, int count) {
    int low = 0, high = count;
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (cornered_shape(faces[middle]) < shape) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

// Whether a contact may be with what lies behind a face: of a disc one at a corner, of polygons one that begins fast.
static bool may_be_behind(const Touch *touch) {
    if (kind_of(touch->shapes[0]) != SHAPE_CIRCLE) {
        return touch->met > 0.0;
    }
    return kind_of(touch->shapes[1]) != SHAPE_CIRCLE && !touch->on_face && is_at_corner(touch, 1);
}

bool is_hidden(const Touch *touch, const Touch *const *faces, int count) {
    // A disc comes first.
    int sides = kind_of(touch->shapes[0]) == SHAPE_CIRCLE ? 1 : 2;
    for (int side = 0; side < sides && may_be_behind(touch); side++) {
        uintptr_t shape = touch->shapes[side]->hashid;
        int face = first_of(shape, faces, count);
        for (; face < count && cornered_shape(faces[face]) == shape; face++) {
            if (hides(faces[face], touch, side)) {
                return true;
            }
        }
    }
    return false;
}

// The velocity of the second shape against the first [m/s]. The spin of a disc does not move its surface along a face.
static Vec relative_velocity(const Touch *touch) {
    Vec velocities[2];
    for (int side = 0; side < 2; side++) {
        const cpShape *shape = touch->shapes[side];
        bool is_disc = kind_of(shape) == SHAPE_CIRCLE;
        Vec point = is_disc ? corner_in_world(shape, 0).point : touch->points[0][side];
        velocities[side] = velocity_on(touch, side, point);
    }
    return sub(velocities[1], velocities[0]);
}

// Look for the face of one shape that is approached slowest.
static void find_slide(const Touch *touch, int side, Vec velocity, Slide *best) {
    const cpShape *shape = touch->shapes[side];
    int count = corner_count(shape);
    double reach = reach_of(touch, side), sign = side == 0 ? 1.0 : -1.0;
    for (int face = 0; face < count && count > 1; face++) {
        Corner corner = corner_in_world(shape, face);
        Vec before = corner_in_world(shape, (face + count - 1) % count).point, point = touch->points[0][side];
        double approach = -dot(corner.normal, velocity) * sign;
        if (approach < best->approach && (is_within(point, corner.point, reach) || is_within(point, before, reach))) {
            double depth = face_depth(touch, side, face);
            if (depth >= 0.0 && depth <= slop_of(touch->arbiter)) {
                *best = (Slide){side, approach, depth, corner.normal};
            }
        }
    }
}

bool slide_over_edge(Touch *touch) {
    // A disc is at its only corner, so that the other shape is asked first.
    if (!is_at_corner(touch, 1) || !is_at_corner(touch, 0)) {
        return false;
    }
    Vec velocity = relative_velocity(touch);
    double approach = -dot(velocity, touch->normal);
    if (approach <= 0.0) {
        return false;
    }
    Slide slide = {.side = -1, .approach = least(approach, gliding * length(velocity))};
    find_slide(touch, 0, velocity, &slide);
    find_slide(touch, 1, velocity, &slide);
    if (slide.side < 0) {
        return false;
    }
    const cpShape *other = touch->shapes[1 - slide.side];
    Vec along = slide.side == 0 ? slide.outwards : negated(slide.outwards), half = scaled(along, slide.depth / 2.0);
    touch->normal = along;
    for (int point = 0; point < 2; point++) {
        Vec middle = scaled(add(touch->points[point][0], touch->points[point][1]), 0.5);
        if (kind_of(other) == SHAPE_CIRCLE) {
            // A disc is touched below its centre.
            middle = sub(corner_in_world(other, 0).point, scaled(slide.outwards, radius_of(other)));
        }
        touch->points[point][0] = add(middle, half);
        touch->points[point][1] = sub(middle, half);
    }
    return true;
}
