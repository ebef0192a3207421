// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#include "world.h"
#include "joint_parts.h"
#include <stdlib.h>
#include <string.h>

typedef struct Slot {
    const cpBody *body; // NULL is free
    int place;
} Slot;

static void *allocated(size_t count, size_t size) {
    void *memory = calloc(count > 0 ? count : 1, size);
    if (memory == NULL) {
        abort(); // as every allocation of Chipmunk's does
    }
    return memory;
}

const char *core_sources(void) {
    return CORE_SOURCES;
}

World *core_new(cpSpace *space, double dt) {
    World *world = allocated(1, sizeof(World));
    world->space = space;
    world->dt = dt;
    world->own = allocated(1, sizeof(Private));
    return world;
}

void core_free(World *world) {
    arena_free(&world->own->arena);
    free(world->own->slots);
    free(world->own->jointed);
    free(world->own);
    free(world);
}

// Where a body is in the hash table, or belongs (Fibonacci hashing; Knuth, The Art of Computer Programming 3, 6.4).
static Slot *slot_of(const Private *own, const cpBody *body) {
    uintptr_t mask = own->slot_count - 1;
    uintptr_t slot = (((uintptr_t)body >> 4U) * (uintptr_t)0x9E3779B97F4A7C15U >> 20U) & mask;
    while (own->slots[slot].body != NULL && own->slots[slot].body != body) {
        slot = (slot + 1) & mask;
    }
    return own->slots + slot;
}

int place_of(const World *world, const cpBody *body) {
    return slot_of(world->own, body)->place;
}

void core_use_bodies(World *world, Body *bodies, int32_t count) {
    Private *own = world->own;
    world->bodies = bodies;
    world->body_count = count;
    own->slot_count = 4;
    while (own->slot_count < 2 * (uintptr_t)count) {
        own->slot_count *= 2;
    }
    free(own->slots);
    own->slots = allocated(own->slot_count, sizeof(Slot));
    for (int place = 0; place < count; place++) {
        *slot_of(own, bodies[place].engine) = (Slot){bodies[place].engine, place};
    }
}

void core_use_joints(World *world, Joint *joints, int32_t joint_count, Part *parts, int32_t part_count, Row *rows,
                     int32_t row_count) {
    Private *own = world->own;
    world->joints = joints;
    world->joint_count = joint_count;
    world->parts = parts;
    world->part_count = part_count;
    world->rows = rows;
    world->row_count = row_count;
    free(own->jointed);
    own->jointed = allocated(2 * (size_t)joint_count, sizeof(int));
    own->jointed_count = 0;
    for (int place = 0; place < world->body_count; place++) {
        world->bodies[place].jointed = false;
    }
    for (int number = 0; number < joint_count; number++) {
        int ends[2] = {joints[number].a, joints[number].b};
        for (int end = 0; end < 2 && joints[number].row_count > 0; end++) {
            Body *body = world->bodies + ends[end];
            if (body->dynamic && !body->jointed) {
                own->jointed[own->jointed_count++] = ends[end];
            }
            body->jointed = true;
        }
    }
    prepare_springs(world);
}

void set_pose(cpBody *body, Pose pose) {
    Rotation by = rotation(pose.yaw);
    body->p = pose.p;
    body->a = pose.yaw;
    body->transform = (cpTransform){by.c, by.s, -by.s, by.c, pose.p.x, pose.p.y};
}
