// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Islands of bodies that have met in the coming sub-step, and move on as one.
//
// Problem: a body that has met another one meets others as the two move on together.
// Method: rounds. Each finds the impacts to come, and joins those that meet before anything near them does. The two go
// on with their common momentum and angular momentum, or as the anchored or kinematic body that they have met, the
// leader.
// Cost: `swept_boxes.c` bounds the pairs of an island in a round, and `IMPACT_ROUNDS` the rounds; what is near an
// impact is found by a tree.

#include "impact_islands.h"
#include "time_of_impact.h"
#include <string.h>

// Greatest count of successive impacts of a body in a sub-step, as in a row of bodies before a wall. Beyond it
// Chipmunk's own result holds.
enum { IMPACT_ROUNDS = 10 };

// Two movers that meet, and the share of the sub-step at which they do.
typedef struct Impact {
    double share;
    int one, other;
} Impact;

// Impacts to come, in memory of the sub-step that grows.
typedef struct Impacts {
    Sweep *sweep;
    Impact *list;
    int count, room;
    int asking, offset; // the body whose impacts are looked for; number of the first member of the tree
} Impacts;

static void add_impact(Impacts *impacts, Impact impact) {
    if (impacts->count == impacts->room) {
        impacts->room = 2 * impacts->room + 16;
        Impact *list = TAKE(&impacts->sweep->world->own->arena, Impact, impacts->room);
        if (impacts->count > 0) {
            memcpy(list, impacts->list, (size_t)impacts->count * sizeof(Impact));
        }
        impacts->list = list;
    }
    impacts->list[impacts->count++] = impact;
}

// Whether a joint of two bodies keeps them from colliding.
static bool is_excluded_by_joint(const cpBody *a, const cpBody *b) {
    if (b->constraintList == NULL) {
        return false;
    }
    const cpConstraint *each = a->constraintList;
    for (; each != NULL; each = each->a == a ? each->next_a : each->next_b) {
        if (!each->collideBodies && (each->a == b || each->b == b)) {
            return true;
        }
    }
    return false;
}

bool may_meet(const Body *a, const Body *b) {
    return !share_group(a, b) && !is_excluded_by_joint(a->engine, b->engine);
}

// The velocity of the centre of mass where a motion begins [m a sub-step].
static Vec center_rate(const Mover *mover) {
    return velocity_at(mover->rate, sub(mover->pose.p, mover->pivot));
}

// Whether two movers can meet, and are not one island yet.
static bool collide(const Mover *one, const Mover *other) {
    return (one->movable || other->movable) && (one->island != other->island || one->island < 0) &&
           may_meet(one->body, other->body);
}

// By how far two movers approach in the rest of the sub-step, at most [m].
static double approach_left(const Mover *one, const Mover *other) {
    double distance = length(sub(center_rate(one), center_rate(other)));
    distance += fabs(one->rate.w) * one->turning + fabs(other->rate.w) * other->turning;
    return distance * (1.0 - greatest(one->since, other->since));
}

static bool find_impact(int number, void *data) {
    Impacts *impacts = data;
    Sweep *sweep = impacts->sweep;
    number += impacts->offset;
    // Two that are both looked for find each other once.
    if (number == impacts->asking || (number < sweep->count && number < impacts->asking && sweep->followed[number])) {
        return true;
    }
    int low = impacts->asking < number ? impacts->asking : number,
        high = impacts->asking < number ? number : impacts->asking;
    const Mover *one = mover_at(sweep, low), *other = mover_at(sweep, high);
    double depth = least(one->depth, other->depth);
    if (collide(one, other) && approach_left(one, other) > depth && come_near(one, other)) {
        sweep->world->swept++;
        double share = first_impact(sweep->world, one, other, depth);
        if (share < INFINITY) {
            add_impact(impacts, (Impact){share, low, high});
        }
    }
    return true;
}

// Add the impacts to come of bodies whose motions have changed.
static void find_impacts(Impacts *impacts, const int *changed, int count) {
    Sweep *sweep = impacts->sweep;
    cut_horizons(sweep, changed, count);
    for (int number = 0; number < count; number++) {
        if (sweep->followed[changed[number]]) {
            Box box = sweep->movers[changed[number]].box;
            impacts->asking = changed[number];
            impacts->offset = 0;
            tree_query(&sweep->tree, box, find_impact, impacts);
            impacts->offset = sweep->count;
            tree_query(&sweep->statics->tree, box, find_impact, impacts);
        }
    }
}

static int by_share(const void *one, const void *other) {
    const Impact *a = one, *b = other;
    if (a->share != b->share) {
        return a->share < b->share ? -1 : 1;
    }
    return a->one != b->one ? a->one - b->one : a->other - b->other;
}

// The common motion of the members of an island, with the momentum and angular momentum that they have: its centre of
// mass, its displacement and their rotation in a sub-step.
static Twist common_motion(const Sweep *sweep, const int *members, int count, double share, Vec *center) {
    double mass = 0.0, moment = 0.0, angular = 0.0;
    Vec sum = {0.0, 0.0}, momentum = {0.0, 0.0};
    for (int number = 0; number < count; number++) {
        const Mover *mover = sweep->movers + members[number];
        Vec pivot;
        Pose pose = pose_at(mover, share, &pivot);
        double own = mover->body->engine->m;
        mass += own;
        sum = add(sum, scaled(pose.p, own));
        momentum = add(momentum, scaled(velocity_at(mover->rate, sub(pose.p, pivot)), own));
    }
    *center = scaled(sum, 1.0 / mass);
    Vec displacement = scaled(momentum, 1.0 / mass);
    for (int number = 0; number < count; number++) {
        const Mover *mover = sweep->movers + members[number];
        Vec pivot;
        Pose pose = pose_at(mover, share, &pivot);
        double own = mover->turning > 0.0 ? mover->body->engine->i : 0.0;
        Vec arm = sub(pose.p, *center), relative = sub(velocity_at(mover->rate, sub(pose.p, pivot)), displacement);
        angular += own * mover->rate.w + mover->body->engine->m * cross(arm, relative);
        moment += own + mover->body->engine->m * dot(arm, arm);
    }
    return (Twist){displacement, moment > 0.0 ? angular / moment : 0.0};
}

