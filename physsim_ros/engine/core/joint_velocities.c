// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Velocities of jointed bodies.
//
// Problem: Chipmunk bounds friction by the normal impulse of its iteration, which is wrong where joints load a
// contact, and a solution of normals and friction in turn lets the floor pull.
// Method: the impulses that Chipmunk gave to the rows of an island are taken back, and joints, normals and friction
// are one problem. In two dimensions the friction cone of a contact has two edges, so that Coulomb friction is two
// rows with λ >= 0 (Anitescu, "Optimization-based simulation of nonsmooth rigid multibody dynamics", Mathematical
// Programming 105, 2006). A contact that slides by v would lift by μ |v|; its target is lowered by that, until v is
// what the solution has (De Saxcé and Feng, "The bipotential method", Mathematical and Computer Modelling 28, 1998).
// Load that statics does not determine stays where it was: each contact is drawn to its impulse of the step before
// (proximal point method: Rockafellar, SIAM Journal on Control and Optimization 14, 1976).
// `docs/decisions/joint_friction.md` has what else was tried.
//
// Energy: without bounces it can only fall; contacts that bounce can make it rise. An island then has the greatest
// share of its bounces with which their impulses do no work.
//
// Curvature: a point on a circle leaves its tangent in half a step, so that rows are solved for
// J v = - dt / 2 (dJ/dt) v, as SHAKE has it (Ryckaert, Ciccotti and Berendsen, J. Comput. Phys. 23, 1977); without that
// a pendulum loses (w dt)² / 2 of its energy in a step. An island gets no more energy by this than its rows take from
// the velocities with which the step began: those of a point that follows its circle are half a step behind it, and
// pay for it; those of a taut straight chain, whose rows are singular, get no energy. A limit that holds, as a taut
// rope does, also gets the curvature term if that loads it more.
//
// Springs: those with a damper, and those that are too stiff for the step (`joints/stiffness.py`), are soft rows: the
// impulse of the step is -dt (k x + c v), x the strain before it and v the velocity after it (implicit Euler of the
// damper; Catto, "Soft Constraints", GDC 2011), with all loads and joints that act.
// Cost: that of `joint_solver.c`.

#include "contact.h"
#include "island_solve.h"
#include "mixed_lcp.h"
#include "stages.h"
#include <string.h>

// E, as a share of `softness_unit`. Of joints it keeps the impulses of those that contradict each other from being of
// any size. Of contacts it draws λ to that of the step before; a belt of 75 links is solved with a third of the
// factorisations that 1e-4 needs.
static const double joint_softness = 1e-6, contact_softness = 1e-2;
// Refinements of a solution against E where contacts are soft. The curvature brings one more.
enum { REFINEMENTS = 2 };
// Solutions whose targets follow the slips, at most.
enum { PASSES = 8 };
// Share of the normal impulse below which an impulse along an edge is rounding.
static const double rounding_of_edges = 1e-9;
// Slips that are solved as rest: contacts lift by less than μ times that [m/s]. Light links of a loaded rope tremble
// by some 0.1 mm/s.
static const double least_slip = 1e-3;
// Difference of slips that needs no further solution, in m/s and as a share of the slip.
static const double slip_error = 1e-4, slip_share = 1e-3;
// Share of its rate that a damper takes in a step, at least: the row of a spring without one is soft by this, and
// swings on for a million seconds.
static const double least_damping = 1e-9;

// The rows of an island in velocities: those of joints, then the two edges of the friction cone of each contact. The
// impulse along an edge, λ >= 0, is one along the normal and μ times as much across it, to one side or the other.
typedef struct VelocityRows {
    Problem problem;
    Jacobian *jacobians;            // (link_count)
    double *wanted, *lower, *upper; // of the problem
    double *rates;                  // (row_count): J v without impulses
    double *last;                   // (row_count): λ of the step before
    double *bounce;                 // (bearing_count): least velocity along the normal that Chipmunk seeks [m/s]
    double *free_slips;             // (bearing_count): velocity across the normal without impulses [m/s]
    double *slips;                  // (bearing_count): greatness of the same after the step
} VelocityRows;

static double damping_of(const Solve *solve, int row) {
    double unit = row_softness_unit(&solve->system, solve->jacobians, row);
    return greatest(solve->island->rows[row]->damping, least_damping / (solve->dt * unit));
}

static double softness_of(const Solve *solve, int row) {
    const Row *of_joint = solve->island->rows[row];
    if (of_joint->law != LAW_SPRING) {
        return joint_softness;
    }
    double unit = row_softness_unit(&solve->system, solve->jacobians, row);
    return 1.0 / (solve->dt * damping_of(solve, row) * unit);
}

