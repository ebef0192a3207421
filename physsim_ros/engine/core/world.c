// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#include "world.h"
#include <stdlib.h>

void *allocated(size_t count, size_t size) {
    void *memory = calloc(count > 0 ? count : 1, size);
    if (memory == NULL) {
        abort(); // as every allocation of Chipmunk's does
    }
    return memory;
}

int compared(int count, const double keys[][2]) {
    int key = 0;
    while (key < count - 1 && keys[key][0] == keys[key][1]) {
        key++;
    }
    return (keys[key][0] > keys[key][1]) - (keys[key][0] < keys[key][1]);
}

int anchored_shape_count(const World *world) {
    int count = 0;
    for (int place = 0; place < world->body_count; place++) {
        const cpShape *shape = world->bodies[place].anchored ? world->bodies[place].engine->shapeList : NULL;
        for (; shape != NULL; shape = shape->next) {
            count++;
        }
    }
    return count;
}

void sort(void *list, int count, size_t size, int (*compare)(const void *, const void *)) {
    if (count > 1) {
        qsort(list, (size_t)count, size, compare);
    }
}

static int by_numbers(const void *one, const void *other) {
    const Pair *a = one, *b = other;
    return compared(2, (double[][2]){{(double)a->low, (double)b->low}, {(double)a->high, (double)b->high}});
}

void sort_pairs(Pair *list, int count) {
    sort(list, count, sizeof(Pair), by_numbers);
}

bool has_pair(const Pair *list, int count, Pair pair) {
    return count > 0 && bsearch(&pair, list, (size_t)count, sizeof(Pair), by_numbers) != NULL;
}

void set_pose(cpBody *body, Pose pose) {
    Rotation by = rotation(pose.yaw);
    body->p = pose.p;
    body->a = pose.yaw;
    body->transform = (cpTransform){by.c, by.s, -by.s, by.c, pose.p.x, pose.p.y};
}

int root_of(int *parents, int place) {
    while (parents[place] != place) {
        assert(parents[place] < place);
        place = parents[place] = parents[parents[place]];
    }
    return place;
}

void unite(int *parents, int a, int b) {
    a = root_of(parents, a);
    b = root_of(parents, b);
    parents[a > b ? a : b] = a > b ? b : a;
}

int *sets_of(World *world) {
    int *parents = TAKE(&world->own->arena, int, world->body_count);
    for (int place = 0; place < world->body_count; place++) {
        parents[place] = place;
    }
    return parents;
}
