// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Internal edges: what slides over the seam of two shapes does not hit the side of the next one.
//
// Problem: at a seam a corner is in contact, whose normal stops what slides ("ghost collision").
// Method: a contact at a corner, while a face is entered by no more than the slop and under no more than 10 degrees,
// gets the normal of that face (`btInternalEdgeUtility` in Bullet). A disc that has met a face lies before its plane:
// a corner that it meets later in the sub-step, in that plane or behind it, is none that it can touch.
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

static int by_disc(const void *one, const void *other) {
    const MetFace *a = one, *b = other;
    return (a->disc > b->disc) - (a->disc < b->disc);
}

int list_met_faces(const Touch *touches, int count, MetFace *faces) {
    int found = 0;
    for (int number = 0; number < count; number++) {
        if (touches[number].on_face) {
            faces[found++] = (MetFace){touches[number].shapes[0]->hashid, touches + number};
        }
    }
    sort(faces, found, sizeof(MetFace), by_disc);
    return found;
}

// Whether the contact of a disc is at a face that it has met before a corner, which lies in its plane or behind it.
static bool hides(const Touch *face, const Touch *corner) {
    Vec offset = sub(corner->points[0][1], face->points[0][1]);
    return face->met <= corner->met && -dot(face->normal, offset) <= slop_of(corner->arbiter);
}

bool is_hidden(const Touch *touch, const MetFace *faces, int count) {
    if (touch->on_face || !is_at_corner(touch, 1)) {
        return false;
    }
    uintptr_t disc = touch->shapes[0]->hashid;
    int low = 0, high = count;
    while (low < high) {
        int middle = (low + high) / 2;
        bool before = faces[middle].disc < disc;
        low = before ? middle + 1 : low;
        high = before ? high : middle;
    }
    for (int number = low; number < count && faces[number].disc == disc; number++) {
        if (hides(faces[number].touch, touch)) {
            return true;
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
