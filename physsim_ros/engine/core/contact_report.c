// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Contact report: which pairs of bodies touched in a frame, where, and with which impulse.
//
// Problem: a frame has many sub-steps, and Chipmunk knows the contacts of the last one only. A frame reports each pair
// that touched in any of them, with the sum of its impulses, and each moment at which a pair began to touch.
// Method: a list of pairs, with a hash table by the places of their bodies, which each sub-step updates. A pair has the
// mean of its points and normals of the last sub-step in which it touched. Chipmunk does not list the contacts of
// sleeping bodies: while a pair sleeps, the impulse of its last sub-step awake is repeated. A pair that did not touch
// in the sub-step before begins to touch within this one: where one is a sensor, as that is met (`sensors.c`), else at
// the impact (`rest_of_step.c`).
// Scope: pairs that touch as the report begins do not begin to touch then.
// Law: the reported impulses on a body, with gravity, change its momentum (`half_step.c`).
// Cost: 15 ns a contact and sub-step.

#include "contact.h"
#include "stages.h"
#include <stdlib.h>
#include <string.h>

// The mean of the normals of a pair that is shorter than this has no direction: the first body is squeezed from both
// sides.
static const double opposed = 1e-6;

// The stamp of what has not touched yet.
enum { NEVER = -2 };

// A pair of bodies that touches, or has touched in this frame.
typedef struct ReportedPair {
    int a, b; // places in the table, the lesser first
    // Of the last sub-step in which they touched: impulse on the second body; sums over points of normals, from the
    // first body to the second, and of positions; the highest normal, for those that are opposed; count of points.
    Vec impulse, normals, positions, highest;
    int points;
    Vec sum;       // of impulses in this frame [N s]
    int64_t stamp; // number of the last sub-step in which they touched
    bool in_frame; // they touched in this frame
} ReportedPair;

// What the report keeps between steps.
typedef struct Report {
    ReportedPair *pairs; // (count)
    int *slots;          // (2 * room): a hash table with open addressing: numbers of pairs, counted from 1; 0 is free
    int count, room;     // a power of two; 0 before the first pair
    int64_t stamp;       // number of sub-steps that have been reported
    bool follows;        // the sub-step before was reported, too
    int begun_room;
} Report;

Report *new_report(void) {
    return allocated(1, sizeof(Report));
}

void free_report(World *world) {
    free(world->own->report->pairs);
    free(world->own->report->slots);
    free(world->own->report);
    free(world->contacts);
    free(world->begun);
}

// The slot of a pair, or the free one where it belongs (Fibonacci hashing; Knuth, The Art of Computer Programming 3,
// 6.4).
static int *slot_of(const Report *report, int a, int b) {
    uint64_t key = ((uint64_t)(uint32_t)a << 32U) | (uint32_t)b;
    uint64_t slot = (key * 0x9E3779B97F4A7C15U) >> 20U, mask = 2U * (uint64_t)report->room - 1U;
    // A free slot ends the search.
    assert(report->count <= report->room && ((uint64_t)report->room & ((uint64_t)report->room - 1U)) == 0);
    for (slot &= mask; report->slots[slot] > 0; slot = (slot + 1U) & mask) {
        const ReportedPair *pair = report->pairs + report->slots[slot] - 1;
        if (pair->a == a && pair->b == b) {
            break;
        }
    }
    return report->slots + slot;
}

// Memory for a number of values that begins with a copy of some.
static void *with_room(const void *values, int count, int room, size_t size) {
    void *list = allocated((size_t)room, size);
    if (count > 0) {
        memcpy(list, values, (size_t)count * size);
    }
    return list;
}

// Move the pairs to memory with room for some more, and index them anew.
static void make_room(Report *report) {
    ReportedPair *old = report->pairs;
    report->room = 32;
    while (report->room < 2 * report->count) {
        report->room *= 2;
    }
    report->pairs = with_room(old, report->count, report->room, sizeof(ReportedPair));
    free(old);
    free(report->slots);
    report->slots = allocated(2 * (size_t)report->room, sizeof(int));
    for (int number = 0; number < report->count; number++) {
        *slot_of(report, report->pairs[number].a, report->pairs[number].b) = number + 1;
    }
}

static ReportedPair *reported_pair(Report *report, int one, int other) {
    int a = one < other ? one : other, b = one < other ? other : one;
    assert(a >= 0);
    if (report->count == report->room) {
        make_room(report);
    }
    int *slot = slot_of(report, a, b);
    if (*slot == 0) {
        report->pairs[report->count++] = (ReportedPair){.a = a, .b = b, .stamp = NEVER};
        *slot = report->count;
    }
    return report->pairs + *slot - 1;
}

// The time of the first touch of a pair within this sub-step, as a share of it (0 .. 1).
static double touch_share(World *world, Body *a, Body *b) {
    if (a->sensor || b->sensor) {
        return crossing_time(world, a, b);
    }
    return 1.0 - remaining_time(a, b) / world->dt;
}