// The impulses along the two edges of a cone, by those along and across its normal.
typedef struct Edges {
    double left, right;
} Edges;

static Edges edges_of(double friction, double normal, double tangent) {
    double across = friction > 0.0 ? tangent / friction : normal;
    // Rounding leaves no impulse on the edge that a contact does not slide along.
    double least_edge = rounding_of_edges * normal, left = (normal + across) / 2.0, right = (normal - across) / 2.0;
    return (Edges){left > least_edge ? left : 0.0, right > least_edge ? right : 0.0};
}

static Jacobian edge_jacobian(Jacobian normal, Jacobian tangent, double share) {
    return (Jacobian){twist_plus(normal.a, tangent.a, share), twist_plus(normal.b, tangent.b, share)};
}

// Velocities without the impulses that Chipmunk gave to the rows.
static void take_back(const Solve *solve, Twist *without) {
    const Island *island = solve->island;
    for (int row = 0; row < island->joint_row_count; row++) {
        double impulse = *island->impulses[row] * factor_of(island->rows[row], solve->excess[row]);
        add_row_momenta(&solve->system, solve->jacobians, row, -impulse, without);
    }
    for (int number = 0; number < island->bearing_count; number++) {
        const cpContact *point = island->bearings[number].point;
        Ends ends = island->ends[normal_row(island, number)];
        add_momenta(solve->jacobians[normal_row(island, number)], ends, -point->jnAcc, without);
        add_momenta(solve->jacobians[tangent_row(island, number)], ends, -point->jtAcc, without);
    }
    for (int body = 0; body < island->body_count; body++) {
        Inverse inverse = island->inverses[body];
        without[body].v = add(solve->velocities[body].v, scaled(without[body].v, inverse.mass));
        without[body].w = solve->velocities[body].w + without[body].w * inverse.moment;
    }
}

// λ of the step before.
static double *last_impulses(const Solve *solve) {
    const Island *island = solve->island;
    double *last = TAKE(solve->arena, double, island->row_count);
    for (int row = 0; row < island->joint_row_count; row++) {
        last[row] = island->last[row] * factor_of(island->rows[row], solve->excess[row]);
    }
    for (int number = 0; number < island->bearing_count; number++) {
        double along = island->last[normal_row(island, number)], across = island->last[tangent_row(island, number)];
        Edges edges = edges_of(island->bearings[number].friction, along, across);
        last[normal_row(island, number)] = edges.left;
        last[tangent_row(island, number)] = edges.right;
    }
    return last;
}

static void begin_joints(const Solve *solve, VelocityRows *rows, double *soft) {
    const Island *island = solve->island;
    memcpy(rows->jacobians, solve->jacobians, (size_t)solve->system.link_count * sizeof(Jacobian));
    for (int row = 0; row < island->joint_row_count; row++) {
        const Row *of_joint = island->rows[row];
        rows->lower[row] = greatest(lower_bound(of_joint, true, solve->excess[row]), -of_joint->most);
        rows->upper[row] = least(upper_bound(of_joint, true, solve->excess[row]), of_joint->most);
        soft[row] = softness_of(solve, row);
    }
}

// The rows of contacts. A slip begins as that of the step before, less what friction can stop: where rest is possible,
// it is found.
static void begin_contacts(const Solve *solve, VelocityRows *rows, double *soft, double *prior, const Twist *without) {
    const Island *island = solve->island;
    for (int number = 0; number < island->bearing_count; number++) {
        const Bearing *bearing = island->bearings + number;
        int left = normal_row(island, number), right = tangent_row(island, number);
        Ends ends = island->ends[left];
        Jacobian along = solve->jacobians[left], across = solve->jacobians[right];
        rows->jacobians[left] = edge_jacobian(along, across, bearing->friction);
        rows->jacobians[right] = edge_jacobian(along, across, -bearing->friction);
        rows->upper[left] = is_deferred(bearing->point) ? 0.0 : INFINITY;
        rows->upper[right] = bearing->friction > 0.0 ? rows->upper[left] : 0.0;
        soft[left] = soft[right] = contact_softness;
        prior[left] = rows->last[left];
        prior[right] = rows->last[right];
        rows->free_slips[number] = link_rate(across, ends, without) + bearing->slide;
        Twist begun[] = {body_of(island->engine[ends.a])->scratch.twist,
                         body_of(island->engine[ends.b])->scratch.twist};
        // Restitution is of approaches. Chipmunk permits bodies that part to approach by e times that velocity, so that
        // an elastic contact under a load trembles.
        rows->bounce[number] = greatest(-bearing->point->bounce, 0.0);
        double unit = softness_unit(across, island->inverses[ends.a], island->inverses[ends.b]);
        double stopped = unit * bearing->friction * (prior[left] + prior[right]);
        rows->slips[number] = greatest(fabs(link_rate(across, (Ends){0, 1}, begun) + bearing->slide) - stopped, 0.0);
    }
}

