// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The pipeline: one step of a world, stage by stage. `stages.h` says what each does, and its file why and how.

#include "stages.h"
#include <time.h>

static void begin_body(Body *body) {
    assert(body_of(body->engine) == body);
    body->scratch.begin = pose_of(body->engine);
    body->scratch.carried = body->scratch.remaining_move = (Twist){0};
    body->scratch.remaining = body->scratch.since = 0.0;
    body->scratch.bounces = body->scratch.has_remaining_move = false;
    body->scratch.idle = sleeps(body) ? -1.0 : body->engine->idle_time;
}

static void begin_bodies(World *world) {
    for (int number = 0; number < active_count(world); number++) {
        begin_body(active_at(world, number));
    }
}

// Begin the next sub-step of bodies that have fallen asleep in this one: until they wake it is not done again.
static void begin_sleepers(Body *const *bodies, int count) {
    for (int number = 0; number < count; number++) {
        if (sleeps(bodies[number])) {
            begin_body(bodies[number]);
            bodies[number]->scratch.twist = twist_of(bodies[number]->engine);
            bodies[number]->state.free = false;
        }
    }
}

// Note the velocities that Chipmunk's step begins with, and what requests did to bodies before it.
static void save_start(World *world) {
    for (int number = 0; number < active_count(world); number++) {
        Body *body = active_at(world, number);
        body->scratch.twist = twist_of(body->engine);
        body->scratch.thrown = body->state.thrown;
        body->state.thrown = body->state.released = false;
    }
}

static bool is_lost(const cpBody *engine, double farthest) {
    // NaN compares false, so that it is lost too.
    return !(fabs(engine->p.x) < farthest && fabs(engine->p.y) < farthest && fabs(engine->a) < farthest &&
             fabs(engine->v.x) < farthest && fabs(engine->v.y) < farthest && fabs(engine->w) < farthest);
}

static void find_lost(World *world) {
    world->has_lost = false;
    for (int number = 0; number < active_count(world); number++) {
        Body *body = active_at(world, number);
        body->scratch.lost = is_lost(body->engine, world->farthest);
        world->has_lost = world->has_lost || body->scratch.lost;
    }
}

// Chipmunk calls this between its narrow phase and its solver: all contacts of the step are known, with their target
// velocities, and none has been solved. Munk2D has no hook there but that of constraints (`preSolve`, called after
// `cpArbiterPreStep` of all contacts); it can go when it has one.
static void before_solving(cpConstraint *hook, cpSpace *space) {
    (void)space;
    World *world = hook->userData;
    correct_first_touches(world);
    set_overlap_biases(world);
    move_belts(world);
    order_points(world);
    list_load_bounds(world);
    time_impacts(world);
    defer_contacts(world);
    damp_steep_friction(world);
    solve_impacts(world);
    find_joint_islands(world);
    find_rolls(world);
}

// Step Chipmunk; return the bodies that were awake before.
static Body **step_chipmunk(World *world, int *count) {
    *count = world->space->dynamicBodies->num;
    Body **awake = TAKE(&world->own->arena, Body *, *count);
    for (int number = 0; number < *count; number++) {
        awake[number] = body_of(world->space->dynamicBodies->arr[number]);
    }
    begin_rolling(world);
    world->own->hook->preSolve = before_solving;
    world->chipmunk.space_step(world->space, world->dt);
    world->own->hook->preSolve = NULL;
    end_rolling(world);
    return awake;
}

static void make_sub_step(World *world) {
    reset_memory(world);
    begin_fields(world);
    begin_half_step(world);
    begin_bodies(world);
    apply_forces(world);
    pull_grips(world);
    apply_fields(world);
    roll_wheels(world);
    apply_floor(world);
    find_loaded(world);
    clamp_moves(world);
    tighten_boxes(world);
    prepare_parts(world);
    command_motors(world);
    save_start(world);
    int awake_count = 0;
    Body **awake = step_chipmunk(world, &awake_count);
    keep_fields(world);
    find_leads(world, world->has_fields);
    ignore_jitter(world);
    solve_joints(world);
    report_joint_impulses(world);
    find_loaded(world);
    finish_moves(world);
    correct_joint_positions(world);
    report_joint_closings(world);
    find_floor_pushes(world);
    reckon_odometry(world);
    use_batteries(world);
    if (world->own->reports) {
        report_contacts(world);
    } else {
        forget_contacts(world);
    }
    find_free(world);
    keep_awake(world);
    remove_closing_impulses(world);
    remove_impact_impulses(world);
    begin_sleepers(awake, awake_count);
}

// Time since some moment [s].
static double wall_clock(void) {
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

// The time of a call of the core, which makes its work in parts.
typedef struct {
    double began; // [s]
    double ended; // its last part [s]
} CallTime;

// End a part; whether another one as long as this would end too late. A clock that was set back ends the call, too.
static bool end_part(const World *world, CallTime *time) {
    double now = wall_clock(), part = now - time->ended, took = now - time->began;
    time->ended = now;
    return !(part >= 0.0 && took >= 0.0 && took + part <= world->longest_call);
}

// Begin a step, before its first sub-step; false where the next call of the core goes on with that.
static bool begin_step(World *world, CallTime *time) {
    Private *own = world->own;
    if (!own->choosing) {
        reset_memory(world);
        damp_resting(world);
        clear_joint_reports(world);
        measure_drawn_joints(world);
        begin_actors(world);
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
    world->frame_steps += own->reports;
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
    double now = wall_clock();
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
        make_sub_step(world);
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
