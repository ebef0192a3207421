// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Islands: dynamic bodies that joints with rows and contacts tie together, each solved by itself.
//
// Problem: Chipmunk's iterations diverge where much rests on light joined bodies, and the impulses by which that then
// presses on its other neighbours are as wrong (80 boxes of 5 kg on planks of 0.2 kg gained a fifth of the energy of
// their fall).
// Method: the contacts of jointed bodies are rows of their island, and so are those of what they touch. Islands are
// found by union-find (`root_of` of `world.h`).
// Scope: joints at rest, whose bodies sleep, are left as they are.
// Law: contacts are sorted by bodies, shapes and points, so that an island does not depend on what Chipmunk finds
// elsewhere, nor on the order in which it finds it.
// Cost: that of `joint_solver.c`.

#include "joint_islands.h"
#include "contact.h"
#include "joint_parts.h"
#include "stages.h"

// Points of a body that is touched, at most, for all of them to be rows: what bears more, as a platform full of boxes,
// is as heavy as many of them, so that Chipmunk's iterations converge on it.
enum { MOST_BEARINGS = 32 };

typedef struct Bearings {
    Bearing *list;
    int count;
} Bearings;

static int compare_bearings(const void *one, const void *other) {
    const Bearing *a = one, *b = other;
    double keys[][2] = {{(double)a->a, (double)b->a},
                        {(double)a->b, (double)b->b},
                        {(double)a->shapes[0], (double)b->shapes[0]},
                        {(double)a->shapes[1], (double)b->shapes[1]},
                        {a->arm_a.x, b->arm_a.x},
                        {a->arm_a.y, b->arm_a.y}};
    return compared(6, keys);
}

static void add_bearings(World *world, Bearings *bearings, const cpArbiter *arbiter) {
    Vec tangent = perpendicular(arbiter->n);
    double remaining = begins(arbiter) ? remaining_time(body_of(arbiter->body_a), body_of(arbiter->body_b)) : 0.0;
    for (int number = 0; number < arbiter->count; number++) {
        cpContact *point = arbiter->contacts + number;
        bearings->list[bearings->count++] = (Bearing){.point = point,
                                                      .a = place_of(world, arbiter->body_a),
                                                      .b = place_of(world, arbiter->body_b),
                                                      .shapes = {arbiter->a->hashid, arbiter->b->hashid},
                                                      .slop = slop_of(arbiter),
                                                      .arm_a = point->r1,
                                                      .arm_b = point->r2,
                                                      .normal = arbiter->n,
                                                      .friction = arbiter->u,
                                                      .slide = dot(arbiter->surface_vr, tangent),
                                                      .remaining = remaining,
                                                      .rolling = rolling_arm(arbiter)};
    }
}

// Count the points in which a body touches others; the count ends once it exceeds `most`.
static int point_count(const cpBody *body, int most) {
    int count = 0;
    for (const cpArbiter *each = body->arbiterList; each != NULL && count <= most; each = next_of(each, body)) {
        count += each->count;
    }
    return count;
}

// The bodies all of whose contacts are rows: those with joints, then those that they touch, and do not pass.
typedef struct Members {
    int *places, count;
    bool *marks; // of all bodies
} Members;

static Members members_of(World *world) {
    const Private *own = world->own;
    Members members = {.places = TAKE(&world->own->arena, int, world->body_count)};
    members.marks = TAKE(&world->own->arena, bool, world->body_count);
    for (int number = 0; number < own->jointed_count; number++) {
        if (!sleeps(world->bodies + own->jointed[number])) {
            members.places[members.count++] = own->jointed[number];
            members.marks[own->jointed[number]] = true;
        }
    }
    for (int number = 0, count = members.count; number < count; number++) {
        const cpBody *body = world->bodies[members.places[number]].engine;
        for (const cpArbiter *each = body->arbiterList; each != NULL; each = next_of(each, body)) {
            const cpBody *other = other_of(each, body);
            int place = place_of(world, other);
            bool touched = each->count > 0 && world->bodies[place].dynamic && !members.marks[place];
            if (touched && point_count(other, MOST_BEARINGS) <= MOST_BEARINGS) {
                members.marks[place] = true;
                members.places[members.count++] = place;
            }
        }
    }
    return members;
}

