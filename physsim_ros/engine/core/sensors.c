// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Sensors see what crosses them within a sub-step, and when.
//
// Problem: Chipmunk tells of what overlaps a sensor where a sub-step ends. A ball of 4 cm is past a gate of 1 cm after
// a sub-step at 50 m/s.
// Method: the displacement of a body in the sub-step is swept (`swept_boxes.h`) where it is further than the body may
// be entered unseen, and its time of impact with each sensor on it looked for (`time_of_impact.h`). That time is also
// when a sensor begins to overlap something, however slow.
// Cost: none without sensors; with them a look at the displacements of bodies, and some 2 µs for each pair that could
// meet.
// Without it law 50 (gates) holds up to 40 m/s only.

#include "boxes.h"
#include "impact_islands.h"
#include "stages.h"
#include "time_of_impact.h"

// Shapes have met when they overlap by this share of the safe depth.
static const double touching = 1e-3;

// The bodies that a sensor may meet.
typedef struct Search {
    World *world;
    const Mover *sensor, *movers;
    bool is_far; // the sensor has moved further than it may be entered unseen
    Crossing *found;
} Search;

// The displacement of a body in the sub-step.
static Twist displacement_in_step(const Body *body) {
    Pose end = pose_of(body->engine);
    return (Twist){sub(end.p, body->own->begin.p), end.yaw - body->own->begin.yaw};
}

// A body as the sub-step began, with its displacement since.
static Mover mover_in_step(Body *body) {
    return mover_of(body, body->own->begin, displacement_in_step(body));
}

static double meeting_of(World *world, const Mover *body, const Mover *sensor) {
    return first_impact(world, body, sensor, touching * least(body->depth, sensor->depth));
}

double crossing_time(World *world, Body *body, Body *sensor) {
    Mover one = mover_in_step(body), other = mover_in_step(sensor);
    return clamped(meeting_of(world, &one, &other), 0.0, 1.0);
}

static bool has_moved_far(const Body *body, Twist displacement) {
    return !body->anchored && farthest_displaced(body, displacement) > body->safe_depth;
}

static bool find_crossing(int number, void *data) {
    const Search *search = data;
    const Mover *body = search->movers + number, *sensor = search->sensor;
    bool may_be_unseen = search->is_far || has_moved_far(body->body, body->rate);
    if (may_be_unseen && may_meet(body->body, sensor->body) && meeting_of(search->world, body, sensor) <= 1.0) {
        search->found(search->world, body->body, sensor->body);
    }
    return true;
}

void find_crossings(World *world, Crossing *found) {
    Arena *arena = &world->own->arena;
    bool any_fast = false;
    if (!world->own->has_sensor) {
        return;
    }
    for (int place = 0; place < world->body_count; place++) {
        const Body *body = world->bodies + place;
        any_fast = any_fast || (body->sensor && has_moved_far(body, displacement_in_step(body)));
    }
    size_t mark = arena_mark(arena);
    Mover *movers = TAKE(arena, Mover, world->body_count);
    Box *boxes = TAKE(arena, Box, world->body_count);
    int count = 0;
    for (int place = 0; place < world->body_count; place++) {
        Body *body = world->bodies + place;
        if (!body->sensor && !body->anchored && (any_fast || has_moved_far(body, displacement_in_step(body)))) {
            movers[count] = mover_in_step(body);
            boxes[count] = movers[count].box;
            count++;
        }
    }
    Tree tree = tree_of(boxes, count, arena);
    for (int place = 0; place < world->body_count && count > 0; place++) {
        Body *body = world->bodies + place;
        if (body->sensor) {
            Mover sensor = mover_in_step(body);
            Search search = {world, &sensor, movers, has_moved_far(body, sensor.rate), found};
            tree_query(&tree, sensor.box, find_crossing, &search);
        }
    }
    arena_release(arena, mark);
}
