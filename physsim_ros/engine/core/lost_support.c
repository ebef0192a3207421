// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Support graph: what falls freely because what it rested on was removed.
//
// Problem: where a floor, an anchor or a joint is removed, Chipmunk still warm starts with the impulses that carried
// the pile on it, which would accelerate its bodies upward; and a body that falls from that moment on has no lead
// yet, so that its reported velocity would begin with half a sub-step of gravity upward.
// Method: bodies that contacts or joints tie to nothing that stands are in free fall as one, without the impulses of
// the sub-step before; a search for that moment only.
// Cost: all contacts and joints, and a search for the neighbours of each body that may have lost its support.

#include "lost_support.h"

// Bodies that support each other.
typedef struct Support {
    World *world;
    int *parents;
    int released; // place of the body whose neighbours are looked for
    // (body_count): place of the released body that touched a body last, and that pressed on it last, counted from 1.
    int *touching, *pressing;
} Support;

// Note which bodies touched a released one in the last sub-step.
static void note_contacts(const Support *support) {
    const cpBody *engine = support->world->bodies[support->released].engine;
    for (const cpArbiter *each = engine->arbiterList; each != NULL; each = next_of(each, engine)) {
        int other = place_of(support->world, other_of(each, engine));
        support->touching[other] = support->released + 1;
        if (presses(each)) {
            support->pressing[other] = support->released + 1;
        }
    }
}

static void support_by(cpShape *shape, void *points, void *data) {
    (void)points;
    const Support *support = data;
    int other = place_of(support->world, shape->body), mark = support->released + 1;
    // A body that touched it without pressing only lies beside it.
    bool lies_beside = support->touching[other] == mark && support->pressing[other] != mark;
    if (!shape->sensor && other != support->released && !lies_beside) {
        unite(support->parents, support->released, other);
    }
}

// Unite bodies by their joints, and by the contacts that pressed on them but those of released bodies.
static void unite_supported(const World *world, int *parents) {
    for (int number = 0; number < arbiter_count(world); number++) {
        const cpArbiter *each = arbiter_at(world, number);
        if (!is_loose(body_of(each->body_a)) && !is_loose(body_of(each->body_b)) && presses(each)) {
            unite(parents, place_of(world, each->body_a), place_of(world, each->body_b));
        }
    }
    for (int number = 0; number < world->joint_count; number++) {
        unite(parents, world->joints[number].a, world->joints[number].b);
    }
}

// Unite a released body with its neighbours, which are searched for anew, as the next sub-step finds them.
static void unite_released(Support *support, int place) {
    World *world = support->world;
    support->released = place;
    note_contacts(support);
    for (cpShape *shape = world->bodies[place].engine->shapeList; shape != NULL; shape = shape->next) {
        if (!shape->sensor) {
            world->chipmunk.shape_query(world->space, shape, support_by, support);
        }
    }
}

void find_unsupported(World *world, uint8_t *unsupported) {
    Arena *arena = &world->own->arena;
    Support support = {.world = world,
                       .parents = sets_of(world),
                       .touching = TAKE(arena, int, world->body_count),
                       .pressing = TAKE(arena, int, world->body_count)};
    unite_supported(world, support.parents);
    for (int place = 0; place < world->body_count; place++) {
        if (is_loose(world->bodies + place)) {
            unite_released(&support, place);
        }
    }
    bool *stands = TAKE(arena, bool, world->body_count), *falls = TAKE(arena, bool, world->body_count);
    for (int place = 0; place < world->body_count; place++) {
        const Body *body = world->bodies + place;
        int root = root_of(support.parents, place);
        stands[root] = stands[root] || !body->dynamic;
        falls[root] = falls[root] || is_loose(body);
    }
    for (int place = 0; place < world->body_count; place++) {
        int root = root_of(support.parents, place);
        unsupported[place] = falls[root] && !stands[root];
    }
}
