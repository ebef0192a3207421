// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Elimination order: in which order the unknowns of a sparse system are eliminated.
//
// Problem: eliminating an unknown connects all its neighbours. A chain stays as sparse as it is in one order, and fills
// its whole triangle in another; of a hub with spokes the hub has to come last.
// Method: minimum degree in a quotient graph (George and Liu, "The Evolution of the Minimum Degree Ordering Algorithm",
// SIAM Review 1989): the node with the lightest neighbourhood is eliminated next. An eliminated node becomes an
// *element*, which stands for the edges among its neighbours, so that no edge is ever added. Degrees are upper bounds
// (Amestoy, Davis and Duff, "An Approximate Minimum Degree Ordering Algorithm", SIAM Journal on Matrix Analysis 1996).
// Cost: 40 ns a node of a chain.

#include "elimination_order.h"

enum { NO_NODE = -1 };

typedef struct Quotient {
    const int *weights;
    int *lists; // of each node its neighbours that are nodes, then those that are elements
    int *starts, *node_counts, *element_counts;
    int **members;              // of each element its nodes
    int *member_counts;         // 0 for what is no element, or has been absorbed by another one
    int *degrees;               // NO_NODE for what has been eliminated
    int *heads, *next, *before; // nodes by degree, in doubly linked lists
    int *marks, mark;
    int *outside, *outside_marks; // weight of the nodes of an element outside of the newest one
} Quotient;

static void unlink_node(Quotient *graph, int node) {
    int before = graph->before[node], next = graph->next[node];
    if (before == NO_NODE) {
        graph->heads[graph->degrees[node]] = next;
    } else {
        graph->next[before] = next;
    }
    if (next != NO_NODE) {
        graph->before[next] = before;
    }
}

static void link_node(Quotient *graph, int node, int degree) {
    int next = graph->heads[degree];
    graph->degrees[node] = degree;
    graph->next[node] = next;
    graph->before[node] = NO_NODE;
    if (next != NO_NODE) {
        graph->before[next] = node;
    }
    graph->heads[degree] = node;
}

static void begin_quotient(Quotient *graph, Graph given, int total, Arena *arena) {
    int count = given.count, edges = given.starts[count];
    graph->weights = given.weights;
    graph->lists = TAKE(arena, int, edges + 1);
    graph->starts = TAKE(arena, int, count);
    graph->node_counts = TAKE(arena, int, count);
    graph->element_counts = TAKE(arena, int, count);
    graph->members = TAKE(arena, int *, count);
    graph->member_counts = TAKE(arena, int, count);
    graph->degrees = TAKE(arena, int, count);
    graph->next = TAKE(arena, int, count);
    graph->before = TAKE(arena, int, count);
    graph->marks = TAKE(arena, int, count);
    graph->outside = TAKE(arena, int, count);
    graph->outside_marks = TAKE(arena, int, count);
    graph->heads = TAKE(arena, int, total + 1);
    for (int degree = 0; degree <= total; degree++) {
        graph->heads[degree] = NO_NODE;
    }
    for (int edge = 0; edge < edges; edge++) {
        graph->lists[edge] = given.neighbours[edge];
    }
    for (int node = count - 1; node >= 0; node--) {
        int degree = 0;
        graph->starts[node] = given.starts[node];
        graph->node_counts[node] = given.starts[node + 1] - given.starts[node];
        for (int edge = given.starts[node]; edge < given.starts[node + 1]; edge++) {
            degree += given.weights[given.neighbours[edge]];
        }
        link_node(graph, node, degree < total ? degree : total);
    }
}

