// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Velocities of jointed bodies.
//
// The impulses that Chipmunk gave to the rows of an island are taken back. Joints and contacts along their normals are
// solved without friction, friction then within its cone (staggered projections: Kaufman, Sueda, James and Pai,
// SIGGRAPH Asia 2008). Both are projections, by which kinetic energy can only fall; contacts that bounce can make it
// rise. An island then has the greatest share of its bounces with which their impulses do no work.
//
// Curvature: a point on a circle leaves its tangent in half a step, so that rows are solved for
// J v = - dt / 2 (dJ/dt) v, as SHAKE has it (Ryckaert, Ciccotti and Berendsen, J. Comput. Phys. 23, 1977); without that
// a pendulum loses (w dt)² / 2 of its energy in a step. An island gets no more energy by this than its rows take from
// the velocities with which the step began: those of a point that follows its circle are half a step behind it, and
// pay for it; those of a taut straight chain, whose rows are singular, get no energy. A limit that holds, as a taut
// rope does, also gets the curvature term if that loads it more.

#include "joint_velocities.h"
#include "mixed_lcp.h"
#include <string.h>

// E, as a share of the diagonal of J M⁻¹ Jᵀ. The impulses are Chipmunk's next guess; without E those of joints that
// contradict each other would be of any size.
static const double softness = 1e-6;

// Springs with a damper, and those that are too stiff for the step (`joints/stiffness.py`), are soft rows: the impulse
// of the step is -dt (k x + c v), x the strain before it and v the velocity after it (implicit Euler of the damper;
// Catto, "Soft Constraints", GDC 2011), with all loads and joints that act.

// The rows of an island in velocities.
typedef struct Impact {
    Problem problem;
    double *wanted, *lower, *upper; // of the problem
    double *rates;                  // (row_count): J v without impulses
    double *given;                  // (row_count): λ of Chipmunk
    double *bounce;                 // (touch_count): least velocity along the normal that Chipmunk seeks [m/s]
} Impact;

// Impulses, and what they change.
typedef struct Change {
    double *impulses; // (row_count): λ
    Twist *twists;    // (body_count)
    double energy;    // of the change of velocities, twice [J]
} Change;

static double softness_of(const Solve *solve, int row) {
    const Row *of_joint = solve->island->rows[row];
    if (of_joint->kind != ROW_SPRING) {
        return softness;
    }
    Ends ends = solve->island->ends[row];
    const Inverse *inverses = solve->island->inverses;
    double own = softness_unit(solve->jacobians[row], inverses[ends.a], inverses[ends.b]);
    return 1.0 / (solve->dt * of_joint->damping * own);
}

static Impact begin(Solve *solve, const Twist *without) {
    const Island *island = solve->island;
    Arena *arena = solve->arena;
    Impact impact = {.wanted = TAKE(arena, double, island->row_count),
                     .lower = TAKE(arena, double, island->row_count),
                     .upper = TAKE(arena, double, island->row_count),
                     .rates = TAKE(arena, double, island->row_count),
                     .bounce = TAKE(arena, double, island->touch_count)};
    double *soft = TAKE(arena, double, island->row_count);
    for (int row = 0; row < island->row_count; row++) {
        soft[row] = row < island->joint_row_count ? softness_of(solve, row) : softness;
        impact.rates[row] = rate(solve->jacobians[row], island->ends[row], without);
    }
    for (int number = 0; number < island->touch_count; number++) {
        impact.bounce[number] = -island->touches[number].point->bounce;
    }
    impact.problem = (Problem){solve->jacobians, impact.wanted, impact.lower, impact.upper, soft, solve->springs};
    return impact;
}

// λ that Chipmunk gave, and velocities without them.
static double *take_back(Solve *solve, Twist *without) {
    const Island *island = solve->island;
    int normal = island->joint_row_count, tangent = normal + island->touch_count;
    double *given = TAKE(solve->arena, double, island->row_count);
    for (int row = 0; row < normal; row++) {
        given[row] = *island->impulses[row] * sign_of(island->rows[row], solve->excess[row]);
    }
    for (int number = 0; number < island->touch_count; number++) {
        given[normal + number] = island->touches[number].point->jnAcc;
        given[tangent + number] = island->touches[number].point->jtAcc;
    }
    for (int row = 0; row < island->row_count; row++) {
        add_momenta(solve->jacobians[row], island->ends[row], -given[row], without);
    }
    for (int body = 0; body < island->body_count; body++) {
        Inverse inverse = island->inverses[body];
        without[body].v = add(solve->velocities[body].v, scaled(without[body].v, inverse.mass));
        without[body].w = solve->velocities[body].w + without[body].w * inverse.moment;
    }
    return given;
}