// List the members of the islands of two movers, those that forces move; an earlier impact may have made them one.
static int list_members(const Sweep *sweep, Impact impact, int *members) {
    int count = 0, ends[2] = {impact.one, impact.other};
    bool are_one = mover_at(sweep, impact.one)->island == mover_at(sweep, impact.other)->island;
    for (int end = 0; end < (are_one ? 1 : 2); end++) {
        if (mover_at(sweep, ends[end])->movable) {
            for (int each = sweep->movers[ends[end]].island; each >= 0; each = sweep->movers[each].next) {
                assert(count < sweep->count);
                members[count++] = each;
            }
        }
    }
    return count;
}

// The leader of what two movers become; -1 if nothing leads them. Anchored shapes come last: they stop what a kinematic
// body pushes against them.
static int leader_of(const Sweep *sweep, Impact impact) {
    int leader = -1, ends[2] = {impact.one, impact.other};
    for (int end = 0; end < 2; end++) {
        const Mover *mover = mover_at(sweep, ends[end]);
        int own = mover->movable ? sweep->movers[mover->island].leader : ends[end];
        leader = own > leader ? own : leader;
    }
    return leader;
}

// Let the islands of two movers go on as one.
static void join(Sweep *sweep, Impact impact, const int *members, int count) {
    int leader = leader_of(sweep, impact);
    Vec pivot = {0.0, 0.0}, own_pivot;
    Twist rate;
    if (leader >= 0) {
        const Mover *leading = mover_at(sweep, leader);
        pose_at(leading, impact.share, &pivot);
        rate = leading->rate;
    } else {
        rate = common_motion(sweep, members, count, impact.share, &pivot);
    }
    for (int number = 0; number < count; number++) {
        Mover *mover = sweep->movers + members[number];
        mover->pose = pose_at(mover, impact.share, &own_pivot);
        mover->since = impact.share;
        mover->met = true;
        mover->pivot = pivot;
        mover->rate = rate;
        mover->island = members[0];
        mover->next = number + 1 < count ? members[number + 1] : -1;
        mover->leader = -1;
        fit_box(mover);
        tree_set(&sweep->tree, members[number], mover->box);
    }
    sweep->movers[members[0]].leader = leader;
}

// What a round has passed: the boxes that islands had before they met, and islands that wait for the next round.
typedef struct Passed {
    Tree boxes;  // by mover
    bool *waits; // by the first member of an island
} Passed;

// Whether something near an impact is to come first, after which it may not take place.
static bool has_to_wait(const Sweep *sweep, const Passed *passed, const int *members, int count) {
    for (int number = 0; number < count; number++) {
        const Mover *mover = sweep->movers + members[number];
        if (passed->waits[mover->island] || tree_meets(&passed->boxes, mover->box)) {
            return true;
        }
    }
    return false;
}

// Join those that meet before anything near them does; list the bodies that move otherwise.
static int resolve(Sweep *sweep, const Impacts *impacts, int *changed) {
    Arena *arena = &sweep->world->own->arena;
    size_t mark = arena_mark(arena);
    Passed passed = {.boxes = emptied(&sweep->tree, arena), .waits = TAKE(arena, bool, sweep->count)};
    int *members = TAKE(arena, int, sweep->count), changed_count = 0;
    for (int number = 0; number < impacts->count; number++) {
        Impact impact = impacts->list[number];
        int count = list_members(sweep, impact, members);
        if (has_to_wait(sweep, &passed, members, count)) {
            for (int member = 0; member < count; member++) {
                passed.waits[sweep->movers[members[member]].island] = true;
            }
            continue;
        }
        for (int member = 0; member < count; member++) {
            // No island is joined twice in a round.
            assert(changed_count < sweep->count);
            tree_set(&passed.boxes, members[member], sweep->movers[members[member]].box);
            changed[changed_count++] = members[member];
        }
        join(sweep, impact, members, count);
    }
    arena_release(arena, mark);
    return changed_count;
}

// Drop the impacts of bodies whose motions have changed.
static void drop_changed(Impacts *impacts, const int *changed, int count) {
    Sweep *sweep = impacts->sweep;
    size_t mark = arena_mark(&sweep->world->own->arena);
    bool *known = TAKE(&sweep->world->own->arena, bool, sweep->count + sweep->statics->count);
    for (int number = 0; number < count; number++) {
        known[changed[number]] = true;
    }
    int kept = 0;
    for (int number = 0; number < impacts->count; number++) {
        Impact impact = impacts->list[number];
        if (!known[impact.one] && !known[impact.other]) {
            impacts->list[kept++] = impact;
        }
    }
    impacts->count = kept;
    arena_release(&sweep->world->own->arena, mark);
}

void join_impacts(Sweep *sweep, const int *fast, int count) {
    Impacts impacts = {.sweep = sweep};
    int *changed = TAKE(&sweep->world->own->arena, int, sweep->count + 1);
    memcpy(changed, fast, (size_t)count * sizeof(int));
    for (int round = 0; round < IMPACT_ROUNDS; round++) {
        drop_changed(&impacts, changed, count);
        find_impacts(&impacts, changed, count);
        if (impacts.count == 0) {
            return;
        }
        sort(impacts.list, impacts.count, sizeof(Impact), by_share);
        count = resolve(sweep, &impacts, changed);
    }
}
