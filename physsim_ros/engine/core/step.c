// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The pipeline: one step of a world, stage by stage. `stages.h` says what each does, and its file why and how.

#include "stages.h"
#include <time.h>

static void begin_body(Body *body) {
    assert(body_of(body->engine) == body);
    body->own->begin = pose_of(body->engine);
    body->own->carried = body->own->remaining_move = (Twist){0};
    body->own->remaining = body->own->since = 0.0;
    body->own->bounces = body->own->has_remaining_move = false;
    body->own->idle = sleeps(body) ? -1.0 : body->engine->idle_time;
}

static void begin_bodies(World *world) {
    for (int number = 0; number < active_count(world); number++) {
        begin_body(active_at(world, number));
    }
}

// Begin the next sub-step of bodies that have fallen asleep in this one: until they wake it is not done again.
static void begin_sleepers(World *world) {
    for (int number = 0; number < world->own->now.awake_count; number++) {
        Body *body = world->own->now.awake[number];
        if (sleeps(body)) {
            begin_body(body);
            body->own->twist = twist_of(body->engine);
            body->state.free = false;
        }
    }
}

// Note the velocities that Chipmunk's step begins with, and what requests did to bodies before it.
static void save_start(World *world) {
    for (int number = 0; number < active_count(world); number++) {
        Body *body = active_at(world, number);
        body->own->twist = twist_of(body->engine);
        body->own->thrown = body->state.thrown;
        body->state.thrown = body->state.released = false;
    }
}

static bool is_lost(const cpBody *engine, double farthest) {
    // NaN compares false, so that it is lost too.
    return !(fabs(engine->p.x) < farthest && fabs(engine->p.y) < farthest && fabs(engine->a) < farthest &&
             fabs(engine->v.x) < farthest && fabs(engine->v.y) < farthest && fabs(engine->w) < farthest);
}

static void find_lost(World *world) {
    for (int number = 0; number < active_count(world); number++) {
        Body *body = active_at(world, number);
        body->lost = is_lost(body->engine, world->farthest);
        world->has_lost = world->has_lost || body->lost;
    }
}

// A stage, and the part of the step that is left out with it (`STAGE_...`); 0 is a stage that is never left out. Two
// parts are left out within functions, since several stages call these, and so does the reading of a state: that of
// STAGE_HALF_STEP in `find_leads` and `turn_leads`, that of STAGE_SUPPORT as `begin_flights` finds what flies.
typedef struct Stage {
    void (*act)(World *world);
    uint32_t part;
} Stage;

static void run(World *world, const Stage *stages) {
    for (const Stage *stage = stages; stage->act != NULL; stage++) {
        if (has_stage(world, stage->part)) {
            stage->act(world);
        }
    }
}

// Between Chipmunk's narrow phase and its solver: all contacts of the step are known, with their target velocities, and
// none has been solved. Each stage has what the ones before have made of the contacts; beside it is what it sets.
static const Stage contact_stages[] = {
    {ignore_passing, 0},                           // contacts without points: of bodies that pass each other
    {ignore_false_contacts, STAGE_FALSE_CONTACTS}, // the same: of bodies that do not touch
    {find_begun, 0},                               // the list of contacts that begin
    {move_to_impacts, STAGE_IMPACT},               // in it: normals and points
    {slide_over_edges, STAGE_EDGES},               // in it: normals at seams; hidden contacts leave it
    {prepare_begun, 0},                            // contacts, by that list
    {set_overlap_biases, 0},                       // bias
    {move_belts, 0},                               // surface velocities
    {order_points, STAGE_ORDER},                   // which of two points is the first
    {list_load_bounds, STAGE_LOADS},               // the greatest impulses to start the next sub-step from
    {time_impacts, STAGE_REST_OF_STEP},            // bounce, and how long ago impacts were
    {defer_contacts, STAGE_PROPAGATION},           // bounce, of contacts that wait for a faster impact
    {damp_steep_friction, STAGE_STEEP_FRICTION},   // nMass
    {solve_impacts, STAGE_BLOCK_SOLVER},           // impulses that the solver starts from, and velocities
    {find_joint_islands, STAGE_JOINTS},            // islands, with the contacts that are their rows
    {find_rolls, 0},                               // contacts that roll and are no such row
    {NULL, 0},
};

// Munk2D has no hook there but that of constraints (`preSolve`, called after `cpArbiterPreStep` of all contacts); it
// can go when it has one.
static void before_solving(cpConstraint *hook, cpSpace *space) {
    (void)space;
    run(hook->userData, contact_stages);
}

static void step_chipmunk(World *world) {
    const cpArray *awake = world->space->dynamicBodies;
    SubStep *now = &world->own->now;
    now->awake = TAKE(&world->own->arena, Body *, awake->num);
    for (now->awake_count = 0; now->awake_count < awake->num; now->awake_count++) {
        now->awake[now->awake_count] = body_of(awake->arr[now->awake_count]);
    }
    begin_rolling(world);
    world->own->hook->preSolve = before_solving;
    world->chipmunk.space_step(world->space, world->dt);
    world->own->hook->preSolve = NULL;
    end_rolling(world);
}

