// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Positions of jointed bodies.
//
// Problem: velocities that keep to the rows leave gaps of second order. A straight chain stops what falls on it by
// these alone, since its rows have no velocity.
// Method: C(q) = 0 by Newton's method with the least mass-weighted displacement (fast projection: Goldenthal, Harmon,
// Fattal, Bercovier and Grinspun, SIGGRAPH 2007). Contacts are rows too, so that what joints pull in and what contacts
// push out is one system. An island makes only the share of a Newton step in which its rows are linear (trust region).
// The displacement then changes velocities as far as it takes energy from the bodies, seen from what holds them (the
// velocity update of position based dynamics: Müller, Heidelberger, Hennix and Ratcliff, 2007).
// Law: a gap never becomes energy.
// Reports: the impulses of that change are reported, but the next sub-step does not start from them. Where rows
// contradict each other they are of any size and cancel in these poses alone; a sub-step that started from them after a
// turn of its bodies would gain the difference.

#include "island_solve.h"
#include "mixed_lcp.h"
#include <string.h>

// E as a share of the diagonal of J M⁻¹ Jᵀ: of joints, and of contacts, which yield where joints contradict them.
static const double joint_position_softness = 1e-7, contact_position_softness = 1e-3;
// The first Newton step is made where a gap is wider than `negligible`, and a further one where it is wider than
// `closed` [m, rad]: ten planks in a straight row sag by 7 mm with a gap of 1e-6 m each.
static const double negligible = 1e-7, closed = 1e-5;
// The furthest that a body turns in a Newton step [rad]: rows are linear for small turns only, and points may be metres
// off.
static const double most_turn = 0.25;

// Count of Newton steps, at most.
enum { MOST_STEPS = 16 };

// A displacement of an island, as Newton's method finds it.
typedef struct Displacement {
    Pose *start, *pushed; // (body_count): before it, and after the pushes of other contacts
    double *excess;       // (joint_row_count): C at the poses of now
    Jacobian *jacobians;  // (link_count): of joints there
    double *gaps;         // (joint_row_count): C, less what is not closed in this sub-step
    double *deferred;     // (joint_row_count): parts of gaps that are too wide to be closed in one sub-step
    double *room;         // (bearing_count): distance by which contacts may approach at the start [m]
    double *distances;    // (bearing_count): the same now, < 0 where they overlap
    double *impulses;     // (row_count): λ [kg m, kg m²]
    double *guess;        // (row_count): numbers of the signs of λ; of contacts first their overlaps
    double sum, widest;   // of gaps and overlaps: sum, and the greatest [m, rad]
} Displacement;

// The iterate with the least sum of gaps so far.
typedef struct Best {
    double sum;
    Pose *poses;
    double *impulses;
} Best;

// C of a row, less the slop of limits.
static double gap_of(const Row *row, bool holds, double excess) {
    double slop = row->lower == row->upper ? 0.0 : limit_slop;
    return holds ? copysign(greatest(fabs(excess) - slop, 0.0), excess) : 0.0;
}

static Twist displacement(Pose from, Pose to) {
    return (Twist){sub(to.p, from.p), to.yaw - from.yaw};
}

// Move jointed bodies by the pushes of contacts that are no rows here. Those of the rows' own contacts are removed,
// since their overlaps are solved here. What has no joints is moved by Chipmunk in the next sub-step.
static void take_pushes(Solve *solve) {
    const Island *island = solve->island;
    Twist *momenta = TAKE(solve->arena, Twist, island->body_count);
    for (int number = 0; number < island->bearing_count; number++) {
        int row = normal_row(island, number);
        add_momenta(solve->jacobians[row], island->ends[row], island->bearings[number].point->jBias, momenta);
    }
    for (int body = 0; body < island->body_count; body++) {
        Inverse inverse = island->inverses[body];
        if (inverse.mass == 0.0) {
            continue;
        }
        cpBody *engine = island->engine[body];
        Vec push = sub(engine->v_bias, scaled(momenta[body].v, inverse.mass));
        double turn = engine->w_bias - momenta[body].w * inverse.moment;
        bool jointed = island->jointed[body];
        if (jointed) {
            solve->poses[body].p = add(solve->poses[body].p, scaled(push, solve->dt));
            solve->poses[body].yaw += turn * solve->dt;
        }
        engine->v_bias = jointed ? vec(0.0, 0.0) : push;
        engine->w_bias = jointed ? 0.0 : turn;
    }
}