static void solve_friction(Solve *solve, Impact *impact, Solution *solution) {
    const Island *island = solve->island;
    int normal = island->joint_row_count, tangent = normal + island->touch_count;
    // Contacts that press are equalities, and what is at a bound stays there.
    for (int row = 0; row < island->row_count; row++) {
        bool acts = solution->sides[row] == 0;
        impact->lower[row] = acts ? -INFINITY : solution->impulses[row];
        impact->upper[row] = acts ? INFINITY : solution->impulses[row];
    }
    for (int number = 0; number < island->touch_count; number++) {
        double friction = island->touches[number].friction, guess = impact->given[tangent + number];
        double most = friction * greatest(solution->impulses[normal + number], 0.0);
        double known = friction * impact->given[normal + number] * (1.0 - 1e-9);
        bool slides = fabs(guess) >= known || most == 0.0;
        impact->lower[tangent + number] = -most;
        impact->upper[tangent + number] = most;
        solution->sides[tangent + number] = (int8_t)(slides ? (guess < 0.0 ? -1 : 1) : 0);
    }
    solve_problem(&solve->system, &impact->problem, solution, solve->arena);
    if (solution->wrong_count == 0) {
        return;
    }
    for (int row = tangent; row < island->row_count; row++) {
        if (solution->wrong[row]) {
            impact->lower[row] = impact->upper[row] = 0.0;
            solution->sides[row] = -1;
        }
    }
    solve_problem(&solve->system, &impact->problem, solution, solve->arena);
}

// Return the solution, friction included, with some least velocities along the normals of contacts [m/s].
static Solution solve_impact(Solve *solve, Impact *impact, const double *bounce) {
    const Island *island = solve->island;
    int normal = island->joint_row_count, tangent = normal + island->touch_count;
    Solution solution = solution_for(&solve->system, solve->arena);
    for (int row = 0; row < island->row_count; row++) {
        double target = row < normal    ? 0.0
                        : row < tangent ? bounce[row - normal]
                                        : -island->touches[row - tangent].slide;
        impact->wanted[row] = target - impact->rates[row];
        impact->lower[row] = 0.0;
        impact->upper[row] = row >= normal && row < tangent ? INFINITY : 0.0;
        if (row < normal) {
            const Row *of_joint = island->rows[row];
            if (of_joint->kind == ROW_SPRING) {
                impact->wanted[row] -= of_joint->stiffness * solve->excess[row] / of_joint->damping;
            }
            impact->lower[row] = greatest(lower_bound(of_joint, true, solve->excess[row]), -of_joint->most);
            impact->upper[row] = least(upper_bound(of_joint, true, solve->excess[row]), of_joint->most);
        }
        solution.sides[row] = side_of(impact->given[row], impact->lower[row], impact->upper[row]);
    }
    solve_problem(&solve->system, &impact->problem, &solution, solve->arena);
    if (island->touch_count > 0) {
        solve_friction(solve, impact, &solution);
    }
    refine(&solve->system, &impact->problem, &solution, solve->arena);
    return solution;
}

// The work of the impulses of a solution [J].
//
// Velocities are relative to the surfaces that touch: the work that a kinematic body or a conveyor does is not counted.
// Chipmunk measures the approach before gravity and springs act on it, so that it may have been as fast as `bounce`.
static double work_of(const Solve *solve, const Impact *impact, const Solution *solution) {
    const Island *island = solve->island;
    int normal = island->joint_row_count, tangent = normal + island->touch_count;
    double work = 0.0;
    for (int row = 0; row < island->row_count; row++) {
        double before = impact->rates[row] + (row >= tangent ? island->touches[row - tangent].slide : 0.0);
        double after = before + rate(solve->jacobians[row], island->ends[row], solution->changes);
        if (row >= normal && row < tangent && impact->bounce[row - normal] > 0.0) {
            before = least(before, -impact->bounce[row - normal]);
        }
        // A spring gives back what it has taken.
        work += row < normal && solve->springs[row] ? 0.0 : solution->impulses[row] * (before + after) / 2.0;
    }
    return work;
}

// Mix two solutions, with and without bounces, so that the impulses do no work; it meets the bounds of both, which are
// convex. Work is a quadratic function of the share: bend share² + slope share + lost.
static void mix(const Solve *solve, Solution *elastic, const Solution *plastic, double gained, double lost) {
    const Island *island = solve->island;
    for (int body = 0; body < island->body_count; body++) {
        elastic->changes[body].v = sub(elastic->changes[body].v, plastic->changes[body].v);
        elastic->changes[body].w -= plastic->changes[body].w;
    }
    double bend = mass_product(&solve->system, elastic->changes, elastic->changes) / 2.0;
    lost = least(lost, 0.0);
    double slope = gained - lost - bend;
    double share = -2.0 * lost / greatest(slope + sqrt(slope * slope - 4.0 * bend * lost), 1e-300);
    for (int body = 0; body < island->body_count; body++) {
        elastic->changes[body].v = add(plastic->changes[body].v, scaled(elastic->changes[body].v, share));
        elastic->changes[body].w = plastic->changes[body].w + elastic->changes[body].w * share;
    }
    for (int row = 0; row < island->row_count; row++) {
        double difference = elastic->impulses[row] - plastic->impulses[row];
        elastic->impulses[row] = plastic->impulses[row] + difference * share;
        elastic->sides[row] = plastic->sides[row];
    }
}

