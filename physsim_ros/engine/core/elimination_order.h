// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#ifndef PHYSSIM_ELIMINATION_ORDER_H
#define PHYSSIM_ELIMINATION_ORDER_H

#include "arena.h"

// An undirected graph of nodes with weights.
typedef struct Graph {
    int count;
    const int *weights;
    const int *starts;     // (count + 1): where the neighbours of each node begin
    const int *neighbours; // of all nodes, each edge in both directions
} Graph;

// Return (count) the nodes in an order of elimination that makes little fill.
int *elimination_order(Graph given, Arena *arena);

#endif