static Bearings bearings_of_jointed(World *world) {
    Members members = members_of(world);
    int most = 0;
    for (int number = 0; number < members.count; number++) {
        most += point_count(world->bodies[members.places[number]].engine, INT32_MAX);
    }
    Bearings bearings = {.list = TAKE(&world->own->arena, Bearing, most)};
    for (int number = 0; number < members.count; number++) {
        const cpBody *body = world->bodies[members.places[number]].engine;
        for (const cpArbiter *each = body->arbiterList; each != NULL; each = next_of(each, body)) {
            // Each is in the lists of both its bodies.
            if (each->body_a == body || !members.marks[place_of(world, each->body_a)]) {
                add_bearings(world, &bearings, each);
            }
        }
    }
    assert(bearings.count <= most);
    sort(bearings.list, bearings.count, sizeof(Bearing), compare_bearings);
    world->own->now.bearers = members.marks;
    return bearings;
}

static void unite_dynamic(const World *world, int *parents, int a, int b) {
    if (world->bodies[a].dynamic && world->bodies[b].dynamic) {
        unite(parents, a, b);
    }
}

// The place of a body that forces move, of those of a joint with rows.
static int moved_by(const World *world, const Joint *joint) {
    int place = world->bodies[joint->a].dynamic ? joint->a : joint->b;
    for (int row = joint->first_row; row < joint->first_row + joint->row_count; row++) {
        const Row *of_joint = world->rows + row;
        for (int guide = 0; guide < of_joint->guide_count && !world->bodies[place].dynamic; guide++) {
            place = world->guides[of_joint->first_guide + guide].body;
        }
    }
    return place;
}

static void unite_guides(const World *world, int *parents, const Joint *joint) {
    int moved = moved_by(world, joint);
    for (int row = joint->first_row; row < joint->first_row + joint->row_count; row++) {
        const Row *of_joint = world->rows + row;
        for (int guide = 0; guide < of_joint->guide_count; guide++) {
            unite_dynamic(world, parents, moved, world->guides[of_joint->first_guide + guide].body);
        }
    }
}

// The number of the island that a joint or contact belongs to.
static int island_of(const World *world, int *parents, const int *numbers, int a, int b) {
    int number = numbers[root_of(parents, world->bodies[a].dynamic ? a : b)];
    assert(number > 0); // a joint has made it
    return number - 1;
}

// Whether a joint is at rest: springs alone fall asleep (`joint_solver.c`), with all that they and contacts tie
// together.
static bool rests(const World *world, const Joint *joint) {
    return sleeps(world->bodies + moved_by(world, joint));
}

// Return the islands, with their joints and contacts, in the order of their first joints.
static Islands split(World *world, Bearings bearings) {
    Arena *arena = &world->own->arena;
    int *parents = sets_of(world), *numbers = TAKE(arena, int, world->body_count), joint_count = 0;
    const Joint **joints = TAKE(arena, const Joint *, world->joint_count);
    for (const Joint *joint = world->joints, *end = joint + world->joint_count; joint < end; joint++) {
        if (joint->row_count > 0 && !rests(world, joint)) {
            joints[joint_count++] = joint;
            unite_dynamic(world, parents, joint->a, joint->b);
            unite_guides(world, parents, joint);
        }
    }
    for (int number = 0; number < bearings.count; number++) {
        unite_dynamic(world, parents, bearings.list[number].a, bearings.list[number].b);
    }
    Islands found = {.islands = TAKE(arena, Island, world->own->jointed_count)};
    for (int number = 0; number < joint_count; number++) {
        int root = root_of(parents, moved_by(world, joints[number]));
        if (numbers[root] == 0) {
            numbers[root] = ++found.count;
        }
        assert(found.count <= world->own->jointed_count);
        found.islands[numbers[root] - 1].joint_count++;
        found.islands[numbers[root] - 1].joint_row_count += joints[number]->row_count;
    }
    for (int number = 0; number < bearings.count; number++) {
        Bearing bearing = bearings.list[number];
        Island *island = found.islands + island_of(world, parents, numbers, bearing.a, bearing.b);
        island->bearing_count++;
        island->joint_row_count += bearing.rolling > 0.0;
    }
    for (int number = 0; number < found.count; number++) {
        Island *island = found.islands + number;
        island->row_count = island->joint_row_count + 2 * island->bearing_count;
        island->joints = TAKE(arena, const Joint *, island->joint_count);
        island->bearings = TAKE(arena, Bearing, island->bearing_count);
        island->joint_count = island->bearing_count = 0;
    }
    for (int number = 0; number < joint_count; number++) {
        int moved = moved_by(world, joints[number]);
        Island *island = found.islands + island_of(world, parents, numbers, moved, moved);
        island->joints[island->joint_count++] = joints[number];
    }
    for (int number = 0; number < bearings.count; number++) {
        Bearing bearing = bearings.list[number];
        Island *island = found.islands + island_of(world, parents, numbers, bearing.a, bearing.b);
        island->bearings[island->bearing_count++] = bearing;
    }
    return found;
}

