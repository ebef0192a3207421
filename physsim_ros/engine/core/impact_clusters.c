// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Impact clusters: which points of contacts an impact is solved in together.
//
// Problem: a body that hits another one loads all that the two touch; a part of a pile that is solved by itself throws
// its light bodies out.
// Method: two bodies that hit each other, or one that hits what forces do not move, in any number of points, with all
// contacts of these bodies and of those that they touch in turn: the ground that carries a body which is hit, a short
// stack below it. Of two bodies the outermost points of each face count: the others can add nothing to them, whatever
// pieces the bodies consist of.
// Scope: impacts in piles of more than `CLUSTER_POINTS` are left to Chipmunk.
// Cost: in `block_solver.c`.

#include "impact_clusters.h"
#include "contact.h"
#include "touch.h"

static bool has_body(const Cluster *cluster, const cpBody *body) {
    for (int number = 0; number < cluster->body_count; number++) {
        if (cluster->bodies[number] == body) {
            return true;
        }
    }
    return false;
}

bool has_point(const Cluster *cluster, const cpContact *contact) {
    for (int number = 0; number < cluster->count; number++) {
        if (cluster->points[number].contact == contact) {
            return true;
        }
    }
    return false;
}

// Whether two bodies are the same, or both such that forces do not move them.
static bool are_one(const cpBody *one, const cpBody *other) {
    return one == other || !(is_movable(one) || is_movable(other));
}

// Whether two contacts are of the same face of the same two bodies.
static bool share_face(const cpArbiter *one, const cpArbiter *other) {
    bool same = are_one(one->body_a, other->body_a) && are_one(one->body_b, other->body_b);
    bool turned = are_one(one->body_a, other->body_b) && are_one(one->body_b, other->body_a);
    Vec normal = same ? other->n : negated(other->n);
    return (same || turned) && length(sub(one->n, normal)) <= same_normal;
}

// Where a point lies along the face of a contact [m].
static double position_along(const cpArbiter *face, ClusterPoint point) {
    const cpBody *body = is_movable(face->body_a) ? face->body_a : face->body_b;
    Vec arm = body == point.arbiter->body_a ? point.contact->r1 : point.contact->r2;
    return cross(face->n, arm);
}

// Add a point to a cluster, unless it lies between two of the same face.
static void add_point(Cluster *cluster, ClusterPoint point) {
    ClusterPoint *ends[2];
    int count = 0;
    for (int number = 0; number < cluster->count && count < 2; number++) {
        if (share_face(point.arbiter, cluster->points[number].arbiter)) {
            ends[count++] = cluster->points + number;
        }
    }
    if (count < 2) {
        cluster->too_many = cluster->count == CLUSTER_POINTS;
        if (!cluster->too_many) {
            cluster->points[cluster->count++] = point;
        }
        return;
    }
    double position = position_along(point.arbiter, point), first = position_along(point.arbiter, *ends[0]),
           second = position_along(point.arbiter, *ends[1]);
    if (position < least(first, second)) {
        *ends[first < second ? 0 : 1] = point;
    } else if (position > greatest(first, second)) {
        *ends[first > second ? 0 : 1] = point;
    }
}

// Add the points of a contact to a cluster, and its bodies, unless it is deferred.
static void add_contact(Cluster *cluster, cpArbiter *arbiter) {
    // Far away a distance can be lost in rounding, and with it the direction.
    bool has_normal = arbiter->n.x != 0.0 || arbiter->n.y != 0.0;
    if (arbiter->count == 0 || !has_normal || is_deferred(arbiter->contacts)) {
        return;
    }
    for (int number = 0; number < arbiter->count && !cluster->too_many; number++) {
        ClusterPoint point = {arbiter, arbiter->contacts + number};
        if (!has_point(cluster, point.contact)) {
            add_point(cluster, point);
        }
    }
    const cpBody *bodies[2] = {arbiter->body_a, arbiter->body_b};
    for (int end = 0; end < 2 && !cluster->too_many; end++) {
        if (is_movable(bodies[end]) && !has_body(cluster, bodies[end])) {
            assert(cluster->body_count < CLUSTER_BODIES);
            cluster->bodies[cluster->body_count++] = bodies[end];
        }
    }
}

// `qsort` may put equal hits in any order, and the order of points is that of sums, so that shapes decide, too.
static int by_bodies(const void *one, const void *other) {
    const Hit *x = one, *y = other;
    return compared(4, (double[][2]){{x->a, y->a},
                                     {x->b, y->b},
                                     {(double)x->contact->a->hashid, (double)y->contact->a->hashid},
                                     {(double)x->contact->b->hashid, (double)y->contact->b->hashid}});
}

int list_hits(World *world, Hit *hits) {
    int count = 0;
    for (int number = 0; number < arbiter_count(world); number++) {
        cpArbiter *each = arbiter_at(world, number);
        if (is_impact(each) && !is_deferred(each->contacts)) {
            int a = is_movable(each->body_a) ? place_of(world, each->body_a) : world->body_count;
            int b = is_movable(each->body_b) ? place_of(world, each->body_b) : world->body_count;
            hits[count++] = (Hit){each, a < b ? a : b, a < b ? b : a};
        }
    }
    sort(hits, count, sizeof(Hit), by_bodies);
    return count;
}

// Add all contacts of the bodies of a cluster, and the bodies that they reach.
static void add_neighbours(Cluster *cluster) {
    for (int number = 0; number < cluster->body_count; number++) {
        const cpBody *body = cluster->bodies[number];
        for (cpArbiter *each = body->arbiterList; each != NULL && !cluster->too_many; each = next_of(each, body)) {
            add_contact(cluster, each);
        }
    }
}

Cluster cluster_of(const Hit *hits, int count) {
    Cluster cluster = {.count = 0};
    for (int number = 0; number < count; number++) {
        add_contact(&cluster, hits[number].contact);
    }
    add_neighbours(&cluster);
    return cluster;
}