static VelocityRows velocity_rows(Solve *solve, const Twist *without) {
    const Island *island = solve->island;
    Arena *arena = solve->arena;
    VelocityRows rows = {.jacobians = TAKE(arena, Jacobian, solve->system.link_count),
                         .wanted = TAKE(arena, double, island->row_count),
                         .lower = TAKE(arena, double, island->row_count),
                         .upper = TAKE(arena, double, island->row_count),
                         .rates = TAKE(arena, double, island->row_count),
                         .last = last_impulses(solve),
                         .bounce = TAKE(arena, double, island->bearing_count),
                         .free_slips = TAKE(arena, double, island->bearing_count),
                         .slips = TAKE(arena, double, island->bearing_count)};
    double *soft = TAKE(arena, double, island->row_count), *prior = TAKE(arena, double, island->row_count);
    begin_joints(solve, &rows, soft);
    begin_contacts(solve, &rows, soft, prior, without);
    for (int row = 0; row < island->row_count; row++) {
        rows.rates[row] = row_rate(&solve->system, rows.jacobians, row, without);
    }
    rows.problem = (Problem){rows.jacobians, rows.wanted, rows.lower, rows.upper, soft, prior, solve->springs};
    return rows;
}

// Aim at the targets of joints, and at those of contacts that slide by `slips`.
static void set_targets(const Solve *solve, VelocityRows *rows, const double *bounce) {
    const Island *island = solve->island;
    for (int row = 0; row < island->joint_row_count; row++) {
        const Row *of_joint = island->rows[row];
        double pull = solve->springs[row] ? of_joint->stiffness * solve->excess[row] / damping_of(solve, row) : 0.0;
        rows->wanted[row] = bound_rate(of_joint) - pull - rows->rates[row];
    }
    for (int number = 0; number < island->bearing_count; number++) {
        const Bearing *bearing = island->bearings + number;
        double least_rate = bounce[number] - bearing->friction * rows->slips[number];
        double slide = bearing->friction * bearing->slide;
        rows->wanted[normal_row(island, number)] = least_rate - slide - rows->rates[normal_row(island, number)];
        rows->wanted[tangent_row(island, number)] = least_rate + slide - rows->rates[tangent_row(island, number)];
    }
}

// Take slips from a solution; return whether targets change by it.
static bool update_slips(const Solve *solve, VelocityRows *rows, const Solution *solution) {
    const Island *island = solve->island;
    bool changed = false;
    for (int number = 0; number < island->bearing_count; number++) {
        Ends ends = island->ends[tangent_row(island, number)];
        double change = link_rate(solve->jacobians[tangent_row(island, number)], ends, solution->changes);
        double slip = fabs(rows->free_slips[number] + change);
        slip = slip < least_slip ? 0.0 : slip;
        changed = changed || fabs(slip - rows->slips[number]) > slip_error + slip_share * slip;
        rows->slips[number] = slip;
    }
    return changed;
}

// Guess the sides of rows: of joints by λ of the step before, of contacts by the impulses that Chipmunk found, since
// a body that rattles on a machine touches it in every other step.
static void guess_sides(const Solve *solve, const VelocityRows *rows, int8_t *sides) {
    const Island *island = solve->island;
    for (int row = 0; row < island->joint_row_count; row++) {
        sides[row] = side_by_guess(rows->last[row], rows->lower[row], rows->upper[row]);
    }
    for (int number = 0; number < island->bearing_count; number++) {
        const Bearing *bearing = island->bearings + number;
        int left = normal_row(island, number), right = tangent_row(island, number);
        Edges edges = edges_of(bearing->friction, bearing->point->jnAcc, bearing->point->jtAcc);
        sides[left] = side_by_guess(edges.left, rows->lower[left], rows->upper[left]);
        sides[right] = side_by_guess(edges.right, rows->lower[right], rows->upper[right]);
    }
}

