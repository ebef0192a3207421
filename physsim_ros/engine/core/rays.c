// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Rays: how far lasers and range finders see.
//
// Problem: the nearest of all edges and discs along each of many rays from one point.
// Method: angular intervals. As seen from a point outside, an edge or a disc covers an interval of angles, and only the
// rays in it are intersected with it, so that the cost is that of pairs that meet. Angles are compared as diamond
// angles, a monotone function of the angle without transcendental functions: the distance from the x axis along the
// square with its corners on the axes, -2 .. 2.
// Cost: some 20 ns for each edge in reach, and 3 ns for each ray that meets it.

#include "arena.h"
#include "vector.h"
#include <stdbool.h>

// An origin that is outside an edge by less lies on it, and a ray grazes an edge that it comes closer to [m]: a
// thousandth of the distance at which two points of a shape are one.
static const double graze = 1e-9;
// As diamond angles.
static const double half_diamond = 2.0, whole_diamond = 4.0;

// Rays from one point, counter-clockwise within a turn.
typedef struct Fan {
    Vec origin;
    double reach; // greatest distance at which something is looked for [m]
    int count;
    const Vec *directions; // unit vectors
    double *angles;        // of them, from the first ray on, 0 .. 4
    double *distances;     // to the nearest until now [m]
} Fan;

// The rays of an interval of angles: the first of them, and how many follow it, past the last ray too.
typedef struct Range {
    int first, count;
} Range;

static double diamond_angle(Vec a) {
    return copysign(1.0 - a.x / (fabs(a.x) + fabs(a.y)), a.y);
}

static double angle_since_first(const Fan *fan, Vec a) {
    double since = diamond_angle(a) - diamond_angle(fan->directions[0]);
    return since < 0.0 ? since + whole_diamond : since;
}

// Return how many rays are before an angle; `inclusive` counts those at it.
static int rays_before(const Fan *fan, double angle, bool inclusive) {
    int low = 0, high = fan->count;
    while (low < high) {
        int middle = (low + high) / 2;
        if (fan->angles[middle] < angle || (inclusive && fan->angles[middle] == angle)) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

// Return the rays in the interval from one vector counter-clockwise to another, less than half a turn, ends included.
static Range rays_between(const Fan *fan, Vec from, Vec to) {
    double low = angle_since_first(fan, from), high = angle_since_first(fan, to);
    int first = rays_before(fan, low, false), count = rays_before(fan, high, true) - first;
    if (low - high > half_diamond) {
        count += fan->count; // it passes the first ray
    }
    // An interval that rounding has turned round is empty.
    return (Range){first, count > 0 ? count : 0};
}

static void intersect(Fan *fan, int ray, double distance) {
    fan->distances[ray] = least(fan->distances[ray], distance);
}

static void intersect_edge(Fan *fan, Vec begin, Vec end, Vec normal, double height) {
    // As seen from outside, an edge runs clockwise.
    Range range = rays_between(fan, end, begin);
    for (int place = range.first; place < range.first + range.count; place++) {
        int ray = place % fan->count;
        double across = dot(fan->directions[ray], normal);
        if (across < 0.0) {
            intersect(fan, ray, -height / across);
        }
    }
}

// Meet the edges of a polygon that face the origin; return whether the origin is outside it.
static bool intersect_polygon(Fan *fan, const Piece *piece, const Edge *edges, Pose pose) {
    Rotation turn = rotation(pose.yaw);
    Vec away = sub(pose.p, fan->origin);
    bool outside = false;
    for (int number = 0; number < piece->edge_count; number++) {
        const Edge *edge = &edges[piece->first_edge + number];
        Vec begin = add(rotated(edge->begin, turn), away), normal = rotated(edge->normal, turn);
        double height = -dot(begin, normal);
        if (height > graze) {
            outside = true;
            if (height <= fan->reach) {
                intersect_edge(fan, begin, add(rotated(edge->end, turn), away), normal, height);
            }
        }
    }
    return outside;
}

// Meet a disc around a point seen from the origin; return whether the origin is outside it.
static bool intersect_disc(Fan *fan, Vec center, double radius) {
    double away2 = dot(center, center);
    if (away2 <= (radius + graze) * (radius + graze)) {
        return false;
    }
    double tangent = sqrt(away2 - radius * radius);
    Vec aside = scaled(perpendicular(center), radius), ahead = scaled(center, tangent);
    // From the right tangent to the left one.
    Range range = rays_between(fan, sub(ahead, aside), add(ahead, aside));
    for (int place = range.first; place < range.first + range.count; place++) {
        int ray = place % fan->count;
        double miss = cross(fan->directions[ray], center);
        double half_chord = sqrt(greatest(radius * radius - miss * miss, 0.0));
        intersect(fan, ray, dot(fan->directions[ray], center) - half_chord);
    }
    return true;
}

// Meet a piece if it is in reach; return whether the origin is outside it.
static bool intersect_piece(Fan *fan, const Piece *piece, const Edge *edges, Pose pose) {
    Vec center = sub(add(rotated(piece->center, rotation(pose.yaw)), pose.p), fan->origin);
    double farthest = piece->radius + fan->reach;
    if (dot(center, center) > farthest * farthest) {
        return true;
    }
    return piece->edge_count ? intersect_polygon(fan, piece, edges, pose) : intersect_disc(fan, center, piece->radius);
}

void core_cast_rays(const Piece *pieces, int32_t piece_count, const Edge *edges, const Pose *poses, int32_t own,
                    cpVect origin, double reach, const cpVect *directions, int32_t count, double *distances) {
    Arena arena = {0};
    Fan fan = {origin, reach, count, directions, TAKE(&arena, double, count), distances};
    for (int ray = 0; ray < count; ray++) {
        fan.angles[ray] = angle_since_first(&fan, directions[ray]);
        distances[ray] = INFINITY;
        assert(ray == 0 || fan.angles[ray - 1] <= fan.angles[ray]);
    }
    bool outside = true;
    for (int number = 0; number < piece_count && outside; number++) {
        const Piece *piece = &pieces[number];
        outside = piece->owner == own || intersect_piece(&fan, piece, edges, poses[piece->body]);
    }
    for (int ray = 0; ray < count && !outside; ray++) {
        distances[ray] = 0.0;
    }
    arena_free(&arena);
}
