// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The social force model of pedestrians.
//
// Problem: people keep their distance from each other and from walls, and go on towards where they want to be.
// Method: D. Helbing and P. Molnár, "Social force model for pedestrian dynamics", Physical Review E 51, 4282 (1995),
// without its attractions and fluctuations. A pedestrian accelerates towards its desired velocity within τ, away from
// others by the gradient of the potential V⁰ exp(-b / σ), where b is the lesser half axis of the ellipse whose foci are
// the other one now and where its step of Δt takes it, and away from the nearest point of each wall by that of
// U⁰ exp(-r / R). Others out of sight count c. Its speed is bounded.
// Every body that does not walk is a wall, at the disc around it: the paper has only people and walls. A wall beside
// the way of a pedestrian pushes it aside, not back: in the paper nobody passes a gap of less than a metre. Walls that
// touch push as one: those count whose nearest point is a local minimum of the distance from all of them. Of a convex
// wall it is none if a nearer wall touches it there, since the distance decreases on the way between both points.
//
// Cost: 30 ns a pair, and 0.4 µs a wall, whose neighbours a tree of boxes finds.

#include "social_force.h"
#include "boxes.h"

// Least half axis [m], so that the force of two at one point is finite.
static const double least_axis = 0.01;
// Gap of walls that touch, at most [m]: far above rounding.
static const double seam = 1e-6;
// What is straight ahead pushes by this to the right of straight away [rad], where the paper has fluctuations: who
// meets another one or an obstacle head on stops before it without. What is beside the way pushes straight away.
static const double sidestep = 0.1;

// The acceleration by another pedestrian at `apart` from it, which walks with a velocity.
static Vec repulsion(const SocialForce *model, Vec apart, Vec velocity) {
    Vec step = scaled(velocity, model->step_time), from_step = sub(apart, step);
    double here = length(apart), there = length(from_step), sum = here + there;
    double axis = greatest(sqrt(greatest(sum * sum - dot(step, step), 0.0)) / 2.0, least_axis);
    Vec gradient = scaled(
        add(scaled(apart, 1.0 / greatest(here, least_axis)), scaled(from_step, 1.0 / greatest(there, least_axis))),
        sum / (4.0 * axis));
    return scaled(gradient, model->repulsion / model->range * exp(-axis / model->range));
}

// The acceleration by a wall. Its part against the desired direction, of length 1, decreases to 0 as the distance of
// the wall from the middle of the way increases to the radius of the pedestrian.
static Vec wall_repulsion(const SocialForce *model, const Disc *self, Nearest nearest, Vec ahead, double beside) {
    double distance = greatest(nearest.distance, 0.0);
    double size = model->wall_repulsion / model->wall_range * exp(-distance / model->wall_range);
    Vec force = scaled(nearest.outwards, size);
    double back = greatest(-dot(force, ahead), 0.0), room = clamped(beside / self->radius, 0.0, 1.0);
    return add(force, scaled(ahead, back * room));
}

// Whether a wall touches a point.
static bool touches(const World *world, const cpShape *wall, Vec point) {
    cpPointQueryInfo found;
    return world->chipmunk.point_query(wall, point, &found) <= seam;
}

// The search for the walls that touch the nearest point of one.
typedef struct FrontSearch {
    const World *world;
    Seen *seen;
    int number;
    Vec point;
} FrontSearch;

// Keep a nearer wall; of several the first, whatever the order in which they are found.
static bool keep_front(int other, void *data) {
    const FrontSearch *search = data;
    Seen *own = search->seen + search->number;
    const Seen *wall = search->seen + other;
    double nearer = own->nearest.distance - wall->nearest.distance;
    bool first = own->front == search->number || other < own->front;
    if (first && (nearer > 0.0 || (nearer == 0.0 && other < search->number)) &&
        touches(search->world, wall->wall, search->point)) {
        own->front = other;
    }
    return true;
}

