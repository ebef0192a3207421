// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Joint solver: jointed bodies and the contacts that they bear, solved directly after Chipmunk.
//
// Problem: ten iterations of Chipmunk's solver do not carry a load over a chain of light bodies. A straight chain
// carries by tension alone, which no row of velocities asks for. A gap that is closed by a velocity becomes energy
// where joints and contacts contradict each other. Method: all rows of an island are solved together (`saddle_point`),
// in velocities (`joint_velocities`) and then in positions (`joint_positions`). Cost: 5 µs a step for a pendulum, 150
// µs for a chain of fifty axles. Without it laws 14 to 16, 20, 22, 23, 33 and 34 fail. Chipmunk's impulses are the
// first guess. Impulses of springs and motors, and contacts between bodies without joints, stay Chipmunk's.

#include "joint_solver.h"
#include "stages.h"

void read_rows(const Island *island, const Pose *poses, double *excess, Jacobian *jacobians) {
    int row = 0;
    for (int number = 0; number < island->joint_count; number++) {
        const Joint *joint = island->joints[number];
        Pose a = poses[island->ends[row].a], b = poses[island->ends[row].b];
        Anchors anchors = anchors_at(joint, a, b);
        for (int each = 0; each < joint->row_count; each++, row++) {
            const Row *of_joint = island->rows[row];
            double x = row_at(of_joint, joint, &anchors, a, b, jacobians + row);
            excess[row] = greatest(x - of_joint->upper, 0.0) + least(x - of_joint->lower, 0.0);
        }
    }
}

void change_velocities(Solve *solve, const Twist *changes, double share) {
    for (int body = 0; body < solve->island->body_count; body++) {
        Twist *twist = solve->velocities + body;
        twist->v = add(twist->v, scaled(changes[body].v, share));
        twist->w += changes[body].w * share;
        if (solve->island->inverses[body].mass > 0.0) {
            set_twist(solve->island->engine[body], *twist);
        }
    }
}

static Solve begin(World *world, const Island *island) {
    Arena *arena = &world->own->arena;
    Solve solve = {.arena = arena, .space = world->space, .dt = world->dt, .island = island};
    solve.velocities = island->velocities;
    solve.poses = island->poses;
    solve.excess = TAKE(arena, double, island->joint_row_count);
    solve.jacobians = TAKE(arena, Jacobian, island->row_count);
    solve.holds = TAKE(arena, bool, island->joint_row_count);
    solve.springs = TAKE(arena, bool, island->row_count);
    solve.system =
        system_of(arena, island->body_count, island->inverses, island->row_count, island->ends, island->groups);
    for (int row = 0; row < island->joint_row_count; row++) {
        solve.holds[row] = island->rows[row]->kind != ROW_SPRING;
        solve.springs[row] = !solve.holds[row];
    }
    read_rows(island, island->poses, solve.excess, solve.jacobians);
    int normal = island->joint_row_count, tangent = normal + island->touch_count;
    for (int number = 0; number < island->touch_count; number++) {
        const Bearing *touch = island->touches + number;
        Vec against = negated(touch->normal);
        solve.jacobians[normal + number] = along(against, touch->arm_a, touch->arm_b);
        solve.jacobians[tangent + number] = along(perpendicular(against), touch->arm_a, touch->arm_b);
    }
    return solve;
}

// Whether springs and dampers alone join an island: sleeping.c finds whether it rests.
static bool of_springs(const Island *island) {
    for (int row = 0; row < island->joint_row_count; row++) {
        if (island->rows[row]->kind != ROW_SPRING) {
            return false;
        }
    }
    return true;
}

static void solve_island(World *world, const Island *island) {
    size_t mark = arena_mark(&world->own->arena);
    Solve solve = begin(world, island);
    solve_velocities(&solve);
    solve_positions(&solve);
    bool may_sleep = of_springs(island);
    for (int body = 0; body < island->body_count; body++) {
        if (island->inverses[body].mass > 0.0) {
            set_pose(island->engine[body], island->poses[body]);
            // A slow swing would fall asleep at its turn.
            island->engine[body]->idle_time = may_sleep ? island->engine[body]->idle_time : 0.0;
        }
    }
    arena_release(&world->own->arena, mark);
}

void solve_joints(World *world) {
    if (!has_stage(world, STAGE_JOINTS)) {
        return;
    }
    Islands found = joint_islands(world);
    for (int number = 0; number < found.count; number++) {
        solve_island(world, found.islands + number);
    }
}