// Return the solution with some least velocities along the normals of contacts [m/s].
static Solution solve_with_bounce(Solve *solve, VelocityRows *rows, const double *bounce) {
    Solution solution = solution_for(&solve->system, solve->arena);
    guess_sides(solve, rows, solution.sides);
    set_targets(solve, rows, bounce);
    solve_problem(&solve->system, &rows->problem, &solution, solve->arena);
    for (int pass = 1; pass < PASSES && update_slips(solve, rows, &solution); pass++) {
        set_targets(solve, rows, bounce);
        solve_again(&solve->system, &rows->problem, &solution, solve->arena);
    }
    for (int number = 0; number < (solve->island->bearing_count > 0 ? REFINEMENTS : 0); number++) {
        refine(&solve->system, &rows->problem, &solution, solve->arena);
    }
    return solution;
}

// The work of the impulses of a solution [J].
//
// Velocities are relative to the surfaces that touch: the work that a kinematic body, a conveyor does is not counted.
// Chipmunk measures the approach before gravity and springs act on it, so that it may have been as fast as `bounce`.
static double work_of(const Solve *solve, const VelocityRows *rows, const Solution *solution) {
    const Island *island = solve->island;
    double work = 0.0;
    for (int row = 0; row < island->joint_row_count; row++) {
        double before = rows->rates[row];
        double after = before + row_rate(&solve->system, solve->jacobians, row, solution->changes);
        // A spring gives back what it has taken, and a drive gives energy.
        bool bounds = island->rows[row]->law == LAW_BOUNDS;
        work += bounds ? solution->impulses[row] * (before + after) / 2.0 : 0.0;
    }
    for (int number = 0; number < island->bearing_count; number++) {
        int left = normal_row(island, number), right = tangent_row(island, number);
        double friction = island->bearings[number].friction;
        double along = solution->impulses[left] + solution->impulses[right];
        double across = friction * (solution->impulses[left] - solution->impulses[right]);
        double before = (rows->rates[left] + rows->rates[right]) / 2.0;
        double after = before + link_rate(solve->jacobians[left], island->ends[left], solution->changes);
        double slip = rows->free_slips[number];
        double slip_after = slip + link_rate(solve->jacobians[right], island->ends[right], solution->changes);
        before = rows->bounce[number] > 0.0 ? least(before, -rows->bounce[number]) : before;
        work += along * (before + after) / 2.0 + across * (slip + slip_after) / 2.0;
    }
    return work;
}

// Mix two solutions, with and without bounces, so that the impulses do no work; it meets the bounds of both, which are
// convex. Work is a quadratic function of the share: bend share² + slope share + lost. Targets become what it reaches.
static void mix(const Solve *solve, VelocityRows *rows, Solution *elastic, const Solution *plastic, double gained,
                double lost) {
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
    for (int row = island->joint_row_count; row < island->row_count; row++) {
        double reached = row_rate(&solve->system, rows->jacobians, row, elastic->changes);
        rows->wanted[row] = elastic->impulses[row] > 0.0 ? reached : rows->wanted[row];
    }
}

// Whether a contact is an impact after which its bodies part.
static bool bounces_off(const Island *island, const VelocityRows *rows, int number) {
    return island->bearings[number].remaining > 0.0 && rows->bounce[number] > 0.0;
}

// Whether a row is driven by a force that has a bound.
static bool is_bounded_drive(const Row *row) {
    return is_of_rate(row) && row->most < INFINITY;
}

// Whether there are both impacts and bounded drives.
static bool is_driven_in_impact(const Island *island, const VelocityRows *rows) {
    bool bounces = false, driven = false;
    for (int number = 0; number < island->bearing_count; number++) {
        bounces = bounces || bounces_off(island, rows, number);
    }
    for (int row = 0; row < island->joint_row_count; row++) {
        driven = driven || is_bounded_drive(island->rows[row]);
    }
    return bounces && driven;
}

// A copy of the rows, whose bounds and slips may be changed.
static VelocityRows copy_of(const Solve *solve, const VelocityRows *rows) {
    const Island *island = solve->island;
    VelocityRows copy = *rows;
    copy.slips = TAKE(solve->arena, double, island->bearing_count);
    copy.lower = TAKE(solve->arena, double, island->row_count);
    copy.upper = TAKE(solve->arena, double, island->row_count);
    memcpy(copy.slips, rows->slips, (size_t)island->bearing_count * sizeof(double));
    memcpy(copy.lower, rows->lower, (size_t)island->row_count * sizeof(double));
    memcpy(copy.upper, rows->upper, (size_t)island->row_count * sizeof(double));
    copy.problem.lower = copy.lower;
    copy.problem.upper = copy.upper;
    return copy;
}