// Find for each wall the first of the nearer ones that touch its nearest point.
static void find_nearer(const World *world, Seen *seen, int count, Vec from) {
    Arena *arena = &world->own->arena;
    size_t mark = arena_mark(arena);
    Box *boxes = TAKE(arena, Box, count);
    for (int number = 0; number < count; number++) {
        const double *bounds = seen[number].wall->bb;
        boxes[number] = (Box){{bounds[0] - seam, bounds[1] - seam}, {bounds[2] + seam, bounds[3] + seam}};
    }
    Tree tree = tree_of(boxes, count, arena);
    for (int number = 0; number < count; number++) {
        Nearest own = seen[number].nearest;
        Vec point = sub(from, scaled(own.outwards, own.distance));
        FrontSearch search = {world, seen, number, point};
        tree_query(&tree, (Box){point, point}, keep_front, &search);
    }
    arena_release(arena, mark);
}

// Find the walls within sight, and for each the nearest one of those with which it pushes; return their number.
static int find_fronts(const World *world, const Surroundings *around, const Disc *self, Vec ahead) {
    Seen *seen = around->seen;
    int count = 0;
    for (int number = 0; number < around->wall_count; number++) {
        const cpShape *wall = around->walls[number];
        Nearest nearest;
        if (sees_wall(world, wall, self->body, self->point, &nearest)) {
            seen[count] = (Seen){wall, nearest, distance_beside(wall, self->point, ahead), count};
            count++;
        }
    }
    find_nearer(world, seen, count, self->point);
    for (int number = 0; number < count; number++) {
        int front = number;
        while (seen[front].front != front) {
            // Path halving, as in `root_of`.
            seen[front].front = seen[seen[front].front].front;
            front = seen[front].front;
        }
        seen[front].beside = least(seen[front].beside, seen[number].beside);
    }
    return count;
}

// A force that pushes away from something, turned to the right the more that is ahead.
static Vec swerved(Vec force, Vec desired) {
    double size = length(force) * length(desired);
    double ahead = size > 0.0 ? greatest(-dot(force, desired) / size, 0.0) : 0.0;
    return rotated(force, rotation(sidestep * ahead));
}

static Vec of_disc(const SocialForce *model, const Disc *self, const Disc *other, Vec desired, Vec ahead) {
    Vec apart = sub(self->point, other->point);
    double distance = length(apart);
    if (distance > farthest_seen + other->radius || distance == 0.0) {
        return (Vec){0};
    }
    if (!other->walks) {
        Nearest nearest = {distance - other->radius, scaled(apart, 1.0 / distance)};
        double beside = fabs(cross(ahead, apart)) - other->radius;
        return swerved(wall_repulsion(model, self, nearest, ahead, beside), desired);
    }
    Vec force = swerved(repulsion(model, apart, other->velocity), desired);
    bool seen = -dot(desired, force) >= model->cosine_of_sight * length(desired) * length(force);
    return seen ? force : scaled(force, model->behind);
}

Vec walk_by_social_force(const World *world, const Surroundings *around, const Actor *actor, const Disc *self,
                         Vec desired, double dt) {
    const SocialForce *model = &actor->social_force;
    Vec force = scaled(sub(desired, self->velocity), 1.0 / model->relaxation_time);
    Vec ahead = scaled(desired, 1.0 / greatest(length(desired), 1e-300));
    for (int number = 0; number < around->disc_count; number++) {
        const Disc *other = around->discs + number;
        if (!passes_through(self->body, other->body)) {
            force = add(force, of_disc(model, self, other, desired, ahead));
        }
    }
    int count = find_fronts(world, around, self, ahead);
    for (int number = 0; number < count; number++) {
        const Seen *wall = around->seen + number;
        if (wall->front == number) {
            force = add(force, swerved(wall_repulsion(model, self, wall->nearest, ahead, wall->beside), desired));
        }
    }
    Vec velocity = add(self->velocity, scaled(force, dt));
    double speed = length(velocity);
    return speed > actor->pace.max_speed ? scaled(velocity, actor->pace.max_speed / speed) : velocity;
}
