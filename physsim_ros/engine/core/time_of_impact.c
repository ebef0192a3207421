// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Time of impact of pairs of convex shapes in rigid motion.
//
// Problem: when two bodies that move and turn first meet, within a sub-step.
// Method: conservative advancement (B. Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems", 1996, 2.3).
// The separation of two shapes, found by separating axes, divided by the greatest speed at which it can shrink, is a
// time in which they cannot meet. Both advance by it, again and again, until they overlap by the skin or the sub-step
// ends.
// Scope: an impact counts where the rest of the approach is more than the safe depth. A pair that overlaps from the
// start meets where it has come deeper by the skin, so that it moves on until Chipmunk finds it to approach, too; not
// at all where it overlaps by more than the lesser inner radius, since either side may be the nearer one then. What is
// within a one-way body, or meets an open side of it, passes it.
// Cost: an advance goes through the corners of both shapes once, 10 ns each.

#include "time_of_impact.h"
#include "one_way.h"

// Advances of a pair in a sub-step, at most: straight motion takes two or three, a fast turning stick that grazes a
// disc about twenty. A pair that takes more ends its sub-step where the last one has brought it.
enum { ADVANCES = 24 };
// Shapes have met when they overlap to within this share of the skin.
static const double tolerance = 0.1;

// A shape in the coming sub-step.
typedef struct MovingShape {
    const Mover *mover;
    int count;
    Corner *still;   // (count): in the frame of the body
    Corner *corners; // (count): where it is
    double reach;    // greatest distance of a corner from the centre of rotation [m]
    Vec pivot;
} MovingShape;

// How far two shapes are apart, along which axis.
typedef struct Separation {
    double distance; // < 0 where they overlap [m]
    Vec axis;        // from the first to the second
    bool of_first;   // whether it is a normal of the first
} Separation;

static MovingShape side_of(const Mover *mover, const cpShape *shape, Arena *arena) {
    MovingShape side = {.mover = mover, .count = corner_count(shape)};
    side.still = TAKE(arena, Corner, side.count);
    side.corners = TAKE(arena, Corner, side.count);
    double reach = 0.0;
    for (int number = 0; number < side.count; number++) {
        side.still[number] = corner_on_body(shape, number);
        reach = greatest(reach, length(side.still[number].point));
    }
    side.reach = reach + length(sub(mover->pose.p, mover->pivot));
    return side;
}

static void move_to(MovingShape *side, double share) {
    Pose pose = pose_at(side->mover, share, &side->pivot);
    Rotation by = rotation(pose.yaw);
    for (int number = 0; number < side->count; number++) {
        side->corners[number].point = add(rotated(side->still[number].point, by), pose.p);
        side->corners[number].normal = rotated(side->still[number].normal, by);
    }
}

static int foremost(const MovingShape *side, Vec axis) {
    int best = 0;
    double most = dot(axis, side->corners[0].point);
    for (int number = 1; number < side->count; number++) {
        double ahead = dot(axis, side->corners[number].point);
        if (ahead > most) {
            best = number, most = ahead;
        }
    }
    return best;
}

// The least of the vectors from a corner of the first shape to one of the second.
static void keep_nearer(Vec between, bool of_first, Vec *nearest) {
    if (dot(between, between) < dot(*nearest, *nearest)) {
        *nearest = of_first ? between : negated(between);
    }
}

// Try the normals of one shape. While these turn counter-clockwise, the corner of the other that is foremost against
// them moves on in the same sense (rotating calipers; Toussaint, "Solving Geometric Problems with the Rotating
// Calipers", 1983). The nearest corners of disjoint shapes are among those that face each other on the way, which are
// the corners of the Minkowski difference.
static void try_faces(const MovingShape *side, const MovingShape *other, bool of_first, Separation *best,
                      Vec *nearest) {
    int facing = foremost(other, negated(side->corners[0].normal));
    Vec corner = side->corners[side->count - 1].point;
    for (int number = 0; number <= side->count; number++) {
        const Corner *face = side->corners + (number < side->count ? number : 0);
        int next = (facing + 1) % other->count;
        keep_nearer(sub(other->corners[facing].point, corner), of_first, nearest);
        while (dot(face->normal, sub(other->corners[next].point, other->corners[facing].point)) < 0.0) {
            facing = next;
            next = (facing + 1) % other->count;
            keep_nearer(sub(other->corners[facing].point, corner), of_first, nearest);
        }
        corner = face->point;
        Vec between = sub(other->corners[facing].point, corner);
        double distance = dot(face->normal, between);
        bool is_face = face->normal.x != 0.0 || face->normal.y != 0.0; // a point has none
        if (is_face && distance > best->distance) {
            *best = (Separation){distance, of_first ? face->normal : negated(face->normal), of_first};
        }
        keep_nearer(between, of_first, nearest);
    }
}

// The separation of the cores of two shapes, exact for disjoint ones; else the negative least depth.
static Separation separation_of(const MovingShape *a, const MovingShape *b) {
    Separation best = {-1e300, {0.0, 0.0}, true};
    Vec nearest = sub(b->corners[0].point, a->corners[0].point);
    try_faces(a, b, true, &best, &nearest);
    try_faces(b, a, false, &best, &nearest);
    double size = length(nearest);
    Vec axis = scaled(nearest, size > 0.0 ? 1.0 / size : 0.0);
    double lead = dot(axis, a->corners[foremost(a, axis)].point);
    double distance = dot(axis, b->corners[foremost(b, negated(axis))].point) - lead;
    // Two points in one place have no axis.
    return size > 0.0 && distance > best.distance ? (Separation){distance, axis, false} : best;
}