static void add_begun(World *world, Report *report, Begun added) {
    if (world->begun_count == report->begun_room) {
        report->begun_room = 2 * report->begun_room + 16;
        Begun *old = world->begun;
        world->begun = with_room(old, world->begun_count, report->begun_room, sizeof(Begun));
        free(old);
    }
    world->begun[world->begun_count++] = added;
}

// Begin the sub-step of a pair, unless another contact of it has.
static void begin_pair(World *world, Report *report, ReportedPair *pair) {
    if (pair->stamp == report->stamp) {
        return;
    }
    if (pair->stamp != report->stamp - 1 && report->follows) {
        double share = touch_share(world, world->bodies + pair->a, world->bodies + pair->b);
        double time = world->reported_steps - 1 + (world->own->sub_step + share) / (double)SUB_STEPS;
        add_begun(world, report, (Begun){{pair->a, pair->b}, time});
    }
    pair->stamp = report->stamp;
    pair->in_frame = true;
    pair->impulse = pair->normals = pair->positions = pair->highest = vec(0.0, 0.0);
    pair->points = 0;
}

static bool is_higher(Vec normal, Vec than) {
    return normal.y > than.y || (normal.y == than.y && normal.x > than.x);
}

static void add_arbiter(World *world, Report *report, const cpArbiter *arbiter) {
    int a = place_of(world, arbiter->body_a), b = place_of(world, arbiter->body_b);
    ReportedPair *pair = reported_pair(report, a, b);
    begin_pair(world, report, pair);
    double sign = a < b ? 1.0 : -1.0;
    Vec normal = scaled(arbiter->n, sign);
    if (arbiter->count > 0 && (pair->points == 0 || is_higher(normal, pair->highest))) {
        pair->highest = normal;
    }
    Vec impulse = vec(0.0, 0.0);
    for (int number = 0; number < arbiter->count; number++) {
        const cpContact *point = arbiter->contacts + number;
        Vec sum = add(add(arbiter->body_a->p, point->r1), add(arbiter->body_b->p, point->r2));
        impulse = add(impulse, scaled(arbiter->n, point->jnAcc));
        impulse = add(impulse, scaled(perpendicular(arbiter->n), point->jtAcc));
        pair->normals = add(pair->normals, normal);
        pair->positions = add(pair->positions, scaled(sum, 0.5));
        pair->points++;
    }
    double share = reported_share(body_of(arbiter->body_a), body_of(arbiter->body_b), impulse);
    pair->impulse = add(pair->impulse, scaled(impulse, sign * share));
}

// Sensors, and kinematic bodies among themselves, overlap without points; Chipmunk lists them only here.
static void add_overlap(cpArbiter *arbiter, void *data) {
    World *world = data;
    if (arbiter->count == 0 && arbiter->stamp == world->space->stamp && !is_ignored(arbiter)) {
        add_arbiter(world, world->own->report, arbiter);
    }
}

static bool may_sleep(const Body *body) {
    return !body->dynamic || sleeps(body);
}

// Whether a pair sleeps: a body of it does, and none is awake.
static bool pair_sleeps(const World *world, const ReportedPair *pair) {
    const Body *a = world->bodies + pair->a, *b = world->bodies + pair->b;
    return (sleeps(a) || sleeps(b)) && may_sleep(a) && may_sleep(b);
}

// Add the impulses of the sub-step to the sums of pairs; one of the sub-step before that sleeps now touches on.
static void add_impulses(const World *world, Report *report) {
    for (ReportedPair *pair = report->pairs, *end = pair + report->count; pair < end; pair++) {
        if (pair->stamp == report->stamp - 1 && pair_sleeps(world, pair)) {
            pair->stamp = report->stamp;
            pair->in_frame = true;
        }
        if (pair->stamp == report->stamp) {
            pair->sum = add(pair->sum, pair->impulse);
        }
    }
}

// Read pairs that slept before the report began.
static void read_sleeping(World *world, Report *report) {
    for (int place = 0; place < world->body_count; place++) {
        const Body *body = world->bodies + place;
        const cpArbiter *each = body->dynamic && sleeps(body) ? body->engine->arbiterList : NULL;
        for (; each != NULL; each = next_of(each, body->engine)) {
            const Body *other = body_of(other_of(each, body->engine));
            if (each->body_a == body->engine || !(other->dynamic && sleeps(other))) {
                add_arbiter(world, report, each);
            }
        }
    }
}

// A pair whose overlap lies within a sub-step has no points.
static void add_crossing(World *world, const Body *body, const Body *sensor) {
    Report *report = world->own->report;
    int a = place_of(world, body->engine), b = place_of(world, sensor->engine);
    ReportedPair *pair = reported_pair(report, a, b);
    if (pair->stamp < report->stamp - 1) {
        begin_pair(world, report, pair);
    }
}

// Nobody is told of the contacts of this sub-step.
static void forget_contacts(World *world) {
    Report *report = world->own->report;
    if (report->follows || report->count > 0) {
        report->count = 0;
        make_room(report);
        report->follows = false;
        world->reported_steps = world->begun_count = 0;
    }
}