// Have motors press bodies on each other for the rest of the step after an impact, as weights do (`rest_of_step.c`).
//
// A bounded force does nothing in the instant of an impact; from then on it acts on the velocities after that. The
// parting velocity changes by the difference of two solutions: of the impact without motors, and of motors with its
// impulses. A light finger that a motor presses on a body would bounce without end.
static void press_on(Solve *solve, VelocityRows *rows) {
    const Island *island = solve->island;
    if (!is_driven_in_impact(island, rows)) {
        return;
    }
    VelocityRows hit = copy_of(solve, rows), after = copy_of(solve, rows);
    for (int row = 0; row < island->joint_row_count; row++) {
        if (is_bounded_drive(island->rows[row])) {
            hit.lower[row] = hit.upper[row] = 0.0;
        }
    }
    Solution impact = solve_with_bounce(solve, &hit, rows->bounce);
    for (int number = 0; number < island->bearing_count; number++) {
        if (bounces_off(island, rows, number)) {
            int left = normal_row(island, number), right = tangent_row(island, number);
            after.lower[left] = after.upper[left] = impact.impulses[left];
            after.lower[right] = after.upper[right] = impact.impulses[right];
        }
    }
    Solution pressed = solve_with_bounce(solve, &after, rows->bounce);
    for (int number = 0; number < island->bearing_count; number++) {
        if (bounces_off(island, rows, number)) {
            Jacobian jacobian = solve->jacobians[normal_row(island, number)];
            Ends ends = island->ends[normal_row(island, number)];
            double gained = link_rate(jacobian, ends, pressed.changes) - link_rate(jacobian, ends, impact.changes);
            double share = island->bearings[number].remaining / solve->dt + 0.5;
            rows->bounce[number] = greatest(rows->bounce[number] + gained * share, 0.0);
        }
    }
}

// Return the solution with bounces, less the share of them that would create energy.
static Solution solve_bounces(Solve *solve, VelocityRows *rows) {
    press_on(solve, rows);
    Solution solution = solve_with_bounce(solve, rows, rows->bounce);
    bool bounces = false;
    double *none = TAKE(solve->arena, double, solve->island->bearing_count);
    for (int number = 0; number < solve->island->bearing_count; number++) {
        bounces = bounces || rows->bounce[number] > 0.0;
    }
    double gained = bounces ? work_of(solve, rows, &solution) : 0.0;
    if (gained > 0.0) {
        Solution plastic = solve_with_bounce(solve, rows, none);
        mix(solve, rows, &solution, &plastic, gained, work_of(solve, rows, &plastic));
    }
    return solution;
}

// Return the velocities by which the rates of the rows that hold in a solution change, whose factors the system has.
static Twist *changed_by(Solve *solve, const Solution *solution, const double *rates) {
    Twist *changes = TAKE(solve->arena, Twist, solve->island->body_count);
    double *impulses = TAKE(solve->arena, double, solve->island->row_count);
    solve_active(&solve->system, solution->sides, rates, impulses, changes);
    return changes;
}

// Twice the energy of that [J].
static double energy_of(Solve *solve, const Solution *solution, const double *rates) {
    Twist *changes = changed_by(solve, solution, rates);
    return mass_product(&solve->system, changes, changes);
}

// Add the impulses of the curvature to a solution; λ stay within their bounds.
static void bend(Solve *solve, VelocityRows *rows, Solution *solution, Twist *velocities) {
    const Island *island = solve->island;
    Arena *arena = solve->arena;
    Twist *begun = TAKE(arena, Twist, island->body_count), *straight = TAKE(arena, Twist, island->body_count);
    Pose *halfway = TAKE(arena, Pose, island->body_count);
    for (int body = 0; body < island->body_count; body++) {
        straight[body] = twist_plus(velocities[body], solution->changes[body], 1.0);
        halfway[body] = moved(solve->poses[body], straight[body], solve->dt / 2.0);
        begun[body] = body_of(island->engine[body])->scratch.twist;
    }
    double *excess = TAKE(arena, double, island->joint_row_count);
    Jacobian *jacobians = TAKE(arena, Jacobian, solve->system.link_count);
    read_rows(island, halfway, excess, jacobians);
    double *before = TAKE(arena, double, island->row_count), *bent = TAKE(arena, double, island->row_count);
    for (int row = 0; row < island->joint_row_count; row++) {
        double more = row_rate(&solve->system, solve->jacobians, row, straight) -
                      row_rate(&solve->system, jacobians, row, straight);
        bool pressed_on = !is_of_rate(island->rows[row]) && solve->excess[row] * more < 0.0;
        if (solution->sides[row] == 0 && (is_equality(island->rows[row]) || pressed_on)) {
            before[row] = bound_rate(island->rows[row]) - row_rate(&solve->system, solve->jacobians, row, begun);
            bent[row] = more;
        }
    }
    double taken = energy_of(solve, solution, before), given = energy_of(solve, solution, bent);
    double share = sqrt(paid_share(taken, given));
    for (int row = 0; row < island->joint_row_count; row++) {
        rows->wanted[row] += bent[row] * share;
    }
    refine(&solve->system, &rows->problem, solution, arena);
    for (int body = 0; body < island->body_count; body++) {
        velocities[body] = twist_plus(velocities[body], solution->changes[body], 1.0);
    }
}