static Displacement begin_displacement(Solve *solve) {
    const Island *island = solve->island;
    Arena *arena = solve->arena;
    Displacement move = {.start = TAKE(arena, Pose, island->body_count),
                         .pushed = TAKE(arena, Pose, island->body_count),
                         .excess = TAKE(arena, double, island->joint_row_count),
                         .jacobians = TAKE(arena, Jacobian, solve->system.link_count),
                         .gaps = TAKE(arena, double, island->joint_row_count),
                         .deferred = TAKE(arena, double, island->joint_row_count),
                         .room = TAKE(arena, double, island->bearing_count),
                         .distances = TAKE(arena, double, island->bearing_count),
                         .impulses = TAKE(arena, double, island->row_count),
                         .guess = TAKE(arena, double, island->row_count)};
    memcpy(move.start, solve->poses, (size_t)island->body_count * sizeof(Pose));
    take_pushes(solve);
    memcpy(move.pushed, solve->poses, (size_t)island->body_count * sizeof(Pose));
    memcpy(move.jacobians, solve->jacobians, (size_t)solve->system.link_count * sizeof(Jacobian));
    read_rows(island, solve->poses, move.excess, move.jacobians);
    double most = fastest_correction * solve->dt;
    for (int row = 0; row < island->joint_row_count; row++) {
        double gap = gap_of(island->rows[row], solve->holds[row], move.excess[row]);
        move.deferred[row] = gap - clamped(gap, -most, most);
    }
    // Of an overlap Chipmunk's share of a sub-step is pushed out; nothing gets deeper.
    for (int number = 0; number < island->bearing_count; number++) {
        const Bearing *bearing = island->bearings + number;
        Ends ends = island->ends[normal_row(island, number)];
        Vec a = add(move.start[ends.a].p, bearing->arm_a), b = add(move.start[ends.b].p, bearing->arm_b);
        double room = dot(sub(b, a), bearing->normal) + bearing->slop;
        move.room[number] = room - least(room, 0.0) * solve->overlap_kept;
        move.guess[normal_row(island, number)] = -move.room[number];
    }
    return move;
}

// Measure gaps and overlaps at the poses of now.
static void measure_gaps(const Solve *solve, Displacement *move) {
    const Island *island = solve->island;
    move->sum = move->widest = 0.0;
    for (int row = 0; row < island->joint_row_count; row++) {
        move->gaps[row] = gap_of(island->rows[row], solve->holds[row], move->excess[row]) - move->deferred[row];
        move->sum += fabs(move->gaps[row]);
        move->widest = greatest(move->widest, fabs(move->gaps[row]));
    }
    for (int number = 0; number < island->bearing_count; number++) {
        int row = normal_row(island, number);
        Ends ends = island->ends[row];
        Twist displacements[2] = {displacement(move->start[ends.a], solve->poses[ends.a]),
                                  displacement(move->start[ends.b], solve->poses[ends.b])};
        move->distances[number] = move->room[number] + link_rate(solve->jacobians[row], (Ends){0, 1}, displacements);
        double overlap = greatest(-move->distances[number], 0.0);
        move->sum += overlap;
        move->widest = greatest(move->widest, overlap);
    }
}

static void keep_better(const Solve *solve, const Displacement *move, Best *best) {
    if (move->sum < best->sum) {
        best->sum = move->sum;
        memcpy(best->poses, solve->poses, (size_t)solve->island->body_count * sizeof(Pose));
        memcpy(best->impulses, move->impulses, (size_t)solve->island->row_count * sizeof(double));
    }
}

// Return the displacement that closes linear gaps and overlaps.
static Solution newton_step(Solve *solve, const Displacement *move) {
    const Island *island = solve->island;
    Arena *arena = solve->arena;
    double *wanted = TAKE(arena, double, island->row_count), *soft = TAKE(arena, double, island->row_count);
    double *lower = TAKE(arena, double, island->row_count), *upper = TAKE(arena, double, island->row_count);
    Solution solution = solution_for(&solve->system, arena);
    for (int row = 0; row < island->row_count; row++) {
        soft[row] = row < island->joint_row_count ? joint_position_softness : contact_position_softness;
        if (row < island->joint_row_count) {
            wanted[row] = -move->gaps[row];
            lower[row] = lower_bound(island->rows[row], solve->holds[row], move->gaps[row]);
            upper[row] = upper_bound(island->rows[row], solve->holds[row], move->gaps[row]);
        } else if (row < tangent_row(island, 0)) {
            wanted[row] = -move->distances[row - island->joint_row_count];
            upper[row] = INFINITY;
        }
        solution.sides[row] = side_by_guess(move->guess[row], lower[row], upper[row]);
    }
    Problem problem = {move->jacobians, wanted, lower, upper, soft, NULL, NULL};
    solve_problem(&solve->system, &problem, &solution, arena);
    return solution;
}

// The share of a Newton step that is made.
static double trusted_share(const Solve *solve, const Twist *changes) {
    double turn = 0.0;
    for (int body = 0; body < solve->island->body_count; body++) {
        turn = greatest(turn, fabs(changes[body].w));
    }
    return turn > most_turn ? most_turn / turn : 1.0;
}

// The work that bodies which forces do not move do by the impulses of a displacement [J]: kinematic ones, if they move.
static double work_of_others(const Solve *solve, const Displacement *move, const double *impulses) {
    const Island *island = solve->island;
    Twist *momenta = TAKE(solve->arena, Twist, island->body_count);
    for (int row = 0; row < island->row_count; row++) {
        add_row_momenta(&solve->system, move->jacobians, row, impulses[row] / solve->dt, momenta);
    }
    double work = 0.0;
    for (int body = 0; body < island->body_count; body++) {
        if (island->inverses[body].mass == 0.0) {
            Twist velocity = solve->velocities[body];
            work -= dot(momenta[body].v, velocity.v) + momenta[body].w * velocity.w;
        }
    }
    return work;
}

