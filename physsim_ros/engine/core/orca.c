// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Optimal reciprocal collision avoidance (ORCA).
//
// Problem: pedestrians must not collide, though each knows only the positions and velocities of the others.
// Method: J. van den Berg, S. J. Guy, M. Lin and D. Manocha, "Reciprocal n-body collision avoidance" (Robotics
// Research, 2011). For each other disc there is a half-plane of velocities that avoids a collision within τ if both
// move half of the way out of the velocity obstacle; who does not avoid others leaves the whole way to the pedestrian.
// Of the velocities in all half-planes and within the greatest speed it takes the one next to its desired velocity, by
// incremental linear programming in the plane (ibid., section 5; de Berg et al., "Computational Geometry", chapter 4);
// in a crowd where there is none, that which violates the worst half-plane least. A wall's half-plane bounds the
// velocity towards its nearest point by the distance over its horizon (velocity damper; B. Faverjon and P. Tournassoud,
// "A local based approach for path planning of manipulators with a high number of degrees of freedom", 1987): always
// kept. So is one of each near disc, as the least wrong velocity of a crowd would run into it.
//
// Cost: 30 ns a pair, and 0.1 µs a wall.

#include "orca.h"

// Time in which overlaps are undone [s].
static const double parting_time = 0.1;
// Normals of half-planes that differ by less are parallel.
static const double parallel = 1e-9;
// A pedestrian whom others keep from its velocity tries the desired one turned to the right by the first of these
// [rad], and by up to the second the less it would get on, where the authors' own programs add noise: without it two
// who meet head on stop before each other, and many who cross a circle in its middle. Of radius 0.25 m, 30 who change
// sides in a circle of 8 m are across in 13 s, and 20 in one of 4 m in 6.5 s; if the turn is always 0.3, these jam.
static const double swerve = 0.3, most_swerve = 1.5;

// A linear programme: half-planes in a disc of velocities.
typedef struct Programme {
    const HalfPlane *planes;
    int count;
    double speed; // radius of the disc [m/s]
} Programme;

// Find the part of the border of a half-plane that lies in the disc and in all half-planes before it: the points c n +
// s d with s in [low, high], where d is n turned by a quarter. Return false if there is none.
static bool border(const Programme *given, int number, double *low, double *high) {
    HalfPlane own = given->planes[number];
    double square = given->speed * given->speed - own.c * own.c;
    if (square < 0.0) {
        return false;
    }
    Vec along = perpendicular(own.n), point = scaled(own.n, own.c);
    *high = sqrt(square);
    *low = -*high;
    for (int before = 0; before < number; before++) {
        HalfPlane other = given->planes[before];
        double slope = dot(other.n, along), lack = other.c - dot(other.n, point);
        if (fabs(slope) < parallel) {
            if (lack > 0.0) {
                return false;
            }
        } else if (slope > 0.0) {
            *low = greatest(*low, lack / slope);
        } else {
            *high = least(*high, lack / slope);
        }
    }
    return *low <= *high;
}

// Find the velocity next to a desired one, or if `far` the farthest in its direction. Return the count of half-planes
// that it keeps, from the first.
static int solve_programme(const Programme *given, Vec desired, bool far, Vec *velocity) {
    double size = length(desired);
    bool shortens = far || size > given->speed;
    *velocity = shortens ? scaled(desired, given->speed / greatest(size, 1e-300)) : desired;
    for (int number = 0; number < given->count; number++) {
        HalfPlane own = given->planes[number];
        if (dot(own.n, *velocity) >= own.c) {
            continue;
        }
        double low, high;
        if (!border(given, number, &low, &high)) {
            return number;
        }
        Vec along = perpendicular(own.n);
        double s = dot(desired, along);
        s = far ? (s > 0.0 ? high : low) : clamped(s, low, high);
        *velocity = add(scaled(own.n, own.c), scaled(along, s));
    }
    return given->count;
}

// Where there is no such velocity, find that which violates the worst half-plane least: of those that may be violated,
// which begin at `fixed`, each in turn that is worse than the worst until now.
static void relax(const Programme *given, int fixed, int failed, HalfPlane *memory, Vec *velocity) {
    double worst = 0.0;
    for (int number = failed; number < given->count; number++) {
        HalfPlane own = given->planes[number];
        if (own.c - dot(own.n, *velocity) <= worst) {
            continue;
        }
        Programme relaxed = {memory, 0, given->speed};
        for (int before = 0; before < number; before++) {
            HalfPlane other = given->planes[before];
            // Where the other one is violated no more than this one.
            Vec n = before < fixed ? other.n : sub(other.n, own.n);
            double c = before < fixed ? other.c : other.c - own.c, size = length(n);
            if (size > parallel) {
                memory[relaxed.count++] = (HalfPlane){scaled(n, 1.0 / size), c / size};
            }
        }
        Vec found;
        if (solve_programme(&relaxed, own.n, true, &found) == relaxed.count) {
            *velocity = found;
        }
        worst = greatest(own.c - dot(own.n, *velocity), worst);
    }
}