// Find the displacements in the rest of the step since impacts (`rest_of_step.c`). The rows of an impact get the
// difference of velocities that their bodies have by it; what holds beside them holds on these displacements, too.
static void find_rest_of_step(Solve *solve, const VelocityRows *rows, const Solution *solution,
                              const Twist *velocities) {
    const Island *island = solve->island;
    double *wanted = TAKE(solve->arena, double, island->row_count);
    bool late = false;
    for (int number = 0; number < island->bearing_count; number++) {
        double remaining = island->bearings[number].remaining;
        Ends ends = island->ends[normal_row(island, number)];
        Twist displacements[] = {
            displacement_gained(body_of(island->engine[ends.a]), velocities[ends.a], remaining, solve->dt),
            displacement_gained(body_of(island->engine[ends.b]), velocities[ends.b], remaining, solve->dt)};
        wanted[normal_row(island, number)] =
            link_rate(rows->jacobians[normal_row(island, number)], (Ends){0, 1}, displacements);
        wanted[tangent_row(island, number)] =
            link_rate(rows->jacobians[tangent_row(island, number)], (Ends){0, 1}, displacements);
        late = late || remaining > 0.0;
    }
    if (late) {
        Twist *gained = changed_by(solve, solution, wanted);
        for (int number = 0; number < island->body_count; number++) {
            set_remaining_move(body_of(island->engine[number]), gained[number]);
        }
    }
}

static void write_impulses(Solve *solve, const Solution *solution) {
    const Island *island = solve->island;
    for (int row = 0; row < island->joint_row_count; row++) {
        *island->impulses[row] = solution->impulses[row] / factor_of(island->rows[row], solve->excess[row]);
    }
    for (int number = 0; number < island->bearing_count; number++) {
        double left = solution->impulses[normal_row(island, number)],
               right = solution->impulses[tangent_row(island, number)];
        island->bearings[number].point->jnAcc = left + right;
        island->bearings[number].point->jtAcc = island->bearings[number].friction * (left - right);
    }
}

// A joint of which a row has reached its greatest force does not hold; one that drives or springs holds all the same.
static void find_yielded(Solve *solve, const Solution *solution) {
    const Island *island = solve->island;
    int last = 0;
    for (int first = 0; first < island->joint_row_count; first = last) {
        bool yields = false;
        // Rows of a joint follow one another.
        for (; last < island->joint_row_count && island->joint_of_row[last] == island->joint_of_row[first]; last++) {
            const Row *row = island->rows[last];
            yields = yields || (row->law == LAW_BOUNDS && fabs(solution->impulses[last]) >= row->most);
        }
        for (int row = first; row < last && yields; row++) {
            solve->holds[row] = false;
        }
    }
}

void solve_velocities(Solve *solve) {
    const Island *island = solve->island;
    size_t mark = arena_mark(solve->arena);
    Twist *velocities = TAKE(solve->arena, Twist, island->body_count);
    take_back(solve, velocities);
    VelocityRows rows = velocity_rows(solve, velocities);
    Solution solution = solve_bounces(solve, &rows);
    bend(solve, &rows, &solution, velocities);
    find_rest_of_step(solve, &rows, &solution, velocities);
    for (int body = 0; body < island->body_count; body++) {
        velocities[body].v = sub(velocities[body].v, solve->velocities[body].v);
        velocities[body].w -= solve->velocities[body].w;
    }
    change_velocities(solve, velocities, 1.0);
    write_impulses(solve, &solution);
    find_yielded(solve, &solution);
    arena_release(solve->arena, mark);
}
