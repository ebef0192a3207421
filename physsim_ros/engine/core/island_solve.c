// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// One island in one sub-step: what the solvers of velocities and of positions share.

#include "island_solve.h"

// Turn bodies to their poses: sines and cosines are a sixth of the cost of a chain.
static void turn_bodies(const Island *island, const Pose *poses) {
    for (int body = 0; body < island->body_count; body++) {
        if (island->turns[body].yaw != poses[body].yaw) {
            island->turns[body] = (Turn){poses[body].yaw, rotation(poses[body].yaw)};
        }
    }
}

void read_rows(const Island *island, const Pose *poses, double *excess, Jacobian *jacobians) {
    turn_bodies(island, poses);
    Anchors anchors = {0};
    const Joint *joint = NULL;
    for (int row = 0; row < island->joint_row_count; row++) {
        const Row *of_joint = island->rows[row];
        if (of_joint->kind != ROW_PATH && island->joint_of_row[row] != joint && island->joint_of_row[row] != NULL) {
            // Rows of a joint have the same anchors.
            joint = island->joint_of_row[row];
            Ends ends = island->ends[row];
            anchors = anchors_turned(joint, poses[ends.a].p, island->turns[ends.a].by, poses[ends.b].p,
                                     island->turns[ends.b].by);
        }
        Links links = {row, island->further[row], island->ends, poses};
        double x = row_at(of_joint, island->guides, &anchors, links, jacobians);
        excess[row] = excess_of(of_joint, x);
    }
}

void change_velocities(Solve *solve, const Twist *changes, double share) {
    for (int body = 0; body < solve->island->body_count; body++) {
        Twist *twist = solve->velocities + body;
        *twist = twist_plus(*twist, changes[body], share);
        if (solve->island->inverses[body].mass > 0.0) {
            set_twist(solve->island->engine[body], *twist);
        }
    }
}

Layout layout_of(const Island *island) {
    return (Layout){.body_count = island->body_count,
                    .row_count = island->row_count,
                    .inverses = island->inverses,
                    .ends = island->ends,
                    .further = island->further,
                    .groups = island->groups};
}

Solve island_solve(World *world, const Island *island, const System *system) {
    Arena *arena = &world->own->arena;
    Solve solve = {
        .arena = arena, .overlap_kept = world->own->overlap_kept, .dt = world->dt, .island = island, .system = *system};
    solve.velocities = TAKE(arena, Twist, island->body_count);
    solve.poses = TAKE(arena, Pose, island->body_count);
    for (int body = 0; body < island->body_count; body++) {
        solve.poses[body] = pose_of(island->engine[body]);
        solve.velocities[body] = twist_of(island->engine[body]);
    }
    solve.excess = TAKE(arena, double, island->joint_row_count);
    solve.jacobians = TAKE(arena, Jacobian, island->further[island->row_count]);
    solve.holds = TAKE(arena, bool, island->joint_row_count);
    solve.springs = TAKE(arena, bool, island->row_count);
    for (int row = 0; row < island->joint_row_count; row++) {
        solve.holds[row] = island->rows[row]->law == LAW_BOUNDS;
        solve.springs[row] = island->rows[row]->law == LAW_SPRING;
    }
    read_rows(island, solve.poses, solve.excess, solve.jacobians);
    for (int number = 0; number < island->bearing_count; number++) {
        const Bearing *bearing = island->bearings + number;
        Vec against = negated(bearing->normal);
        solve.jacobians[normal_row(island, number)] = line_jacobian(against, bearing->arm_a, bearing->arm_b);
        solve.jacobians[tangent_row(island, number)] =
            line_jacobian(perpendicular(against), bearing->arm_a, bearing->arm_b);
        if (bearing->rolling_row != NULL) {
            bearing->rolling_row->row.most = bearing->rolling * greatest(bearing->point->jnAcc, 0.0);
        }
    }
    return solve;
}
