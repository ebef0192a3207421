// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_IMPACT_CLUSTERS_H
#define PHYSSIM_IMPACT_CLUSTERS_H

#include "lcp.h"
#include "world.h"

// Points that are solved together, at most: of four boxes on each other and the ground, eight are.
enum { CLUSTER_POINTS = LCP_ROWS };
// Bodies that move, at most: two that meet, and each further one brings a point.
enum { CLUSTER_BODIES = CLUSTER_POINTS + 1 };

// A contact that is an impact (`is_impact`), whether it begins or not.
typedef struct Hit {
    cpArbiter *contact;
    int a, b; // places of its bodies, the lesser first; those that forces do not move are one: `body_count`
} Hit;

// A point of a contact.
typedef struct ClusterPoint {
    cpArbiter *arbiter;
    cpContact *contact;
} ClusterPoint;

// Two bodies that hit each other, those that they reach through contacts, and the outermost points of these.
typedef struct Cluster {
    const cpBody *bodies[CLUSTER_BODIES];
    ClusterPoint points[CLUSTER_POINTS];
    int body_count, count;
    bool too_many;
} Cluster;

static inline bool is_movable(const cpBody *body) {
    return body->m_inv > 0.0;
}

// Whether a cluster has a point of a contact.
bool has_point(const Cluster *cluster, const cpContact *contact);

// List the contacts that are impacts, by bodies, and return their count; room for all contacts.
int list_hits(World *world, Hit *hits);

// The cluster of the contacts by which two bodies hit each other.
Cluster cluster_of(const Hit *hits, int count);

#endif
