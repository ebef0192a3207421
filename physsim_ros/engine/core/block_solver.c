// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Block solver: the points in which two bodies hit each other at once are solved together.
//
// Problem: the solver goes from point to point (sequential impulses), normal and friction in turn. Of a box that
// falls flat the first corner takes more than its half of the impact, the second one less, and ten iterations do not
// level that (a hundred would): a box of 0.5 x 1 m that is dropped from 1 m at a restitution of 0.5 tips over.
// Method: the normal impulses λ of the points solve a linear complementarity problem: λ >= 0, and the velocity v + K
// λ after the impact is at least -e times that before it, where K is the inverse effective mass (D. Baraff,
// "Analytical methods for dynamic simulation of non-penetrating rigid bodies", 1989; of two points E. Catto,
// `b2ContactSolver::SolveVelocityConstraints` in Box2D 2.4, "block solver"). Chipmunk's own solver begins with these
// impulses. Friction and what it changes of the normal impulses are found by rounds of sequential impulses over the
// same points, as Chipmunk makes them.
// Scope: that of `impact_clusters.c`.
// Energy: Newton's law of restitution can create energy, with several points at once as where a light body is
// pinched between a heavy one and the ground, with one where friction turns the slip round (T. R. Kane and D. A.
// Levinson, "Dynamics: Theory and Applications", 1985). Such an impact has the greatest share of its restitution
// with which it gains none.
// Cost: 1 µs for each pair of bodies that hit each other.
// Without it laws 8 (bodies that fall flat) and 21 (elastic polygons keep their energy) fail; without its bound of
// energy laws 6 (oblique impacts) and 34 (random crowds).

#include "contact.h"
#include "impact_clusters.h"
#include "stages.h"
#include "touch.h"

// Most rounds of sequential impulses over the points of an impact.
enum { SEQUENTIAL_ROUNDS = 200 };
// Change of velocity below which a round is the last one [m/s].
static const double settled = 1e-12;

// Energy of an impact below which it is rounding, as a share of what its impulses exchange.
static const double rounding_of_gain = 1e-9;
// Guesses at the share of its restitution with which an impact gains no energy, at most, and how well it is found.
enum { GUESSES = 24 };
static const double share_error = 1e-9;

// A point of a cluster, as it is solved.
typedef struct Point {
    cpContact *contact;
    cpBody *a, *b;
    Twist *of_a, *of_b; // velocities of the bodies after the impulses, which other points of the bodies share
    Vec normal;
    bool begins;
    double friction;
    Vec slip;              // velocity of the surfaces
    double added, added_t; // impulse that an impact next to it has given it in this sub-step [N s]
} Point;

// The velocity of a body at the end of the sub-step without impulses.
static Twist free_twist(const World *world, const cpBody *body) {
    Twist twist = twist_of(body);
    if (is_movable(body)) {
        double kept = world->own->kept, dt = world->dt;
        Vec acceleration = add(world->space->gravity, scaled(body->f, body->m_inv));
        twist =
            (Twist){add(scaled(twist.v, kept), scaled(acceleration, dt)), twist.w * kept + body->t * body->i_inv * dt};
    }
    return twist;
}

// The velocity of the surfaces against each other in a point [m/s]: along the normal, and along the face.
static Vec surface_velocity(const Point *point, Twist a, Twist b) {
    Vec v = add(parting_velocity(point->contact, a, b), point->slip);
    return vec(dot(v, point->normal), dot(v, perpendicular(point->normal)));
}

// The velocity at which the bodies part in a point, without impulses [m/s].
static double parting(const World *world, const Point *point) {
    Twist a = free_twist(world, point->a), b = free_twist(world, point->b);
    return dot(parting_velocity(point->contact, a, b), point->normal);
}

// The change of the velocity in one point by an impulse of 1 in another one, through one body [1/kg].
static double change_through(const cpBody *body, const Point *point, const Point *other) {
    double change = 0.0;
    for (int k = 0; k < 4; k++) {
        bool first = k % 2 == 0, other_first = k < 2;
        if ((first ? point->a : point->b) == body && (other_first ? other->a : other->b) == body) {
            Vec push = first ? negated(point->normal) : point->normal;
            Vec other_push = other_first ? negated(other->normal) : other->normal;
            Vec arm = first ? point->contact->r1 : point->contact->r2;
            Vec other_arm = other_first ? other->contact->r1 : other->contact->r2;
            change += body->m_inv * dot(push, other_push);
            change += body->i_inv * cross(arm, push) * cross(other_arm, other_push);
        }
    }
    return change;
}

static void apply_impulse(const World *world, cpBody *body, Vec impulse, Vec arm) {
    // Chipmunk damps velocities before it solves.
    body->v = add(body->v, scaled(impulse, body->m_inv / world->own->kept));
    body->w += cross(arm, impulse) * body->i_inv / world->own->kept;
}

