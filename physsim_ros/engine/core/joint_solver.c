// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Joint solver: jointed bodies and the contacts that they bear, solved directly after Chipmunk.
//
// Problem: ten iterations of Chipmunk's solver do not carry a load over a chain of light bodies. A straight chain
// carries by tension alone, which no row of velocities asks for. A gap that is closed by a velocity becomes energy
// where joints and contacts contradict each other.
// Method: all rows of an island are solved together (`mixed_lcp`), in velocities (`joint_velocities`) and then in
// positions (`joint_positions`). Chipmunk's impulses are the first guess.
// Chipmunk solves the constraints of joints all the same, and what they gave is taken back: by them its iterations know
// what bears the contacts that stay its own. Without them a stack on a platform that hangs by rods has nothing below it
// (law 18): ten boxes sink by 7 cm.
// Scope: impulses of springs without dampers, and contacts between bodies without joints, stay Chipmunk's.
// Cost: 5 µs a sub-step for a pendulum, 150 µs for a chain of fifty axles.
// Without it laws 14 to 16, 20, 22, 23, 33, 34, 61 and 62 fail.

#include "island_solve.h"
#include "stages.h"

// Whether springs, dampers and friction alone join an island: sleeping.c finds whether it rests.
static bool of_springs(const Island *island) {
    for (int row = 0; row < island->joint_row_count; row++) {
        if (island->rows[row]->law != LAW_SPRING && island->rows[row]->law != LAW_FRICTION) {
            return false;
        }
    }
    return true;
}

// Move the upper bounds that have a rate: by that as long as the joint holds, else no further than to where x will be
// in the next sub-step.
static void move_bounds(const Solve *solve) {
    const Island *island = solve->island;
    for (int number = 0; number < island->joint_row_count; number++) {
        Row *row = island->rows[number];
        if (row->law == LAW_BOUNDS && row->rate != 0.0) {
            double next = clamped(row->upper + row->rate * solve->dt, row->least, row->greatest);
            double ahead = row_rate(&solve->system, solve->jacobians, number, solve->velocities) * solve->dt;
            double given = row->upper + solve->excess[number] + ahead - limit_slop;
            row->upper = solve->holds[number] ? next : greatest(next, given);
        }
    }
}

static void correct_island(Solve *solve) {
    const Island *island = solve->island;
    for (int body = 0; body < island->body_count; body++) {
        solve->poses[body] = pose_of(island->engine[body]);
    }
    solve_positions(solve);
    move_bounds(solve);
    bool may_sleep = of_springs(island);
    for (int body = 0; body < island->body_count; body++) {
        if (island->inverses[body].mass > 0.0) {
            Pose now = pose_of(island->engine[body]), next = solve->poses[body];
            if (next.p.x != now.p.x || next.p.y != now.p.y || next.yaw != now.yaw) {
                set_pose(island->engine[body], next);
            }
            // A slow swing would fall asleep at its turn.
            island->engine[body]->idle_time = may_sleep ? island->engine[body]->idle_time : 0.0;
        }
    }
}

void find_joint_islands(World *world) {
    world->own->now.joint_islands = TAKE(&world->own->arena, Islands, 1);
    *world->own->now.joint_islands = joint_islands(world);
}

// Whether all islands have the layouts of the last sub-step.
static bool have_systems(const Private *own, const Islands *found) {
    bool have = own->system_count == found->count;
    for (int number = 0; number < found->count && have; number++) {
        have = has_layout(own->systems + number, layout_of(found->islands + number));
    }
    return have;
}

static void make_systems(Private *own, const Islands *found) {
    arena_reset(&own->system_arena);
    own->systems = TAKE(&own->system_arena, System, found->count);
    own->system_count = found->count;
    for (int number = 0; number < found->count; number++) {
        own->systems[number] = system_of(&own->system_arena, layout_of(found->islands + number));
    }
}

void solve_joints(World *world) {
    Private *own = world->own;
    Islands *found = own->now.joint_islands;
    if (!have_systems(own, found)) {
        make_systems(own, found);
    }
    found->solves = TAKE(&own->arena, Solve, found->count);
    for (int number = 0; number < found->count; number++) {
        const Island *island = found->islands + number;
        begin_system(own->systems + number, island->inverses);
        found->solves[number] = island_solve(world, island, own->systems + number);
        solve_velocities(found->solves + number);
    }
}

void correct_joint_positions(World *world) {
    for (int number = 0; number < world->own->now.joint_islands->count; number++) {
        correct_island(world->own->now.joint_islands->solves + number);
    }
}

void remove_closing_impulses(World *world) {
    for (int number = 0; number < world->own->now.joint_islands->count; number++) {
        const Island *island = world->own->now.joint_islands->islands + number;
        for (const Bearing *bearing = island->bearings; bearing < island->bearings + island->bearing_count; bearing++) {
            bearing->point->jnAcc -= bearing->closing;
        }
    }
}