// The numbering of the bodies, rows and links of an island.
typedef struct Numbering {
    World *world;
    Island *island;
    int *numbers;         // (body_count of the world): of bodies in the island, counted from 1; 0 elsewhere
    int *places;          // of the bodies of the island
    int row, link, group; // the next ones
} Numbering;

// Return the number of a body in an island, to which it is added if it is not there yet.
static int number_in(Numbering *numbering, int place) {
    Island *island = numbering->island;
    if (numbering->numbers[place] == 0) {
        const Body *body = numbering->world->bodies + place;
        int number = island->body_count++;
        numbering->places[number] = place;
        numbering->numbers[place] = number + 1;
        island->engine[number] = body->engine;
        island->jointed[number] = body->own->jointed;
        island->inverses[number] = (Inverse){body->engine->m_inv, body->engine->i_inv};
        island->turns[number] = (Turn){0.0, {1.0, 0.0}};
    }
    return numbering->numbers[place] - 1;
}

// The order in which C evaluates a list is the compiler's: bodies are numbered one after the other.
static Ends ends_between(Numbering *numbering, int a, int b) {
    int first = number_in(numbering, a), second = number_in(numbering, b);
    return (Ends){first, second};
}

// Number the next row, between two bodies; its further links follow.
static void add_row(Numbering *numbering, int a, int b) {
    numbering->island->ends[numbering->row] = ends_between(numbering, a, b);
    numbering->island->further[numbering->row] = numbering->link;
    numbering->island->groups[numbering->row++] = numbering->group;
}

// Number a row of a joint, and its links.
static void add_joint_row(Numbering *numbering, const Joint *joint, const Row *row) {
    const Guide *guides = numbering->world->guides + row->first_guide;
    bool is_path = row->kind == ROW_PATH;
    add_row(numbering, is_path ? guides[0].body : joint->a, is_path ? guides[1].body : joint->b);
    for (int guide = is_path ? 1 : 0, count = further_count(row); count > 0; guide++, count--) {
        int next = is_path ? guide + 1 : guide;
        numbering->island->ends[numbering->link++] = ends_between(numbering, guides[guide].body, guides[next].body);
    }
}

static int link_count(const World *world, const Island *island) {
    int count = island->row_count;
    for (int number = 0; number < island->joint_count; number++) {
        for (int each = 0; each < island->joints[number]->row_count; each++) {
            count += further_count(world->rows + island->joints[number]->first_row + each);
        }
    }
    return count;
}

// Find where Chipmunk stores the impulses of a row of a joint.
static void take_impulse(const World *world, Island *island, int row) {
    const Row *of_joint = island->rows[row];
    Part *part = world->parts + of_joint->part;
    island->impulses[row] = impulse_at(part, of_joint->component);
    island->last[row] = *island->impulses[row];
    if (part->kind >= PART_OWN) {
        // Chipmunk gives none.
        *island->impulses[row] = 0.0;
    }
    island->closing[row] = of_joint->component == 0 ? &part->closing.x : &part->closing.y;
}