// The velocities of the bodies of an impact.
typedef struct Velocities {
    const cpBody *bodies[2 * CLUSTER_POINTS];
    Twist twists[2 * CLUSTER_POINTS];
    int count;
} Velocities;

static Twist *velocity_of(Velocities *velocities, const cpBody *body) {
    int number = 0;
    while (number < velocities->count && velocities->bodies[number] != body) {
        number++;
    }
    if (number == velocities->count) {
        assert(number < 2 * CLUSTER_POINTS);
        velocities->bodies[velocities->count++] = body;
    }
    return velocities->twists + number;
}

static void list_points(const Cluster *cluster, Velocities *velocities, Point *points) {
    for (int number = 0; number < cluster->count; number++) {
        cpArbiter *each = cluster->points[number].arbiter;
        cpContact *contact = cluster->points[number].contact;
        bool is_first = begins(each);
        points[number] = (Point){contact,
                                 each->body_a,
                                 each->body_b,
                                 velocity_of(velocities, each->body_a),
                                 velocity_of(velocities, each->body_b),
                                 each->n,
                                 is_first,
                                 each->u,
                                 each->surface_vr,
                                 is_first ? contact->jnAcc : 0.0,
                                 is_first ? contact->jtAcc : 0.0};
    }
}

// Take out the impulses with which points between the outermost ones start; those of contacts that begin are in the
// velocities already.
static void take_out_inner(const Cluster *cluster) {
    for (int number = 0; number < cluster->body_count; number++) {
        const cpBody *body = cluster->bodies[number];
        for (cpArbiter *each = body->arbiterList; each != NULL; each = next_of(each, body)) {
            for (int point = 0; point < each->count && !begins(each); point++) {
                cpContact *contact = each->contacts + point;
                if (!has_point(cluster, contact)) {
                    contact->jnAcc = contact->jtAcc = 0.0;
                }
            }
        }
    }
}

static void push_apart(const Point *point, Vec impulse) {
    Twist *a = point->of_a, *b = point->of_b;
    a->v = sub(a->v, scaled(impulse, point->a->m_inv));
    a->w -= cross(point->contact->r1, impulse) * point->a->i_inv;
    b->v = add(b->v, scaled(impulse, point->b->m_inv));
    b->w += cross(point->contact->r2, impulse) * point->b->i_inv;
}

// Make the impulse of a point better, as `cpArbiterApplyImpulse` does; return the change of velocity [m/s].
static double improve(const Point *point) {
    cpContact *contact = point->contact;
    Vec v = add(parting_velocity(contact, *point->of_a, *point->of_b), point->slip),
        tangent = perpendicular(point->normal);
    double normal = contact->jnAcc, along = contact->jtAcc;
    contact->jnAcc = greatest(normal - (contact->bounce + dot(v, point->normal)) * contact->nMass, 0.0);
    double most = point->friction * contact->jnAcc;
    contact->jtAcc = clamped(along - dot(v, tangent) * contact->tMass, -most, most);
    double dn = contact->jnAcc - normal, dt = contact->jtAcc - along;
    push_apart(point, add(scaled(point->normal, dn), scaled(tangent, dt)));
    return greatest(fabs(dn) / contact->nMass, fabs(dt) / contact->tMass);
}

static Vec impulse_at_point(const Point *point) {
    return vec(point->contact->jnAcc - point->added, point->contact->jtAcc - point->added_t);
}

// Find the impulses of the points, and the velocities of their bodies after them.
static void find_impulses(const World *world, Point *points, int count) {
    double matrix[LCP_ROWS][LCP_ROWS] = {{0}}, rates[LCP_ROWS] = {0}, impulses[LCP_ROWS] = {0};
    for (int row = 0; row < count; row++) {
        const Point *point = points + row;
        rates[row] = parting(world, point) + point->contact->bounce;
        for (int column = 0; column < count; column++) {
            matrix[row][column] = change_through(point->a, point, points + column);
            matrix[row][column] += change_through(point->b, point, points + column);
            rates[row] -= matrix[row][column] * points[column].added;
        }
    }
    bool solved = solve_lcp(count, matrix, rates, impulses);
    for (int row = 0; row < count; row++) {
        Point *point = points + row;
        *point->of_a = free_twist(world, point->a);
        *point->of_b = free_twist(world, point->b);
        if (solved) {
            point->contact->jnAcc = impulses[row];
        }
    }
    for (int row = 0; row < count; row++) {
        const Point *point = points + row;
        Vec impulse = impulse_at_point(point);
        push_apart(point, add(scaled(point->normal, impulse.x), scaled(perpendicular(point->normal), impulse.y)));
    }
    for (int round = 0; round < SEQUENTIAL_ROUNDS; round++) {
        double most = 0.0;
        for (int row = 0; row < count; row++) {
            most = greatest(most, improve(points + row));
        }
        if (most < settled) {
            break;
        }
    }
}

