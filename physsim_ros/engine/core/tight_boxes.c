// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Tight boxes: Chipmunk's broad phase lists pairs of bodies that are near, however fast they are.
//
// Problem: `cpBBTree` extends the box of a shape by its displacement in a tenth of a second (`GetBB`), so that a box of
// the tree need not change in each step. Fast bodies overlap in the tree then wherever they are (Munk2D as in
// Pymunk 7.3.1): 12,000 discs of 20 km/s that touch nothing make pairs of 930 MB and steps of 1.6 s, 40 lists of 900
// spheres of 1 km/s steps of 40 to 60 s. That is so in a free fall of some minutes, too.
// Method: a body whose extended boxes overlap more others than indexing it in each sub-step would cost is indexed
// where the coming sub-step ends, at rest: the tree's box is extended by a tenth of its size only (`GetBB`), and
// Chipmunk finds it valid. Position, angle and velocity are as they were to the bit.
// Scope: it depends on what is near a body: a crowd that falls, a single fast body, and one that slides over tiles
// are left to Chipmunk.
// Cost: some 0.5 µs for the count of each body that is fast enough for that many pairs (10 m/s with a half width of 5
// cm), and as much for each that is indexed, in each sub-step.
// Without it `test/engine/stages/test_tight_boxes.py` fails.
// It can go once Pymunk has `cpBBTreeSetVelocityFunc`.

#include "boxes.h"
#include "stages.h"

// Chipmunk extends a box by the displacement in this time [s].
static const double extension = 0.1;
// Count of pairs of a body's pieces with pieces nearby, beyond which its box is kept tight: Chipmunk goes through so
// many pairs in 1 µs, and stores 11 kB for them.
static const double most_pairs = 200.0;

// A count of pieces near a body.
typedef struct Near {
    Body *const *bodies; // of the tree
    double pieces, enough;
} Near;

// Whether the extended boxes of a body may overlap more than `most_pairs` pieces of all. A box of k half widths
// overlaps k² / 2 others at most, where bodies of a size fill the plane.
static bool is_fast_in_crowd(const Body *body) {
    double distance = length(body->engine->v) * extension;
    double most = distance * distance / (2.0 * body->inner * body->inner);
    return !body->anchored && body->pieces * most > most_pairs;
}

static bool count_pieces(int number, void *data) {
    Near *near = data;
    near->pieces += near->bodies[number]->pieces;
    return near->pieces < near->enough;
}

static void index_at_end(World *world, cpBody *engine) {
    Pose pose = pose_of(engine);
    Twist twist = twist_of(engine);
    set_pose(engine, moved(pose, twist, world->dt));
    set_twist(engine, (Twist){0});
    world->chipmunk.reindex_body(world->space, engine);
    set_pose(engine, pose);
    set_twist(engine, twist);
}

// The box of all that fast bodies could meet.
static Box box_of_fast(const World *world) {
    Box all = nowhere;
    for (int number = 0; number < active_count(world); number++) {
        const Body *body = active_at(world, number);
        if (is_fast_in_crowd(body)) {
            all = united(all, box_ahead(body, extension));
        }
    }
    return all;
}

void tighten_boxes(World *world) {
    Box all = box_of_fast(world);
    if (!overlap(all, all)) {
        return;
    }
    Arena *arena = &world->own->arena;
    size_t mark = arena_mark(arena);
    Body **bodies = TAKE(arena, Body *, world->body_count);
    Box *boxes = TAKE(arena, Box, world->body_count);
    int count = 0;
    for (int place = 0; place < world->body_count - 1; place++) {
        boxes[count] = box_ahead(world->bodies + place, extension);
        if (overlap(boxes[count], all)) {
            bodies[count++] = world->bodies + place;
        }
    }
    Tree tree = tree_of(boxes, count, arena);
    for (int number = 0; number < count; number++) {
        const Body *body = bodies[number];
        if (is_fast_in_crowd(body)) {
            Near near = {bodies, 0.0, most_pairs / body->pieces};
            tree_query(&tree, boxes[number], count_pieces, &near);
            if (near.pieces >= near.enough) {
                index_at_end(world, body->engine);
            }
        }
    }
    arena_release(arena, mark);
}
