// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// What tests call; it stands behind all sources of the core, in one translation unit (`conftest.py`).

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

static bool take_full(Arena *arena, int size) {
    unsigned char *piece = TAKE(arena, unsigned char, size);
    bool good = (uintptr_t)piece % 16 == 0;
    for (int byte = 0; byte < size; byte++) {
        good = good && piece[byte] == 0;
        piece[byte] = 255;
    }
    return good;
}

_Bool call_arena(int count, const int *sizes, int kept) {
    Arena arena = {0};
    bool good = true;
    for (int step = 0; step < 3; step++) {
        size_t mark = 0;
        for (int number = 0; number < 2 * count - kept; number++) {
            if (number == kept) {
                mark = arena_mark(&arena);
            }
            if (number == count) {
                arena_release(&arena, mark);
            }
            good = take_full(&arena, sizes[number < count ? number : number - count + kept]) && good;
        }
        // The arena of checked runs (`tools/sanitize/arena.c`) has no size.
        good = good && (step == 0 || arena.size == 0 || arena.extra == NULL);
        arena_reset(&arena);
    }
    arena_free(&arena);
    return good;
}

void call_sets(int count, int pair_count, const int *pairs, int *roots) {
    Private own = {0};
    World world = {.body_count = count, .own = &own};
    int *parents = sets_of(&world);
    for (int pair = 0; pair < pair_count; pair++) {
        unite(parents, pairs[2 * (size_t)pair], pairs[2 * (size_t)pair + 1]);
    }
    for (int number = 0; number < count; number++) {
        roots[number] = root_of(parents, number);
    }
    arena_free(&own.arena);
}

void call_ldl(int size, const int *starts, const int *rows, double *former_values, double *former_diagonal,
              double *values, double *diagonal, double *x) {
    Arena arena = {0};
    Ldl ldl = {.size = size, .starts = starts, .rows = rows, .values = former_values, .diagonal = former_diagonal};
    ldl_analyse(&ldl, &arena);
    ldl_factor(&ldl);
    for (int column = 0; column < size; column++) {
        ldl.changed[column] = diagonal[column] != former_diagonal[column];
        for (int entry = starts[column]; entry < starts[column + 1]; entry++) {
            ldl.changed[column] = ldl.changed[column] || values[entry] != former_values[entry];
        }
    }
    ldl.values = values;
    ldl.diagonal = diagonal;
    ldl_factor(&ldl);
    ldl_solve(&ldl, x);
    arena_free(&arena);
}

_Bool call_lcp(int count, double matrix[LCP_ROWS][LCP_ROWS], const double *rates, double *impulses) {
    return solve_lcp(count, matrix, rates, impulses);
}

int call_mixed_lcp(int body_count, const double *inverses, int row_count, const int *ends, const int *former_ends,
                   const int *groups, const double *jacobians, const double *wanted, const double *lower,
                   const double *upper, const double *softness, double *impulses, double *changes) {
    Arena arena = {0};
    // No row has further links.
    int *further = TAKE(&arena, int, row_count + 1);
    for (int row = 0; row <= row_count; row++) {
        further[row] = row_count;
    }
    Layout former = {body_count, row_count, (const Inverse *)inverses, (const Ends *)former_ends, further, groups};
    Layout layout = former;
    layout.ends = (const Ends *)ends;
    System system = system_of(&arena, former);
    if (!has_layout(&system, layout)) {
        system = system_of(&arena, layout);
    }
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
    int *numbers, count, most;
} Found;

static bool add_found(int number, void *data) {
    Found *found = data;
    found->numbers[found->count++] = number;
    return found->count < found->most;
}

int call_boxes(int count, const double *boxes, int changed, const double *replacement, const double *box, int most,
               int *found) {
    Arena arena = {0};
    Tree tree = tree_of((const Box *)boxes, count, &arena);
    tree_set(&tree, changed, *(const Box *)replacement);
    Found all = {found, 0, most};
    tree_query(&tree, *(const Box *)box, add_found, &all);
    arena_free(&arena);
    return all.count;
}

// What a mover of one convex shape points to.
typedef struct Shaped {
    int kind;
    union {
        cpShape shape;
        cpCircleShape disc;
        cpSegmentShape segment;
        cpPolyShape polygon;
    };
    cpBody engine;
    Body body;
    Mover mover;
} Shaped;

static void shape_case(Shaped *shaped, const Case *given, Arena *arena) {
    const Vec *corners = (const Vec *)given->corners, *normals = (const Vec *)given->normals;
    shaped->kind = given->count == 1 ? SHAPE_CIRCLE : given->count == 2 ? SHAPE_SEGMENT : SHAPE_POLYGON;
    shaped->shape.klass = &shaped->kind;
    shaped->shape.body = &shaped->engine;
    shaped->engine.shapeList = &shaped->shape;
    shaped->body.engine = &shaped->engine;
    for (int number = 0; number < given->count; number++) {
        shaped->body.reach = greatest(shaped->body.reach, length(corners[number]) + given->radius);
    }
    if (given->count == 1) {
        shaped->disc.c = corners[0];
        shaped->disc.r = given->radius;
    } else if (given->count == 2) {
        shaped->segment.a = corners[0];
        shaped->segment.b = corners[1];
        shaped->segment.n = normals[1];
        shaped->segment.r = given->radius;
    } else {
        shaped->polygon.r = given->radius;
        shaped->polygon.count = given->count;
        shaped->polygon.planes = TAKE(arena, cpSplittingPlane, 2 * given->count);
        for (int number = 0; number < given->count; number++) {
            shaped->polygon.planes[given->count + number] = (cpSplittingPlane){corners[number], normals[number]};
        }
    }
    shaped->mover = (Mover){.body = &shaped->body, .shape = &shaped->shape};
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

void call_immersed(const Case *given, const Case *region, double *found) {
    Arena arena = {0};
    Shaped inner = {0}, outer = {0};
    shape_case(&inner, given, &arena);
    Basin basin = {0};
    if (region != NULL) {
        shape_case(&outer, region, &arena);
        basin = basin_of(NULL, &outer.shape, outer.mover.pose, &arena);
    }
    Immersion wet = immersed(&inner.body, inner.mover.pose, region == NULL ? NULL : &basin, true, &arena);
    double outline = 0.0;
    for (int number = 0; number < wet.side_count; number++) {
        outline += length(sub(wet.sides[number].end, wet.sides[number].begin));
    }
    for (int number = 0; number < wet.bow_count; number++) {
        outline += wet.bows[number].radius * (wet.bows[number].to - wet.bows[number].from);
    }
    found[0] = wet.area;
    found[1] = wet.first_moment.x;
    found[2] = wet.first_moment.y;
    found[3] = outline;
    arena_free(&arena);
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
        sweep.movers[number] = mover_of(&body, pose_of(&engine), (Twist){{-side, 0.0}, 0.0});
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