// The half-plane of another disc.
static HalfPlane avoiding(const Disc *self, const Disc *other, double horizon) {
    Vec apart = sub(other->point, self->point), relative = sub(self->velocity, other->velocity);
    double radius = self->radius + other->radius, square = dot(apart, apart);
    double share = other->walks ? 0.5 : 1.0;
    Vec n, change;
    double time = square > radius * radius ? horizon : parting_time;
    // From the centre of the disc that cuts the velocity obstacle off.
    Vec from = sub(relative, scaled(apart, 1.0 / time));
    double size = length(from), ahead = dot(from, apart);
    if (square <= radius * radius || (ahead < 0.0 && ahead * ahead > radius * radius * size * size)) {
        n = unit_or(from, vec(1.0, 0.0));
        change = scaled(n, radius / time - size);
    } else {
        // The tangent from the origin to the disc of the other one, on the side of the relative velocity.
        double leg = sqrt(square - radius * radius), side = cross(apart, from) > 0.0 ? 1.0 : -1.0;
        Vec along = scaled(add(scaled(apart, leg), scaled(perpendicular(apart), side * radius)), 1.0 / square);
        n = scaled(perpendicular(along), side);
        change = scaled(n, -dot(relative, n));
    }
    return (HalfPlane){n, dot(n, add(self->velocity, scaled(change, share)))};
}

// The velocity damper of a disc. Two pedestrians share the room between them, so that they do not touch even where
// neither can give way; standing is always allowed.
static HalfPlane damper_of(const Disc *self, const Disc *other) {
    Vec apart = sub(other->point, self->point);
    double room = length(apart) - self->radius - other->radius;
    Vec towards = unit_or(apart, vec(1.0, 0.0));
    double share = other->walks ? 0.5 : 1.0, retreat = greatest(dot(other->velocity, towards), 0.0);
    return (HalfPlane){negated(towards), -(retreat + share * greatest(room, 0.0) / parting_time)};
}

static bool sees_disc(const Disc *self, const Disc *other) {
    double seen = farthest_seen + self->radius + other->radius;
    return !passes_through(self->body, other->body) && length(sub(other->point, self->point)) < seen;
}

Vec walk_by_orca(const World *world, const Surroundings *around, const Actor *actor, const Disc *self, Vec desired) {
    const Orca *model = &actor->orca;
    HalfPlane *planes = around->planes[0], *memory = around->planes[1];
    Programme programme = {planes, 0, actor->pace.max_speed};
    for (int number = 0; number < around->wall_count; number++) {
        const cpShape *wall = around->walls[number];
        Nearest nearest;
        if (sees_wall(world, wall, self->body, self->point, &nearest)) {
            double room = nearest.distance - self->radius, time = room > 0.0 ? model->wall_horizon : parting_time;
            planes[programme.count++] = (HalfPlane){nearest.outwards, -room / time};
        }
    }
    // The velocity without others: its direction leads around walls already (`way_around.c`).
    Vec along;
    solve_programme(&programme, desired, false, &along);
    for (int number = 0; number < around->disc_count; number++) {
        const Disc *other = around->discs + number;
        if (sees_disc(self, other)) {
            HalfPlane plane = damper_of(self, other);
            if (plane.c > -programme.speed) {
                planes[programme.count++] = plane;
            }
        }
    }
    int fixed = programme.count;
    assert(fixed <= around->disc_count + around->wall_count);
    for (int number = 0; number < around->disc_count; number++) {
        if (sees_disc(self, around->discs + number)) {
            planes[programme.count++] = avoiding(self, around->discs + number, model->horizon);
        }
    }
    Vec velocity;
    int kept = solve_programme(&programme, desired, false, &velocity);
    if (velocity.x != along.x || velocity.y != along.y) {
        double wanted = dot(along, along);
        double progress = wanted > 0.0 ? clamped(dot(velocity, along) / wanted, 0.0, 1.0) : 1.0;
        double turn = most_swerve + (swerve - most_swerve) * progress;
        kept = solve_programme(&programme, rotated(desired, rotation(-turn)), false, &velocity);
    }
    if (kept < programme.count) {
        relax(&programme, fixed, kept, memory, &velocity);
    }
    return velocity;
}