static void add_rolling_row(Numbering *numbering, Bearing *bearing) {
    Island *island = numbering->island;
    RollingRow *rolling = TAKE(&numbering->world->own->arena, RollingRow, 1);
    rolling->row = (Row){.kind = ROW_ANGLE, .law = LAW_FRICTION, .below = 1.0, .above = 1.0, .ratio = 1.0};
    bearing->rolling_row = rolling;
    island->rows[numbering->row] = &rolling->row;
    island->impulses[numbering->row] = &rolling->impulse;
    island->closing[numbering->row] = &rolling->closing;
    add_row(numbering, bearing->a, bearing->b);
    numbering->group++;
}

static void add_joint_rows(Numbering *numbering) {
    Island *island = numbering->island;
    for (int number = 0; number < island->joint_count; number++, numbering->group++) {
        const Joint *joint = island->joints[number];
        for (int each = 0; each < joint->row_count; each++) {
            Row *row = numbering->world->rows + joint->first_row + each;
            island->rows[numbering->row] = row;
            island->joint_of_row[numbering->row] = joint;
            take_impulse(numbering->world, island, numbering->row);
            // Rows with guides have bodies of their own.
            numbering->group += each > 0 && row->guide_count > 0;
            add_joint_row(numbering, joint, row);
        }
    }
}

static void add_bearing_rows(Numbering *numbering) {
    Island *island = numbering->island;
    for (int number = 0; number < island->bearing_count; number++) {
        if (island->bearings[number].rolling > 0.0) {
            add_rolling_row(numbering, island->bearings + number);
        }
    }
    for (int side = 0; side < 2; side++) {
        for (int number = 0; number < island->bearing_count; number++) {
            const Bearing *bearing = island->bearings + number;
            bool same = number > 0 && bearing->a == bearing[-1].a && bearing->b == bearing[-1].b;
            numbering->group += same ? 0 : 1;
            island->last[numbering->row] = side == 0 ? bearing->point->jnAcc : bearing->point->jtAcc;
            add_row(numbering, bearing->a, bearing->b);
        }
    }
}

// Number the bodies of an island, and the ends of its rows; `numbers` are 0 before and after.
static void lay_out(World *world, Island *island, int *numbers) {
    Arena *arena = &world->own->arena;
    int links = link_count(world, island), most = 2 * links;
    island->engine = TAKE(arena, cpBody *, most);
    island->jointed = TAKE(arena, bool, most);
    island->inverses = TAKE(arena, Inverse, most);
    island->turns = TAKE(arena, Turn, most);
    island->rows = TAKE(arena, Row *, island->joint_row_count);
    island->joint_of_row = TAKE(arena, const Joint *, island->joint_row_count);
    island->impulses = TAKE(arena, double *, island->joint_row_count);
    island->last = TAKE(arena, double, island->row_count);
    island->closing = TAKE(arena, double *, island->joint_row_count);
    island->guides = world->guides;
    island->ends = TAKE(arena, Ends, links);
    island->further = TAKE(arena, int, island->row_count + 1);
    island->groups = TAKE(arena, int, island->row_count);
    Numbering numbering = {world, island, numbers, TAKE(arena, int, most), .link = island->row_count};
    add_joint_rows(&numbering);
    add_bearing_rows(&numbering);
    island->further[numbering.row] = numbering.link;
    assert(numbering.row == island->row_count && numbering.link == links && island->body_count <= most);
    for (int number = 0; number < island->body_count; number++) {
        numbers[numbering.places[number]] = 0;
    }
}

Islands joint_islands(World *world) {
    if (world->own->jointed_count == 0) {
        return (Islands){0};
    }
    Islands found = split(world, bearings_of_jointed(world));
    int *numbers = TAKE(&world->own->arena, int, world->body_count);
    for (int number = 0; number < found.count; number++) {
        lay_out(world, found.islands + number, numbers);
    }
    return found;
}
