// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Swept boxes: which bodies could meet in the coming sub-step, at a bounded cost.
//
// Problem: boxes of fast bodies span the world, so that n bodies make n² pairs in a sub-step that no signal ends.
// Method: an island has a budget of pairs, shared by its fast bodies. A body whose swept box meets more than its
// share is followed not to the end of the sub-step, but to a *horizon*, at which the box meets its share; Chipmunk's
// own result holds from there on. Known engines bound the same by a greatest speed of bodies (`b2_maxTranslation` in
// Box2D, 2 m a step; Jolt's `mMaxLinearVelocity`), but here every finite velocity is a velocity.
// Laws: a horizon follows from what a body itself could meet, and a body that meets little is followed to the end,
// however fast it is and however many others there are elsewhere.

#include "swept_boxes.h"

// Corners that an island may go through in a round of impacts, those of both shapes for each pair of convex shapes:
// those of 125 boxes that all may meet each other, or of one box and 15,000 others.
static const double budget = 125000.0;
// Greatest count of cuts of a horizon, by half each, after which a body is not followed at all.
enum { CUTS = 8 };

static Mover static_mover(Body *body, const cpShape *shape) {
    const double *bb = shape->bb;
    Box box = {{bb[0], bb[1]}, {bb[2], bb[3]}};
    Vec middle = scaled(add(box.low, box.high), 0.5);
    return (Mover){.body = body,
                   .shape = shape,
                   .pose = pose_of(body->engine),
                   .pivot = body->engine->p,
                   .depth = body->safe_depth,
                   .shapes = 1.0,
                   .corners = greatest(corner_count(shape), ROUND_COST),
                   .horizon = 1.0,
                   .start = middle,
                   .end = middle,
                   .half = scaled(sub(box.high, box.low), 0.5),
                   .box = box,
                   .island = -1,
                   .next = -1,
                   .leader = -1};
}

const Statics *statics_of(World *world) {
    Private *own = world->own;
    Arena *arena = &own->static_arena;
    if (own->statics != NULL && !world->statics_moved) {
        return own->statics;
    }
    arena_reset(arena);
    int room = anchored_shape_count(world);
    own->statics = TAKE(arena, Statics, 1);
    own->statics->movers = TAKE(arena, Mover, room);
    Box *boxes = TAKE(arena, Box, room);
    for (int place = 0; place < world->body_count; place++) {
        Body *body = world->bodies + place;
        const cpShape *shape = body->anchored && !body->sensor ? body->engine->shapeList : NULL;
        for (; shape != NULL; shape = shape->next) {
            Mover mover = static_mover(body, shape);
            boxes[own->statics->count] = mover.box;
            own->statics->movers[own->statics->count++] = mover;
        }
    }
    assert(own->statics->count <= room);
    own->statics->tree = tree_of(boxes, own->statics->count, arena);
    world->statics_moved = false;
    return own->statics;
}

void fit_box(Mover *mover) {
    Vec pivot;
    mover->horizon = greatest(mover->horizon, mover->since);
    mover->start = mover->pose.p;
    mover->end = pose_at(mover, mover->horizon, &pivot).p;
    // Height of the arc over its chord, at most.
    double arm = length(sub(mover->start, mover->pivot)), turn = mover->rate.w;
    double margin = mover->body->reach + arm * turn * turn / 8.0;
    mover->half = vec(margin, margin);
    mover->box = box_of_way(mover->start, mover->end, margin);
}

// Convex shapes, and corners of them.
typedef struct Amount {
    double shapes, corners;
} Amount;

static void add_amount(Amount *amount, const Mover *mover) {
    amount->shapes += mover->shapes;
    amount->corners += mover->corners;
}

// The corners of all pairs of a shape of the first and a shape of the second amount.
static double corners_of_pairs(Amount one, Amount other) {
    return one.shapes * other.corners + other.shapes * one.corners;
}

// What is near a body, and what of that is fast.
typedef struct Cost {
    const Sweep *sweep;
    int offset; // number of the first member of the tree
    Amount near, fast;
} Cost;

static bool add_cost(int number, void *data) {
    Cost *cost = data;
    number += cost->offset;
    const Mover *mover = mover_at(cost->sweep, number);
    add_amount(&cost->near, mover);
    if (number < cost->sweep->count && cost->sweep->followed[number]) {
        add_amount(&cost->fast, mover);
    }
    return corners_of_pairs(cost->near, cost->fast) <= budget;
}