// The greatest speed at which the separation along an axis can shrink [m a sub-step]. The axis may be held in the
// world, or turn with either body; the least bound is taken. A body that turns sees a point move by its distance from
// the pivot only.
static double speed_bound(const MovingShape *a, const MovingShape *b, Vec axis, double lapse) {
    const MovingShape *sides[2] = {a, b};
    Vec relative = sub(a->mover->rate.v, b->mover->rate.v);
    double distance = length(relative), turns[2] = {fabs(a->mover->rate.w), fabs(b->mover->rate.w)};
    double bound = dot(relative, axis) + turns[0] * a->reach + turns[1] * b->reach;
    for (int side = 0; side < 2; side++) {
        const MovingShape *other = sides[1 - side];
        double far = 0.0;
        for (int number = 0; number < other->count; number++) {
            Vec arm = sub(other->corners[number].point, sides[side]->pivot);
            far = greatest(far, dot(arm, arm));
        }
        double seen = turns[side] * (sqrt(far) + distance * lapse);
        bound = least(bound, distance + seen + turns[1 - side] * other->reach);
    }
    return bound;
}

// How far a point of a body would go along an axis in a whole sub-step [m].
static double rate_along(const MovingShape *side, Vec point, Vec axis) {
    return dot(velocity_at(side->mover->rate, sub(point, side->pivot)), axis);
}

// The velocity at which two shapes approach along an axis where they meet [m a sub-step].
static double approach(const MovingShape *a, const MovingShape *b, const Separation *found) {
    const MovingShape *cornered = found->of_first ? b : a;
    Vec axis = found->of_first ? negated(found->axis) : found->axis;
    Vec point = cornered->corners[foremost(cornered, axis)].point;
    return rate_along(a, point, found->axis) - rate_along(b, point, found->axis);
}

// Whether neither body lets the other one pass where they meet.
static bool are_closed(const MovingShape *a, const MovingShape *b, Vec axis, double share) {
    return is_closed(a->mover->body, yaw_at(a->mover, share), axis) &&
           is_closed(b->mover->body, yaw_at(b->mover, share), negated(axis));
}

// The share of the sub-step at which two shapes first overlap by the skin. `passing` is whether an overlap from the
// start is that of a body which passes a one-way body.
static double advance(MovingShape *a, MovingShape *b, double radii, double skin, double depth, bool passing) {
    double share = greatest(a->mover->since, b->mover->since), target = -skin;
    for (int number = 0; number < ADVANCES; number++) {
        move_to(a, share);
        move_to(b, share);
        Separation found = separation_of(a, b);
        double distance = found.distance - radii;
        bool met = distance <= target + tolerance * skin;
        if (number == 0 && met) {
            if ((passing && distance < -skin) || distance < -skin - depth * (double)SAFE_DEPTHS) {
                return INFINITY;
            }
            target = distance - skin;
            met = false;
        }
        // A pair that leaves its overlap may not come back as deep.
        target = greatest(target, least(-skin, distance - depth));
        if (met) {
            double rate = approach(a, b, &found);
            if (rate > 0.0) {
                bool stops = rate * (1.0 - share) > depth && are_closed(a, b, found.axis, share);
                return stops ? share : INFINITY;
            }
        }
        double speed = speed_bound(a, b, found.axis, 1.0 - share);
        share = speed > 0.0 ? share + (distance - target) / speed : INFINITY;
        if (!(share < 1.0)) {
            return INFINITY;
        }
    }
    // It may meet later; its sub-step ends where the way is known to be clear.
    return share;
}

static double impact_of_shapes(World *world, const Mover *one, const cpShape *a, const Mover *other, const cpShape *b,
                               double depth) {
    Arena *arena = &world->own->arena;
    size_t mark = arena_mark(arena);
    double radii = radius_of(a) + radius_of(b), skin = least(world->space->collisionSlop, depth);
    bool is_round = corner_count(a) < 3 || corner_count(b) < 3;
    skin = is_round ? least(skin, radii / 2.0) : skin;
    MovingShape first = side_of(one, a, arena), second = side_of(other, b, arena);
    bool passing = (is_one_way(one->body) || is_one_way(other->body)) && !was_loaded(world, a, b);
    double share = advance(&first, &second, radii, skin, depth, passing);
    arena_release(arena, mark);
    return share;
}

// The next shape of a mover, or its first one.
static const cpShape *shape_after(const Mover *mover, const cpShape *shape) {
    if (mover->shape != NULL) {
        return shape == NULL ? mover->shape : NULL;
    }
    return shape == NULL ? mover->body->engine->shapeList : shape->next;
}

double first_impact(World *world, const Mover *one, const Mover *other, double depth) {
    double earliest = INFINITY;
    for (const cpShape *a = shape_after(one, NULL); a != NULL; a = shape_after(one, a)) {
        for (const cpShape *b = shape_after(other, NULL); b != NULL; b = shape_after(other, b)) {
            earliest = least(earliest, impact_of_shapes(world, one, a, other, b, depth));
        }
    }
    return earliest;
}
