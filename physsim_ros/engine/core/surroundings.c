// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// What pedestrians see of a world.

#include "surroundings.h"
#include "outline.h"

Robot *robot_of(const World *world, const Actor *actor) {
    return actor->robot < 0 ? NULL : world->robots + actor->robot;
}

Vec arm_of(const World *world, const Actor *actor) {
    const Robot *robot = robot_of(world, actor);
    if (robot == NULL) {
        return (Vec){0};
    }
    Vec local = {actor->ahead - robot->center.x, -robot->center.y};
    return rotated(local, rotation(world->bodies[actor->body].engine->a));
}

bool has_begun(const World *world, const Actor *actor) {
    return actor->state.begun <= world->step;
}

bool sees_wall(const World *world, const cpShape *wall, const Body *self, Vec point, Nearest *nearest) {
    double x = greatest(greatest(wall->bb[0] - point.x, point.x - wall->bb[2]), 0.0);
    double y = greatest(greatest(wall->bb[1] - point.y, point.y - wall->bb[3]), 0.0);
    if (greatest(x, y) > farthest_seen || passes_through(self, body_of(wall->body))) {
        return false;
    }
    cpPointQueryInfo found;
    world->chipmunk.point_query(wall, point, &found);
    *nearest = (Nearest){found.distance, found.gradient};
    return true;
}

double distance_beside(const cpShape *wall, Vec point, Vec ahead) {
    double left = -INFINITY, right = INFINITY;
    for (int number = 0; number < corner_count(wall); number++) {
        double across = cross(ahead, sub(corner_in_world(wall, number).point, point));
        left = greatest(left, across);
        right = least(right, across);
    }
    return greatest(right, -left) - radius_of(wall);
}

static bool is_anchored_disc(const Body *body) {
    const cpShape *shape = body->engine->shapeList;
    return body->anchored && shape != NULL && shape->next == NULL && kind_of(shape) == SHAPE_CIRCLE;
}

// The arm from the origin of the engine to the centre of a disc: the engine's origin of an anchored body is its own.
static Vec to_center(const Body *body) {
    Vec center = body->anchored ? ((const cpCircleShape *)body->engine->shapeList)->c : (Vec){0};
    return rotated(center, rotation(body->engine->a));
}

// What pedestrians see of a body that they walk around; `own` is its actor, or NULL.
static Disc disc_of(const World *world, const Body *body, const Actor *own) {
    const cpBody *engine = body->engine;
    if (own == NULL) {
        Vec arm = to_center(body);
        double radius = body->reach - length(arm);
        return (Disc){body, add(engine->p, arm), velocity_at(twist_of(engine), arm), radius, false};
    }
    Vec arm = arm_of(world, own);
    bool walks = own->kind != ACTOR_PATH && has_begun(world, own);
    return (Disc){body, add(engine->p, arm), velocity_at(twist_of(engine), arm), body->reach + own->ahead, walks};
}

Surroundings surroundings_of(World *world) {
    Arena *arena = &world->own->arena;
    int anchored_count = anchored_shape_count(world);
    Surroundings around = {.discs = TAKE(arena, Disc, world->body_count),
                           .walls = TAKE(arena, const cpShape *, anchored_count),
                           .anchored = TAKE(arena, const cpShape *, anchored_count),
                           .seen = TAKE(arena, Seen, anchored_count)};
    for (int list = 0; list < 2; list++) {
        around.planes[list] = TAKE(arena, HalfPlane, 2 * world->body_count + anchored_count);
    }
    const Actor *actor = world->actors, *last = actor + world->actor_count;
    for (int place = 0; place < world->body_count; place++) {
        const Body *body = world->bodies + place;
        const Actor *own = actor < last && actor->body == place ? actor++ : NULL;
        // A pedestrian is no sensor (`simulation/world/body_description.py`), and is found here.
        if (body->sensor && own == NULL) {
            continue;
        }
        bool is_disc = !body->anchored || is_anchored_disc(body);
        if (is_disc) {
            around.discs[around.disc_count++] = disc_of(world, body, own);
        }
        const cpShape *shape = body->anchored ? body->engine->shapeList : NULL;
        for (; shape != NULL; shape = shape->next) {
            around.anchored[around.anchored_count++] = shape;
            if (!is_disc) {
                around.walls[around.wall_count++] = shape;
            }
        }
    }
    assert(actor == last && around.anchored_count <= anchored_count);
    return around;
}