// Whether a body may meet more than the budget permits: pairs of what is near it with what is fast there.
static bool costs_too_much(const Sweep *sweep, const Mover *mover) {
    Cost cost = {.sweep = sweep, .offset = 0};
    tree_query(&sweep->tree, mover->box, add_cost, &cost);
    cost.offset = sweep->count;
    if (corners_of_pairs(cost.near, cost.fast) <= budget) {
        tree_query(&sweep->statics->tree, mover->box, add_cost, &cost);
    }
    return corners_of_pairs(cost.near, cost.fast) > budget;
}

void cut_horizons(Sweep *sweep, const int *bodies, int count) {
    Amount all = {0}, fast = {0};
    for (int number = 0; number < sweep->count + sweep->statics->count; number++) {
        add_amount(&all, mover_at(sweep, number));
    }
    for (int number = 0; number < sweep->count; number++) {
        sweep->followed[number] = false;
    }
    for (int number = 0; number < count; number++) {
        sweep->followed[bodies[number]] = true;
        add_amount(&fast, sweep->movers + bodies[number]);
    }
    // If all fit the budget together, each does.
    if (corners_of_pairs(fast, all) <= budget) {
        return;
    }
    bool *crowded = TAKE(&sweep->world->own->arena, bool, count);
    for (int cut = 0; cut <= CUTS; cut++) {
        bool any = false;
        for (int number = 0; number < count; number++) {
            crowded[number] = costs_too_much(sweep, sweep->movers + bodies[number]);
            any = any || crowded[number];
        }
        for (int number = 0; number < count && any; number++) {
            Mover *mover = sweep->movers + bodies[number];
            if (crowded[number] && cut < CUTS) {
                mover->horizon = mover->since + (mover->horizon - mover->since) / 2.0;
                fit_box(mover);
                tree_set(&sweep->tree, bodies[number], mover->box);
            } else if (crowded[number]) {
                sweep->followed[bodies[number]] = false;
            }
        }
        if (!any) {
            return;
        }
    }
}

// The centre of a box at a share of the sub-step, on a straight line [m].
static Vec center_at(const Mover *mover, double share) {
    double lapse = mover->horizon - mover->since;
    double part = (share - mover->since) / (lapse > 0.0 ? lapse : 1.0);
    return add(mover->start, scaled(sub(mover->end, mover->start), part));
}

// Narrow the time in which two boxes overlap to that in which they do along an axis.
static void narrow(double gap, double displacement, double reach, double *enters, double *leaves) {
    if (displacement == 0.0) {
        *enters = fabs(gap) <= reach ? *enters : INFINITY;
        return;
    }
    double one = (-gap - reach) / displacement, other = (-gap + reach) / displacement;
    *enters = greatest(*enters, least(one, other));
    *leaves = least(*leaves, greatest(one, other));
}

bool come_near(const Mover *one, const Mover *other) {
    double since = greatest(one->since, other->since), until = least(one->horizon, other->horizon);
    Vec gap = sub(center_at(other, since), center_at(one, since));
    Vec displacement = sub(sub(center_at(other, until), center_at(one, until)), gap),
        reach = add(one->half, other->half);
    double enters = -INFINITY, leaves = INFINITY;
    narrow(gap.x, displacement.x, reach.x, &enters, &leaves);
    narrow(gap.y, displacement.y, reach.y, &enters, &leaves);
    return since <= until && enters <= least(leaves, 1.0) && leaves >= 0.0;
}

Mover mover_of(Body *body, Pose begin, Twist displacement) {
    Mover mover = {.body = body,
                   .movable = body->dynamic,
                   .pose = begin,
                   .pivot = begin.p,
                   .depth = body->safe_depth,
                   .turning = body->turning_radius,
                   .shapes = body->pieces,
                   .corners = body->corners,
                   .horizon = 1.0,
                   .island = -1,
                   .next = -1,
                   .leader = -1};
    // A disc covers the same ground however it turns.
    mover.rate = (Twist){displacement.v, mover.turning > 0.0 ? displacement.w : 0.0};
    fit_box(&mover);
    return mover;
}

Sweep sweep_of(World *world, DisplacementOf *displacement_of) {
    Arena *arena = &world->own->arena;
    Sweep sweep = {.world = world, .statics = statics_of(world), .movers = TAKE(arena, Mover, world->body_count)};
    sweep.followed = TAKE(arena, bool, world->body_count);
    Box *boxes = TAKE(arena, Box, world->body_count);
    for (int place = 0; place < world->body_count; place++) {
        if (is_solid(world->bodies + place)) {
            Body *body = world->bodies + place;
            Mover mover = mover_of(body, pose_of(body->engine), displacement_of(world, body));
            mover.island = sweep.count;
            boxes[sweep.count] = mover.box;
            sweep.movers[sweep.count++] = mover;
        }
    }
    sweep.tree = tree_of(boxes, sweep.count, arena);
    return sweep;
}
