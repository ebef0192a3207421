// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// What tests call; it stands behind all sources of the core, in one translation unit (`one_unit.py`).

#include "calls.h"
#include "boxes.h"
#include "elimination_order.h"
#include "immersion.h"
#include "impact_islands.h"
#include "lcp.h"
#include "mixed_lcp.h"
#include "time_of_impact.h"
#include <stdlib.h>
#include <string.h>

void call_ldl(int size, const int *starts, const int *rows, double *values, double *diagonal, double *x) {
    Arena arena = {0};
    Ldl system = {.size = size, .starts = starts, .rows = rows, .values = values, .diagonal = diagonal};
    ldl_analyse(&system, &arena);
    ldl_factor(&system);
    ldl_solve(&system, x);
    arena_free(&arena);
}

_Bool call_lcp(int count, double matrix[LCP_ROWS][LCP_ROWS], const double *rates, double *impulses) {
    return solve_lcp(count, matrix, rates, impulses);
}

int call_mixed_lcp(int body_count, const double *inverses, int row_count, const int *ends, const int *groups,
                   const double *jacobians, const double *wanted, const double *lower, const double *upper,
                   const double *softness, double *impulses, double *changes) {
    Arena arena = {0};
    // No row has further links.
    int *further = TAKE(&arena, int, row_count + 1);
    for (int row = 0; row <= row_count; row++) {
        further[row] = row_count;
    }
    Layout layout = {body_count, row_count, (const Inverse *)inverses, (const Ends *)ends, further, groups};
    System former = system_of(&arena, layout, NULL), system = system_of(&arena, layout, &former);
    begin_system(&system, layout.inverses);
    Problem problem = {(const Jacobian *)jacobians, wanted, lower, upper, softness, NULL, NULL};
    Solution solution = solution_for(&system, &arena);
    solve_problem(&system, &problem, &solution, &arena);
    memcpy(impulses, solution.impulses, (size_t)row_count * sizeof(double));
    memcpy(changes, solution.changes, (size_t)body_count * sizeof(Twist));
    int wrong = solution.wrong_count;
    arena_free(&arena);
    return wrong;
}

void call_elimination_order(int count, const int *weights, const int *starts, const int *neighbours, int *order) {
    Arena arena = {0};
    memcpy(order, elimination_order((Graph){count, weights, starts, neighbours}, &arena), (size_t)count * sizeof(int));
    arena_free(&arena);
}

typedef struct Found {
    int *numbers, count;
} Found;

static bool add_found(int number, void *data) {
    Found *found = data;
    found->numbers[found->count++] = number;
    return true;
}

int call_boxes(int count, const double *boxes, int changed, const double *replacement, const double *box, int *found) {
    Arena arena = {0};
    Tree tree = tree_of((const Box *)boxes, count, &arena);
    tree_set(&tree, changed, *(const Box *)replacement);
    Found all = {found, 0};
    tree_query(&tree, *(const Box *)box, add_found, &all);
    arena_free(&arena);
    return all.count;
}

// What a mover of one convex shape points to.
typedef struct Shaped {
    int kind;
    cpPolyShape polygon;
    cpBody engine;
    Body body;
    Mover mover;
} Shaped;

static void shape_case(Shaped *shaped, const Case *given, Arena *arena) {
    shaped->kind = SHAPE_POLYGON;
    shaped->polygon.shape.klass = &shaped->kind;
    shaped->polygon.r = given->radius;
    shaped->polygon.count = given->count;
    shaped->polygon.planes = TAKE(arena, cpSplittingPlane, 2 * given->count);
    for (int number = 0; number < given->count; number++) {
        const double *corner = given->corners + (ptrdiff_t)2 * number, *normal = given->normals + (ptrdiff_t)2 * number;
        shaped->polygon.planes[given->count + number] =
            (cpSplittingPlane){{corner[0], corner[1]}, {normal[0], normal[1]}};
    }
    shaped->body.engine = &shaped->engine;
    shaped->mover = (Mover){.body = &shaped->body, .shape = &shaped->polygon.shape};
    shaped->mover.pose = (Pose){{given->pose[0], given->pose[1]}, given->pose[2]};
    shaped->mover.pivot = shaped->mover.pose.p;
    shaped->mover.rate = (Twist){{given->change[0], given->change[1]}, given->change[2]};
}

double call_time_of_impact(const Case *one, const Case *other, double slop, double depth) {
    Private own = {0};
    cpSpace space = {.collisionSlop = slop};
    World world = {.space = &space, .own = &own};
    Shaped a = {0}, b = {0};
    Arena planes = {0};
    shape_case(&a, one, &planes);
    shape_case(&b, other, &planes);
    double share = first_impact(&world, &a.mover, &b.mover, depth);
    arena_free(&planes);
    arena_free(&own.arena);
    return share;
}

double call_immersed(const Case *given, const Case *region) {
    Arena arena = {0};
    Shaped inner = {0}, outer = {0};
    shape_case(&inner, given, &arena);
    shape_case(&outer, region, &arena);
    outer.polygon.shape.body = &outer.engine;
    inner.engine.shapeList = &inner.polygon.shape;
    for (int number = 0; number < given->count; number++) {
        Vec corner = corner_on_body(&inner.polygon.shape, number).point;
        inner.body.reach = greatest(inner.body.reach, length(corner));
    }
    Basin basin = basin_of(NULL, &outer.polygon.shape, outer.mover.pose, &arena);
    double area = immersed(&inner.body, inner.mover.pose, &basin, true, &arena).area;
    arena_free(&arena);
    return area;
}

int call_join_impacts(int pair_count) {
    Private own = {0};
    cpSpace space = {.collisionSlop = 1e-3};
    World world = {.space = &space, .own = &own};
    Statics statics = {0};
    int kind = SHAPE_CIRCLE, count = 2 * pair_count, met = 0, *fast = TAKE(&own.arena, int, count);
    cpCircleShape disc = {.shape = {.klass = &kind}, .r = 0.1};
    cpBody engine = {.m = 1.0, .i = 1.0, .shapeList = &disc.shape};
    Body body = {.engine = &engine, .dynamic = true, .reach = 0.1, .safe_depth = 0.02, .pieces = 1.0, .corners = 1.0};
    Sweep sweep = {.world = &world, .count = count, .movers = TAKE(&own.arena, Mover, count), .statics = &statics};
    Box *boxes = TAKE(&own.arena, Box, count);
    sweep.followed = TAKE(&own.arena, bool, count);
    for (int number = 0; number < count; number++) {
        double side = number % 2 == 0 ? -1.0 : 1.0;
        div_t pair = div(number / 2, 100);
        engine.p = vec(10.0 * pair.rem + 0.6 * side, 10.0 * pair.quot);
        sweep.movers[number] = mover_of(&body, (Twist){{-side, 0.0}, 0.0});
        sweep.movers[number].island = fast[number] = number;
        boxes[number] = sweep.movers[number].box;
    }
    sweep.tree = tree_of(boxes, count, &own.arena);
    join_impacts(&sweep, fast, count);
    for (int number = 0; number < count; number++) {
        met += sweep.movers[number].met;
    }
    arena_free(&own.arena);
    return met;
}