// Return the solution with bounces, less the share of them that would create energy.
static Solution solve_bounces(Solve *solve, Impact *impact) {
    Solution solution = solve_impact(solve, impact, impact->bounce);
    bool bounces = false;
    double *none = TAKE(solve->arena, double, solve->island->touch_count);
    for (int number = 0; number < solve->island->touch_count; number++) {
        bounces = bounces || impact->bounce[number] > 0.0;
        none[number] = least(impact->bounce[number], 0.0);
    }
    double gained = bounces ? work_of(solve, impact, &solution) : 0.0;
    if (gained > 0.0) {
        Solution plastic = solve_impact(solve, impact, none);
        mix(solve, &solution, &plastic, gained, work_of(solve, impact, &plastic));
    }
    return solution;
}

// Change the rates of the rows that hold in a solution, whose factors the system has.
static Change changed_by(Solve *solve, const Solution *solution, const double *rates) {
    Change change = {TAKE(solve->arena, double, solve->island->row_count),
                     TAKE(solve->arena, Twist, solve->island->body_count), 0.0};
    solve_active(&solve->system, solution->sides, rates, change.impulses, change.twists);
    change.energy = mass_product(&solve->system, change.twists, change.twists);
    return change;
}

// Add the impulses of the curvature to a solution.
static void bend(Solve *solve, Solution *solution, Twist *velocities) {
    const Island *island = solve->island;
    Arena *arena = solve->arena;
    Pose *halfway = TAKE(arena, Pose, island->body_count);
    Twist *begun = TAKE(arena, Twist, island->body_count);
    for (int body = 0; body < island->body_count; body++) {
        velocities[body] = twist_sum(velocities[body], solution->changes[body], 1.0);
        halfway[body] = moved(solve->poses[body], velocities[body], solve->dt / 2.0);
        begun[body] = body_of(island->engine[body])->twist;
    }
    double *excess = TAKE(arena, double, island->joint_row_count);
    Jacobian *jacobians = TAKE(arena, Jacobian, island->joint_row_count);
    read_rows(island, halfway, excess, jacobians);
    double *before = TAKE(arena, double, island->row_count), *wanted = TAKE(arena, double, island->row_count);
    for (int row = 0; row < island->joint_row_count; row++) {
        Ends ends = island->ends[row];
        double bent = rate(solve->jacobians[row], ends, velocities) - rate(jacobians[row], ends, velocities);
        bool pressed_on = solve->excess[row] * bent < 0.0;
        if (solution->sides[row] == 0 && (is_equality(island->rows[row]) || pressed_on)) {
            before[row] = -rate(solve->jacobians[row], ends, begun);
            wanted[row] = bent;
        }
    }
    Change taken = changed_by(solve, solution, before), given = changed_by(solve, solution, wanted);
    double share = sqrt(paid_share(taken.energy, given.energy));
    for (int row = 0; row < island->row_count; row++) {
        solution->impulses[row] += given.impulses[row] * share;
    }
    for (int body = 0; body < island->body_count; body++) {
        velocities[body] = twist_sum(velocities[body], given.twists[body], share);
    }
}

static void write_impulses(Solve *solve, const Solution *solution) {
    const Island *island = solve->island;
    int normal = island->joint_row_count, tangent = normal + island->touch_count;
    for (int row = 0; row < normal; row++) {
        *island->impulses[row] = solution->impulses[row] / sign_of(island->rows[row], solve->excess[row]);
    }
    for (int number = 0; number < island->touch_count; number++) {
        island->touches[number].point->jnAcc = solution->impulses[normal + number];
        island->touches[number].point->jtAcc = solution->impulses[tangent + number];
    }
}

// A joint of which a row has reached its greatest force does not hold.
static void find_yielded(Solve *solve, const Solution *solution) {
    const Island *island = solve->island;
    for (int row = 0; row < island->joint_row_count; row++) {
        if (fabs(solution->impulses[row]) >= island->rows[row]->most) {
            for (int other = 0; other < island->joint_row_count; other++) {
                if (island->joint_of_row[other] == island->joint_of_row[row]) {
                    solve->holds[other] = false;
                }
            }
        }
    }
}

void solve_velocities(Solve *solve) {
    const Island *island = solve->island;
    size_t mark = arena_mark(solve->arena);
    Twist *velocities = TAKE(solve->arena, Twist, island->body_count);
    double *given = take_back(solve, velocities);
    Impact impact = begin(solve, velocities);
    impact.given = given;
    Solution solution = solve_bounces(solve, &impact);
    bend(solve, &solution, velocities);
    for (int body = 0; body < island->body_count; body++) {
        velocities[body].v = sub(velocities[body].v, solve->velocities[body].v);
        velocities[body].w -= solve->velocities[body].w;
    }
    change_velocities(solve, velocities, 1.0);
    write_impulses(solve, &solution);
    find_yielded(solve, &solution);
    arena_release(solve->arena, mark);
}
