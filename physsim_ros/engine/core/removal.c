// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Removal of bodies: the shapes of many leave the engine together.
//
// Problem: for each shape that is removed, Chipmunk searches all contacts that it caches (`cpSpaceFilterArbiters`), and
// for each contact that it finds there, those of the last sub-step. Of 13,000 discs that touch, half took 5 s.
// Method: the contacts of all these shapes are given to one of them. The others are removed while the cache has no
// size, so that a search goes through no list (`cpHashSetFilter`), and that one last, by the only search. Bodies that
// touched one of them may have lost their support.
// Scope: outside of a step. Nobody listens to contacts that end (`cpCollisionHandler.separateFunc`).
// Cost: 0.1 µs a contact of the space, and 1 µs a shape.
// It can go when Chipmunk (Munk2D in Pymunk 7.3.1) finds the contacts of a shape without a search.

#include "stages.h"
#include <stdlib.h>

// The bodies whose shapes are removed, by address, and the shape that gets their contacts.
typedef struct Removal {
    cpBody **bodies;
    int count;
    cpShape *last;
} Removal;

static int by_address(const void *one, const void *other) {
    uintptr_t x = (uintptr_t)*(cpBody *const *)one, y = (uintptr_t)*(cpBody *const *)other;
    return (x > y) - (x < y);
}

static bool is_removed(const Removal *removal, const cpBody *body) {
    size_t count = (size_t)removal->count;
    return bsearch((const void *)&body, (const void *)removal->bodies, count, sizeof(cpBody *), by_address) != NULL;
}

static cpArbiterThread *thread_of(cpArbiter *arbiter, const cpBody *body) {
    return arbiter->body_a == body ? &arbiter->thread_a : &arbiter->thread_b;
}

// Take a contact out of the list of a body, as `cpArbiterUnthread` does.
static void unthread(cpArbiter *arbiter, cpBody *body) {
    cpArbiterThread *thread = thread_of(arbiter, body);
    if (thread->prev != NULL) {
        thread_of(thread->prev, body)->next = thread->next;
    } else if (body->arbiterList == arbiter) {
        body->arbiterList = thread->next;
    }
    if (thread->next != NULL) {
        thread_of(thread->next, body)->prev = thread->prev;
    }
    *thread = (cpArbiterThread){0};
}

static void give_to_last(cpArbiter *arbiter, void *data) {
    const Removal *removal = data;
    if (is_removed(removal, arbiter->body_a) || is_removed(removal, arbiter->body_b)) {
        unthread(arbiter, arbiter->body_a);
        unthread(arbiter, arbiter->body_b);
        arbiter->a = arbiter->b = removal->last;
        arbiter->body_a = arbiter->body_b = removal->last->body;
    }
}

// Wake what touches a body, and note that it may have lost its support.
static void release_around(World *world, cpBody *body) {
    world->chipmunk.body_activate(body);
    for (cpArbiter *each = body->arbiterList; each != NULL; each = next_of(each, body)) {
        cpBody *other = other_of(each, body);
        world->chipmunk.body_activate(other);
        body_of(other)->state.released = true;
    }
}

static void remove_shapes(World *world, cpBody **bodies, int count, const cpShape *last) {
    for (int number = 0; number < count; number++) {
        for (cpShape *shape = bodies[number]->shapeList, *next = NULL; shape != NULL; shape = next) {
            next = shape->next;
            if (shape != last) {
                world->chipmunk.remove_shape(world->space, shape);
            }
        }
    }
}

void core_remove_shapes(World *world, cpBody **bodies, int32_t count) {
    cpSpace *space = world->space;
    reset_memory(world);
    Removal removal = {TAKE(&world->own->arena, cpBody *, count), count, bodies[0]->shapeList};
    for (int number = 0; number < count; number++) {
        removal.bodies[number] = bodies[number];
    }
    assert(count > 0 && removal.last != NULL);
    sort((void *)removal.bodies, count, sizeof(cpBody *), by_address);
    for (int number = 0; number < count; number++) {
        release_around(world, bodies[number]);
    }
    world->chipmunk.each_arbiter(space, give_to_last, &removal);
    int kept = 0;
    for (int number = 0; number < space->arbiters->num; number++) {
        cpArbiter *each = space->arbiters->arr[number];
        if (each->a != removal.last || each->b != removal.last) {
            space->arbiters->arr[kept++] = each;
        }
    }
    unsigned int size = space->cachedArbiters->size;
    space->arbiters->num = 0;
    space->cachedArbiters->size = 0;
    remove_shapes(world, bodies, count, removal.last);
    space->cachedArbiters->size = size;
    world->chipmunk.remove_shape(space, removal.last);
    space->arbiters->num = kept;
}