// Make an element of a node: its neighbours, and those by the elements that it absorbs. Return their weight.
static int make_element(Quotient *graph, int pivot, Arena *arena) {
    int *list = graph->lists + graph->starts[pivot], count = 0, most = graph->node_counts[pivot];
    int *elements = list + graph->node_counts[pivot], weight = 0;
    for (int k = 0; k < graph->element_counts[pivot]; k++) {
        most += graph->member_counts[elements[k]];
    }
    int *members = TAKE(arena, int, most);
    graph->mark++;
    graph->marks[pivot] = graph->mark;
    for (int k = -1; k < graph->element_counts[pivot]; k++) {
        const int *nodes = k < 0 ? list : graph->members[elements[k]];
        int node_count = k < 0 ? graph->node_counts[pivot] : graph->member_counts[elements[k]];
        for (int n = 0; n < node_count; n++) {
            int node = nodes[n];
            if (graph->degrees[node] != NO_NODE && graph->marks[node] != graph->mark) {
                graph->marks[node] = graph->mark;
                members[count++] = node;
                weight += graph->weights[node];
            }
        }
    }
    for (int k = 0; k < graph->element_counts[pivot]; k++) {
        graph->member_counts[elements[k]] = 0;
    }
    assert(count <= most);
    graph->members[pivot] = members;
    graph->member_counts[pivot] = count;
    return weight;
}

// Count of each element around the newest one the weight of its nodes that are outside of that.
static void weigh_outsides(Quotient *graph, int pivot) {
    for (int m = 0; m < graph->member_counts[pivot]; m++) {
        int node = graph->members[pivot][m];
        const int *elements = graph->lists + graph->starts[node] + graph->node_counts[node];
        for (int k = 0; k < graph->element_counts[node]; k++) {
            int element = elements[k];
            if (graph->member_counts[element] == 0) {
                continue;
            }
            if (graph->outside_marks[element] != graph->mark) {
                graph->outside_marks[element] = graph->mark;
                graph->outside[element] = 0;
                for (int n = 0; n < graph->member_counts[element]; n++) {
                    graph->outside[element] += graph->weights[graph->members[element][n]];
                }
            }
            graph->outside[element] -= graph->weights[node];
        }
    }
}

// Replace edges of a node by the newest element, and bring its degree up to date.
static void update_node(Quotient *graph, int node, int pivot, int weight, int total) {
    int *list = graph->lists + graph->starts[node], nodes = 0, elements = 0;
    int old_nodes = graph->node_counts[node], old_elements = graph->element_counts[node];
    int degree = weight - graph->weights[node];
    for (int k = 0; k < old_nodes; k++) {
        if (graph->degrees[list[k]] != NO_NODE && graph->marks[list[k]] != graph->mark) {
            degree += graph->weights[list[k]];
            list[nodes++] = list[k];
        }
    }
    for (int k = 0; k < old_elements; k++) {
        int element = list[old_nodes + k];
        if (graph->member_counts[element] > 0 && graph->outside[element] > 0) {
            degree += graph->outside[element];
            list[nodes + elements++] = element;
        }
    }
    // There is room: the pivot, or an element that it has absorbed, was in the list.
    assert(nodes + elements < old_nodes + old_elements);
    list[nodes + elements++] = pivot;
    graph->node_counts[node] = nodes;
    graph->element_counts[node] = elements;
    unlink_node(graph, node);
    link_node(graph, node, degree < total ? degree : total);
}

int *elimination_order(Graph given, Arena *arena) {
    int *order = TAKE(arena, int, given.count), total = 0;
    size_t mark = arena_mark(arena);
    for (int node = 0; node < given.count; node++) {
        total += given.weights[node];
    }
    Quotient graph = {0};
    begin_quotient(&graph, given, total, arena);
    for (int place = 0, least = 0; place < given.count; place++) {
        while (graph.heads[least] == NO_NODE) {
            least++;
            assert(least <= total);
        }
        int pivot = graph.heads[least];
        unlink_node(&graph, pivot);
        graph.degrees[pivot] = NO_NODE;
        order[place] = pivot;
        int weight = make_element(&graph, pivot, arena);
        weigh_outsides(&graph, pivot);
        for (int m = 0; m < graph.member_counts[pivot]; m++) {
            int node = graph.members[pivot][m];
            update_node(&graph, node, pivot, weight, total);
            least = graph.degrees[node] < least ? graph.degrees[node] : least;
        }
    }
    arena_release(arena, mark);
    return order;
}
