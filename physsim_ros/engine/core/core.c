// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The beginning and the end of a world, and its tables.

#include "one_way.h"
#include "springs.h"
#include "stages.h"
#include <stdlib.h>

const char *core_sources(void) {
    return CORE_SOURCES;
}

World *core_new(cpSpace *space, Chipmunk chipmunk, double dt, cpConstraint *hook) {
    World *world = allocated(1, sizeof(World));
    world->space = space;
    world->chipmunk = chipmunk;
    world->dt = dt;
    world->stages = STAGE_ALL;
    world->own = allocated(1, sizeof(Private));
    world->own->hook = hook;
    world->own->all_active = true;
    world->own->report = new_report();
    hook->userData = world;
    return world;
}

void core_free(World *world) {
    arena_free(&world->own->arena);
    arena_free(&world->own->static_arena);
    arena_free(&world->own->system_arena);
    free_report(world);
    free(world->own->bodies);
    free(world->own->jointed);
    free(world->own->fluid_forces);
    free(world->own);
    free(world);
}

void core_use_bodies(World *world, Body *bodies, int32_t count, const int32_t *former) {
    assert(count > 0 && bodies[count - 1].anchored); // the background
    rename_contacts(world, former, count);
    world->bodies = bodies;
    world->body_count = count;
    world->statics_moved = true;
    Private *own = world->own;
    own->least_depth = INFINITY;
    own->has_floor = own->has_one_way = own->has_belt = own->has_rolling = own->has_sensor = false;
    free(own->fluid_forces);
    own->fluid_forces = NULL;
    free(own->bodies);
    own->bodies = allocated((size_t)count, sizeof(BodyPrivate));
    for (int place = 0; place < count; place++) {
        Body *body = bodies + place;
        body->own = own->bodies + place;
        body->engine->userData = body;
        own->least_depth = body->sensor ? own->least_depth : least(own->least_depth, body->safe_depth);
        own->has_sensor = own->has_sensor || body->sensor;
        own->has_floor = own->has_floor || body->braking > 0.0;
        own->has_one_way = own->has_one_way || is_one_way(body);
        own->has_belt = own->has_belt || body->belt != 0.0;
        own->has_rolling = own->has_rolling || body->rolling > 0.0;
    }
}

// List the places of dynamic bodies with joints that have rows.
static void list_jointed(World *world) {
    Private *own = world->own;
    free(own->jointed);
    own->jointed = allocated((size_t)world->body_count, sizeof(int));
    own->jointed_count = 0;
    for (int place = 0; place < world->body_count; place++) {
        if (world->bodies[place].own->jointed && world->bodies[place].dynamic) {
            own->jointed[own->jointed_count++] = place;
        }
    }
}

void core_use_joints(World *world, Joint *joints, int32_t joint_count, Part *parts, int32_t part_count, Row *rows,
                     int32_t row_count, Guide *guides, int32_t guide_count) {
    world->joints = joints;
    world->joint_count = joint_count;
    world->parts = parts;
    world->part_count = part_count;
    world->rows = rows;
    world->row_count = row_count;
    world->guides = guides;
    world->guide_count = guide_count;
    for (int place = 0; place < world->body_count; place++) {
        world->bodies[place].own->jointed = false;
    }
    int next_part = 0, next_row = 0;
    for (int number = 0; number < joint_count; number++) {
        // Parts and rows follow one another, in the order of their joints.
        assert(joints[number].first_part == next_part && joints[number].first_row == next_row);
        next_part += joints[number].part_count;
        next_row += joints[number].row_count;
        Body *ends[2] = {world->bodies + joints[number].a, world->bodies + joints[number].b};
        for (int end = 0; end < 2; end++) {
            ends[end]->own->jointed = ends[end]->own->jointed || joints[number].row_count > 0;
        }
    }
    assert(next_part == part_count && next_row == row_count);
    for (int number = 0; number < guide_count; number++) {
        world->bodies[guides[number].body].own->jointed = true;
    }
    list_jointed(world);
    prepare_springs(world);
}