// Change velocities by a displacement, as far as that takes more energy than others give: the same share is made
// however fast what holds an island moves.
static void remove_velocity(Solve *solve, const Displacement *move, const double *impulses) {
    const Island *island = solve->island;
    Twist *changes = TAKE(solve->arena, Twist, island->body_count);
    for (int body = 0; body < island->body_count; body++) {
        Twist moves = displacement(move->pushed[body], solve->poses[body]);
        changes[body] = (Twist){scaled(moves.v, 1.0 / solve->dt), moves.w / solve->dt};
    }
    double lost = work_of_others(solve, move, impulses) - mass_product(&solve->system, solve->velocities, changes);
    double share = paid_share(lost, mass_product(&solve->system, changes, changes));
    change_velocities(solve, changes, share);
    for (int row = 0; row < island->joint_row_count; row++) {
        double factor = factor_of(island->rows[row], move->excess[row]);
        *island->closing[row] = impulses[row] * share / solve->dt / factor;
    }
    for (int number = 0; number < island->bearing_count; number++) {
        Bearing *bearing = island->bearings + number;
        bearing->closing = impulses[normal_row(island, number)] * share / solve->dt;
        bearing->point->jnAcc += bearing->closing;
    }
}

// Whether a joint is being drawn together since it was made or changed.
static bool any_drawn(const Island *island) {
    for (int number = 0; number < island->joint_count; number++) {
        if (island->joints[number]->excess > 0.0) {
            return true;
        }
    }
    return false;
}

// Have momenta turn with the rows along which joints that were just made or changed were drawn together.
//
// A displacement is a motion, whose impulse λ / dt begins along J and ends along J + dt dJ/dt, so that momenta change
// by -(dJ/dt)ᵀ λ. A ball on a rope that is shortened keeps its angular momentum by this, and the rope does work.
// Between joints that contradict each other λ is of any size, and would give energy.
static void turn_momenta(Solve *solve, const Displacement *move, const double *impulses) {
    const Island *island = solve->island;
    if (!any_drawn(island)) {
        return;
    }
    double *excess = TAKE(solve->arena, double, island->joint_row_count);
    Jacobian *later = TAKE(solve->arena, Jacobian, solve->system.link_count);
    Pose *ahead = TAKE(solve->arena, Pose, island->body_count);
    Twist *changes = TAKE(solve->arena, Twist, island->body_count);
    for (int body = 0; body < island->body_count; body++) {
        ahead[body] = moved(solve->poses[body], solve->velocities[body], solve->dt);
    }
    read_rows(island, ahead, excess, later);
    for (int row = 0; row < island->joint_row_count; row++) {
        const Joint *joint = island->joint_of_row[row];
        bool drawn = joint != NULL && joint->excess > 0.0;
        double impulse = drawn ? impulses[row] / solve->dt : 0.0;
        add_row_momenta(&solve->system, move->jacobians, row, impulse, changes);
        add_row_momenta(&solve->system, later, row, -impulse, changes);
    }
    for (int body = 0; body < island->body_count; body++) {
        changes[body].v = scaled(changes[body].v, island->inverses[body].mass);
        changes[body].w *= island->inverses[body].moment;
    }
    change_velocities(solve, changes, 1.0);
}

void solve_positions(Solve *solve) {
    const Island *island = solve->island;
    size_t mark = arena_mark(solve->arena);
    Displacement move = begin_displacement(solve);
    Best best = {INFINITY, TAKE(solve->arena, Pose, island->body_count), TAKE(solve->arena, double, island->row_count)};
    // Where no sum is a number, bodies stay.
    memcpy(best.poses, solve->poses, (size_t)island->body_count * sizeof(Pose));
    int number = 0;
    for (;; number++) {
        measure_gaps(solve, &move);
        keep_better(solve, &move, &best);
        if (number == MOST_STEPS || move.widest <= (number > 0 ? closed : negligible)) {
            break;
        }
        size_t step = arena_mark(solve->arena);
        Solution solution = newton_step(solve, &move);
        double share = trusted_share(solve, solution.changes);
        for (int body = 0; body < island->body_count; body++) {
            solve->poses[body].p = add(solve->poses[body].p, scaled(solution.changes[body].v, share));
            solve->poses[body].yaw += solution.changes[body].w * share;
        }
        for (int row = 0; row < island->row_count; row++) {
            move.impulses[row] += solution.impulses[row] * share;
            move.guess[row] = move.impulses[row];
        }
        arena_release(solve->arena, step);
        read_rows(island, solve->poses, move.excess, move.jacobians);
    }
    if (number > 0) {
        memcpy(solve->poses, best.poses, (size_t)island->body_count * sizeof(Pose));
        read_rows(island, solve->poses, move.excess, move.jacobians);
        turn_momenta(solve, &move, best.impulses);
        remove_velocity(solve, &move, best.impulses);
    }
    arena_release(solve->arena, mark);
}