// Velocities of a body just before and just after an impact: those of the end of the sub-step, less what its
// acceleration adds from the impact on, and less the half-step lead while it flies.
static Twist at_impact(const World *world, const Body *body, Twist end, bool flies) {
    double share = 2.0 * (body->own->since + body->own->remaining) / world->dt + (flies ? 1.0 : 0.0);
    return body->dynamic ? twist_plus(end, body->own->lead, -share) : end;
}

static Twist before_impact(const World *world, const cpBody *body) {
    return at_impact(world, body_of(body), free_twist(world, body), body_of(body)->state.free);
}

static Twist after_impact(const World *world, const cpBody *body, Twist end) {
    return at_impact(world, body_of(body), end, body_of(body)->own->bounces);
}

// The energy that the impulses give to the bodies [J]; < 0 is lost. What is gained by rounding counts as nothing.
static double gain_of(const World *world, const Point *points, int count) {
    double gain = 0.0, size = 0.0;
    for (int row = 0; row < count; row++) {
        const Point *point = points + row;
        Vec before = surface_velocity(point, before_impact(world, point->a), before_impact(world, point->b));
        Vec after = surface_velocity(point, after_impact(world, point->a, *point->of_a),
                                     after_impact(world, point->b, *point->of_b));
        gain += dot(impulse_at_point(point), add(before, after)) / 2.0;
        size += length(impulse_at_point(point)) * (length(before) + length(after)) / 2.0;
    }
    return fabs(gain) > rounding_of_gain * size ? gain : 0.0;
}

// Find the impulses with a share of the restitution; return the energy that they give to the bodies [J].
static double gain_with(const World *world, Point *points, int count, const double *bounce, double share) {
    for (int row = 0; row < count; row++) {
        points[row].contact->bounce = share * bounce[row];
    }
    find_impulses(world, points, count);
    return gain_of(world, points, count);
}

// Find the impulses with the greatest share of the restitution that gains no energy: its root by the false position
// (Illinois; Dowell and Jarratt, "A modified regula falsi method for computing the root of an equation", 1971).
static void lose_gain(const World *world, Point *points, int count, double gain) {
    double bounce[CLUSTER_POINTS], low = 0.0, high = 1.0, above = gain;
    for (int row = 0; row < count; row++) {
        bounce[row] = points[row].contact->bounce;
    }
    double below = gain_with(world, points, count, bounce, low);
    int side = 0;
    for (int guess = 0; guess < GUESSES && below < 0.0 && high - low > share_error; guess++) {
        double share = low + (high - low) * below / (below - above);
        double found = gain_with(world, points, count, bounce, share);
        if (found > 0.0) {
            high = share;
            above = found;
            below = side > 0 ? below / 2.0 : below;
            side = 1;
        } else {
            low = share;
            below = found;
            above = side < 0 ? above / 2.0 : above;
            side = -1;
        }
    }
    gain_with(world, points, count, bounce, low);
}

// Set the impulses of a cluster, and add those of contacts that begin to velocities.
static void solve_cluster(const World *world, const Cluster *cluster) {
    Point points[CLUSTER_POINTS];
    Velocities velocities = {.count = 0};
    int count = cluster->count;
    take_out_inner(cluster);
    list_points(cluster, &velocities, points);
    find_impulses(world, points, count);
    double gain = gain_of(world, points, count);
    if (gain > 0.0) {
        lose_gain(world, points, count, gain);
    }
    for (int row = 0; row < count; row++) {
        Point *point = points + row;
        // Chipmunk applies that of other contacts itself (`cpArbiterApplyCachedImpulse`).
        if (point->begins) {
            Vec along = impulse_at_point(point);
            Vec impulse = add(scaled(point->normal, along.x), scaled(perpendicular(point->normal), along.y));
            apply_impulse(world, point->a, negated(impulse), point->contact->r1);
            apply_impulse(world, point->b, impulse, point->contact->r2);
        }
    }
}

void solve_impacts(World *world) {
    if (world->own->kept == 0.0) {
        return;
    }
    Hit *hits = TAKE(&world->own->arena, Hit, arbiter_count(world));
    // By place, and for all that forces do not move: that is never marked.
    bool *solved = TAKE(&world->own->arena, bool, world->body_count + 1);
    int count = list_hits(world, hits), last = 0;
    for (int first = 0; first < count; first = last) {
        for (last = first; last < count && hits[last].a == hits[first].a && hits[last].b == hits[first].b; last++) {
        }
        if (!solved[hits[first].a] && !solved[hits[first].b]) {
            Cluster cluster = cluster_of(hits + first, last - first);
            if (!cluster.too_many) {
                solve_cluster(world, &cluster);
                for (int number = 0; number < cluster.body_count; number++) {
                    solved[place_of(world, cluster.bodies[number])] = true;
                }
            }
        }
    }
}
