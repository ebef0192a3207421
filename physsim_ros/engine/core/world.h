// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// What the core keeps of a world, and what stages share.

#ifndef PHYSSIM_WORLD_H
#define PHYSSIM_WORLD_H

#include "arena.h"
#include "core.h"
#include "vector.h"
#include <stdbool.h>

// What the core keeps of a body, by the file that writes it. That of a sleeping body stays until it wakes.
typedef struct BodyPrivate {
    // As long as the joints are these.
    uint8_t jointed;   // `core.c`: a joint with rows ends on it
    uint8_t sprung;    // `springs.c`: in an island of joints that a spring holds to something fixed
    uint8_t motored;   // in one that a motor holds to something fixed
    uint8_t on_spring; // a spring pulls it, and forces move it
    // Within a sub-step, in the order of the stages; `step.c` clears what not every sub-step finds.
    // `applied_forces.c`, also before a step
    Twist lead; // half a sub-step of gravity and all forces: by it the velocity of a body in free flight leads
    // `step.c`, as the sub-step begins
    Pose begin;
    double idle; // for which it has been at rest; < 0 while it sleeps [s]
    // `fields.c`, with `media.c`
    Twist field;     // half of what fields change its velocity by in this sub-step
    uint8_t afloat;  // the surface of a medium crosses it
    uint8_t stirred; // fields act on it that change while it rests
    // `floor.c`
    Twist under;            // mean velocity of the floor under it
    Twist without_contacts; // velocity after the sub-step without contacts
    // `continuous.c`
    double remaining; // of the sub-step after it has been stopped [s]
    Twist carried;    // displacement with what has stopped it, in that time [m, rad]
    // `step.c`, as Chipmunk's step begins
    Twist twist;
    uint8_t thrown; // its velocity was set before this sub-step
    // `rest_of_step.c`
    double since;               // time from its first impact to the end of its motion [s]
    uint8_t bounces;            // its impact throws it off, so gravity acts on the new velocity
    Twist remaining_move;       // displacement that remains after its impact [m, rad]
    uint8_t has_remaining_move; // that displacement has been found
} BodyPrivate;

// The results of stages that later stages of the same sub-step use, in the memory of the arena.
typedef struct SubStep {
    struct Pair *loaded; // `find_loaded`: pairs of shapes, one of a one-way body, that carry a load
    int loaded_count;
    Body **awake; // `step_chipmunk`: before its step, for `begin_sleepers`
    int awake_count;
    struct Touch *begun; // `find_begun`: contacts that begin, without those that `slide_over_edges` ignores
    int begun_count;
    struct Load *loads; // `list_load_bounds`, for `remove_impact_impulses`
    int load_count;
    struct Islands *joint_islands; // `find_joint_islands`, for all stages of joints
    bool *bearers;                 // of the same (body_count): bodies all of whose contacts are rows; NULL without any
    struct Roll *rolls;            // `find_rolls`, for Chipmunk's solver
    int roll_count;
} SubStep;

typedef struct Private {
    Arena arena;
    BodyPrivate *bodies; // (body_count)
    SubStep now;
    cpConstraint *hook;
    cpConstraintClass *hook_class, rolling_class; // its own class, and that within a step (`rolling.c`)
    // Places of dynamic bodies with joints that have rows.
    int *jointed;
    int jointed_count;
    double kept;         // share of its velocity that a body keeps in a sub-step
    double overlap_kept; // share of an overlap that a sub-step keeps; the rest is pushed out
    double least_depth;  // least safe depth of a body that is no sensor [m]
    // Shapes that never move, for continuous collision; they last until one of them is moved.
    Arena static_arena;
    struct Statics *statics;
    // Systems of the islands of the last sub-step, which the next one takes where all have the same layout.
    struct System *systems;
    int system_count;
    Arena system_arena;
    int call_step;   // number of the step in this call
    bool reports;    // contacts of this step are reported
    bool all_active; // requests may have changed any body since the last sub-step
    // Whether there is a body on which a floor acts; one-way, with a belt, with rolling resistance; a sensor.
    bool has_floor, has_one_way, has_belt, has_rolling, has_sensor;
    int sub_step;                      // number of the sub-step in this step
    int next_actor;                    // number of the actor whose velocity is chosen next
    bool choosing;                     // velocities of actors are being chosen, before the first sub-step
    struct Surroundings *surroundings; // of all pedestrians, in this step; NULL before the first one looks
    struct Report *report;
    struct FluidForce *fluid_forces; // of media on bodies, in this step
} Private;

// Give back the memory of a sub-step, with what it holds.
static inline void reset_memory(World *world) {
    arena_reset(&world->own->arena);
    world->own->now = (SubStep){0};
}