// A sub-step; beside each stage is what it sets. Chipmunk moves bodies by their velocities first, and finds new
// velocities then.
static const Stage sub_step_stages[] = {
    {begin_fields, STAGE_FIELDS},            // leads by fields, of bodies that requests have changed
    {begin_flights, 0},                      // leads; which bodies are in free flight, and their velocities
    {begin_bodies, 0},                       // the poses of the beginning; what stages have found of bodies is cleared
    {apply_forces, 0},                       // forces, of commands and of bodies
    {pull_grips, 0},                         // forces
    {apply_fields, STAGE_FIELDS},            // forces, and half of what they change velocities by
    {roll_wheels, STAGE_FLOOR},              // velocities of the floor under robots
    {apply_floor, STAGE_FLOOR},              // velocities and forces of what the floor carries
    {find_loaded, 0},                        // one-way contacts with a load, by the last impulses: for `clamp_moves`
    {clamp_moves, STAGE_CONTINUOUS},         // poses, set back so that Chipmunk's move ends at the first impact
    {tighten_boxes, STAGE_TIGHT_BOXES},      // boxes in Chipmunk's tree
    {prepare_parts, 0},                      // anchors of constraints
    {command_motors, 0},                     // rates of rows
    {save_start, 0},                         // velocities before the solver
    {step_chipmunk, 0},                      // poses, contacts by `contact_stages`, velocities, impulses
    {keep_fields, STAGE_FIELDS},             // leads, with those by fields
    {turn_leads, 0},                         // leads by forces that turn with their bodies
    {ignore_jitter, 0},                      // idle times
    {solve_joints, STAGE_JOINTS},            // velocities and impulses of islands of joints
    {report_joint_impulses, 0},              // impulses that joints report
    {find_loaded, 0},                        // by the new impulses: for the sweeps of `finish_moves`
    {finish_moves, 0},                       // poses, by the velocities after impacts
    {correct_joint_positions, STAGE_JOINTS}, // poses, and impulses that close gaps
    {report_joint_closings, 0},              // impulses that joints report
    {find_floor_pushes, STAGE_FLOOR},        // what contacts and joints have changed on the floor
    {reckon_odometry, STAGE_FLOOR},          // odometry
    {use_batteries, STAGE_FLOOR},            // charges
    {report_contacts, 0},                    // contacts of the frame
    {find_free, 0},                          // which bodies are in free flight
    {keep_awake, 0},                         // idle times
    {remove_closing_impulses, STAGE_JOINTS}, // impulses that the next sub-step starts from
    {remove_impact_impulses, STAGE_LOADS},   // the same
    {begin_sleepers, 0},                     // the same, poses and idle times of bodies that have fallen asleep
    {NULL, 0},
};

// Before the first sub-step of a step.
static const Stage first_stages[] = {
    {damp_resting, STAGE_RESTING_DAMPING}, // velocities of what friction locks in place
    {clear_joint_reports, 0},
    {measure_drawn_joints, 0},
    {begin_actors, 0},
    {NULL, 0},
};

// Time since some moment [s], by a clock that is never set.
static double monotonic_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

// The time of a call of the core, which makes its work in parts.
typedef struct {
    double began; // [s]
    double ended; // its last part [s]
} CallTime;

// End a part; whether another one as long as this would end too late.
static bool end_part(const World *world, CallTime *time) {
    double now = monotonic_clock(), part = now - time->ended, took = now - time->began;
    time->ended = now;
    return took + part > world->longest_call;
}

// Begin a step, before its first sub-step; false where the next call of the core goes on with that.
static bool begin_step(World *world, CallTime *time) {
    Private *own = world->own;
    if (!own->choosing) {
        reset_memory(world);
        run(world, first_stages);
    }
    own->choosing = true;
    while (choose_velocity(world)) {
        if (end_part(world, time)) {
            return false;
        }
    }
    own->choosing = false;
    move_actors(world);
    own->reports = world->reports_contacts;
    world->reported_steps += own->reports;
    return true;
}

static void end_step(World *world) {
    find_broken_joints(world);
    find_lost(world);
    world->step++;
    world->age++;
}

// Where a call ends by the time decides when the next sub-step, or the velocity of the next actor is chosen, and never
// its bits.
int32_t core_step(World *world, int32_t count) {
    Private *own = world->own;
    double now = monotonic_clock();
    CallTime time = {.began = now, .ended = now};
    int32_t made = 0;
    own->kept = pow(world->space->damping, world->dt);
    own->overlap_kept = pow(world->space->collisionBias, world->dt);
    world->has_broken = world->has_lost = false;
    do {
        own->call_step = made;
        if (own->sub_step == 0 && !begin_step(world, &time)) {
            world->within_step = true;
            break;
        }
        reset_memory(world);
        run(world, sub_step_stages);
        own->all_active = false;
        own->sub_step = (own->sub_step + 1) % SUB_STEPS;
        world->within_step = own->sub_step > 0;
        if (!world->within_step) {
            end_step(world);
            made++;
        }
    } while (made < count && !end_part(world, &time) && !world->has_broken && !world->has_lost);
    own->all_active = true;
    return made;
}