void report_contacts(World *world) {
    if (!world->own->reports) {
        forget_contacts(world);
        return;
    }
    Report *report = world->own->report;
    report->stamp++;
    if (!report->follows) {
        read_sleeping(world, report);
    }
    for (int number = 0; number < arbiter_count(world); number++) {
        // A contact that Chipmunk ignores is none.
        if (!is_ignored(arbiter_at(world, number))) {
            add_arbiter(world, report, arbiter_at(world, number));
        }
    }
    world->chipmunk.each_arbiter(world->space, add_overlap, world);
    find_crossings(world, add_crossing);
    add_impulses(world, report);
    report->follows = true;
}

void core_clear_contacts(World *world) {
    Report *report = world->own->report;
    int kept = 0;
    for (int number = 0; number < report->count; number++) {
        ReportedPair pair = report->pairs[number];
        if (pair.stamp == report->stamp) {
            pair.sum = vec(0.0, 0.0);
            pair.in_frame = false;
            report->pairs[kept++] = pair;
        }
    }
    if (kept < report->count) {
        report->count = kept;
        make_room(report);
    }
    world->reported_steps = world->begun_count = 0;
}

static int by_pair(const void *one, const void *other) {
    const int64_t *x = ((const Contact *)one)->pair, *y = ((const Contact *)other)->pair;
    return compared(2, (double[][2]){{(double)x[0], (double)y[0]}, {(double)x[1], (double)y[1]}});
}

static int by_time_and_pair(const void *one, const void *other) {
    const Begun *x = one, *y = other;
    return compared(3, (double[][2]){{x->time, y->time},
                                     {(double)x->pair[0], (double)y->pair[0]},
                                     {(double)x->pair[1], (double)y->pair[1]}});
}

static Contact contact_of(const World *world, const ReportedPair *pair) {
    double size = length(pair->normals), count = pair->points > 0 ? (double)pair->points : 1.0;
    bool directed = size > opposed * count;
    return (Contact){.pair = {pair->a, pair->b == world->body_count - 1 ? -1 : pair->b},
                     .point = scaled(pair->positions, 1.0 / count),
                     .normal = directed ? scaled(pair->normals, 1.0 / size) : pair->highest,
                     .impulse = pair->sum,
                     .points = pair->points};
}

void core_take_contacts(World *world) {
    Report *report = world->own->report;
    free(world->contacts);
    world->contacts = allocated((size_t)report->count, sizeof(Contact));
    world->contact_count = 0;
    for (const ReportedPair *pair = report->pairs, *end = pair + report->count; pair < end; pair++) {
        // Pairs of the background with itself are left out.
        if (pair->in_frame && pair->a < world->body_count - 1) {
            world->contacts[world->contact_count++] = contact_of(world, pair);
        }
    }
    sort(world->contacts, world->contact_count, sizeof(Contact), by_pair);
    sort(world->begun, world->begun_count, sizeof(Begun), by_time_and_pair);
    for (int number = 0; number < world->begun_count; number++) {
        Begun *begun = world->begun + number;
        begun->pair[1] = begun->pair[1] == world->body_count - 1 ? -1 : begun->pair[1];
    }
}

void rename_contacts(World *world, const int32_t *former, int count) {
    Report *report = world->own->report;
    if (report->count == 0) {
        return;
    }
    int *places = allocated((size_t)world->body_count, sizeof(int));
    for (int old = 0; old < world->body_count; old++) {
        places[old] = -1;
    }
    for (int place = 0; place < count; place++) {
        assert(former[place] < world->body_count);
        if (former[place] >= 0) {
            places[former[place]] = place;
        }
    }
    int kept = 0;
    for (int number = 0; number < report->count; number++) {
        ReportedPair pair = report->pairs[number];
        if (places[pair.a] >= 0 && places[pair.b] >= 0) {
            // The order of bodies stays, so that the lesser place is that of the same body.
            pair.a = places[pair.a];
            pair.b = places[pair.b];
            assert(pair.a <= pair.b);
            report->pairs[kept++] = pair;
        }
    }
    report->count = kept;
    make_room(report);
    int begun = 0;
    for (int number = 0; number < world->begun_count; number++) {
        Begun each = world->begun[number];
        int a = places[each.pair[0]], b = places[each.pair[1]];
        if (a >= 0 && b >= 0) {
            world->begun[begun++] = (Begun){{a, b}, each.time};
        }
    }
    world->begun_count = begun;
    free(places);
}

void core_copy_contacts(World *world, const World *old) {
    Report *report = world->own->report;
    const Report *from = old->own->report;
    free(report->pairs);
    free(report->slots);
    free(world->begun);
    // A world that resumes here does not know the step before, either.
    *report = (Report){.stamp = from->stamp, .count = from->count, .begun_room = old->begun_count};
    report->pairs = with_room(from->pairs, from->count, from->count, sizeof(ReportedPair));
    make_room(report);
    world->begun = with_room(old->begun, old->begun_count, old->begun_count, sizeof(Begun));
    world->begun_count = old->begun_count;
    world->reported_steps = old->reported_steps;
}