// Memory that outlives a step, all bits 0.
void *allocated(size_t count, size_t size);

// The body of a struct of Chipmunk: the table sets its user data, which Pymunk reads only in callbacks of Python that
// move a body.
static inline Body *body_of(const cpBody *engine) {
    return engine->userData;
}

static inline int place_of(const World *world, const cpBody *engine) {
    int place = (int)(body_of(engine) - world->bodies);
    assert(place >= 0 && place < world->body_count);
    return place;
}

// How far the bodies of a contact may overlap at rest [m].
static inline double slop_of(const cpArbiter *arbiter) {
    double a = body_of(arbiter->body_a)->slop, b = body_of(arbiter->body_b)->slop;
    return a < b ? a : b;
}

static inline bool has_stage(const World *world, uint32_t stage) {
    return (world->stages & stage) == stage;
}

static inline bool sleeps(const Body *body) {
    return body->engine->sleeping_root != NULL;
}

// The bodies that a sub-step may change: those that are awake, in Chipmunk's order; in the first one of a call all
// bodies, since requests may have changed any.
static inline int active_count(const World *world) {
    return world->own->all_active ? world->body_count : world->space->dynamicBodies->num;
}

static inline Body *active_at(const World *world, int number) {
    return world->own->all_active ? world->bodies + number : body_of(world->space->dynamicBodies->arr[number]);
}

// Whether two bodies are of one group, and pass through each other.
static inline bool share_group(const Body *a, const Body *b) {
    return a->group != 0 && a->group == b->group;
}

static inline Pose pose_of(const cpBody *body) {
    return (Pose){body->p, body->a};
}

static inline Twist twist_of(const cpBody *body) {
    return (Twist){body->v, body->w};
}

// The velocity of a body without its half-step lead, before the engine has solved.
static inline Twist true_twist(const cpBody *body) {
    Twist lead = body_of(body)->own->lead, twist = twist_of(body);
    bool flies = body_of(body)->state.free;
    return flies ? (Twist){{twist.v.x - lead.v.x, twist.v.y - lead.v.y}, twist.w - lead.w} : twist;
}

static inline void set_twist(cpBody *body, Twist twist) {
    body->v = twist.v;
    body->w = twist.w;
}

// Set the pose of a body whose centre of mass is its origin, as `cpBodySetPosition` and `cpBodySetAngle` do.
void set_pose(cpBody *body, Pose pose);

// A pose after a displacement.
static inline Pose moved(Pose pose, Twist displacement, double share) {
    return (Pose){add(pose.p, scaled(displacement.v, share)), pose.yaw + displacement.w * share};
}

// Where Chipmunk moves a body to in a time [s].
static inline Pose pose_after(const cpBody *body, double lapse) {
    return moved(pose_of(body), twist_of(body), lapse);
}

// The next contact in the list of a body.
static inline cpArbiter *next_of(const cpArbiter *arbiter, const cpBody *body) {
    return arbiter->body_a == body ? arbiter->thread_a.next : arbiter->thread_b.next;
}

static inline cpBody *other_of(const cpArbiter *arbiter, const cpBody *body) {
    return arbiter->body_a == body ? arbiter->body_b : arbiter->body_a;
}

static inline int arbiter_count(const World *world) {
    return world->space->arbiters->num;
}

static inline cpArbiter *arbiter_at(const World *world, int number) {
    return world->space->arbiters->arr[number];
}

// The order of two things by pairs of their keys: -1, 0 or 1, by the first pair whose keys differ.
int compared(int count, const double keys[][2]);

// The count of the shapes of anchored bodies.
int anchored_shape_count(const World *world);

// `qsort`, which in GNU's library takes time and memory for an empty list, too.
void sort(void *list, int count, size_t size, int (*compare)(const void *, const void *));

// The numbers of two shapes, or the places of two bodies, the lesser first.
typedef struct Pair {
    uintptr_t low, high;
} Pair;

static inline Pair pair_of(uintptr_t a, uintptr_t b) {
    return a < b ? (Pair){a, b} : (Pair){b, a};
}

// The places of the bodies of a contact.
static inline Pair bodies_of(const World *world, const cpArbiter *arbiter) {
    return pair_of((uintptr_t)place_of(world, arbiter->body_a), (uintptr_t)place_of(world, arbiter->body_b));
}

void sort_pairs(Pair *list, int count);
// Whether a sorted list has a pair.
bool has_pair(const Pair *list, int count, Pair pair);

// The root of a set of bodies (union-find with path halving; Tarjan and van Leeuwen, "Worst-Case Analysis of Set Union
// Algorithms", JACM 1984); the least of a set is its root.
int root_of(int *parents, int place);
void unite(int *parents, int a, int b);
// Return sets of one body each.
int *sets_of(World *world);

#endif
