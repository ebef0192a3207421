// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Broad phase of swept boxes: a complete binary tree over boxes in the order of tiles.
//
// Problem: the boxes that overlap one, of many that lie anywhere and have any size.
// Method: boxes are packed by sort-tile-recursive (Leutenegger, Lopez and Edgington, "STR: A Simple and Efficient
// Algorithm for R-Tree Packing", ICDE 1997): slices by x, each in the order of y. That depends on the order of places
// alone, so that one body far away spoils nothing. The tree stands in an array, as a heap does.
// Law: every box that overlaps is found.
// Cost: 0.1 µs a box to build it, some 0.1 µs a query and 10 ns for each box that is found.

#include "boxes.h"

// Depth of the tree of the most boxes that there can be.
enum { DEEPEST = 64 };

typedef struct Tile {
    Vec middle;
    int number;
} Tile;

static int by_x(const void *one, const void *other) {
    const Tile *a = one, *b = other;
    return compared(2, (double[][2]){{a->middle.x, b->middle.x}, {a->number, b->number}});
}

static int by_y(const void *one, const void *other) {
    const Tile *a = one, *b = other;
    return compared(2, (double[][2]){{a->middle.y, b->middle.y}, {a->number, b->number}});
}

static void clear_nodes(Tree *tree) {
    for (size_t node = 0; node < 2 * tree->leaves; node++) {
        tree->nodes[node] = nowhere;
    }
}

Tree tree_of(const Box *boxes, int count, Arena *arena) {
    Tree tree = {.count = count, .leaves = 1};
    while (tree.leaves < (size_t)count) {
        tree.leaves *= 2;
    }
    tree.members = TAKE(arena, int, count);
    tree.leaf_of = TAKE(arena, int, count);
    tree.nodes = TAKE(arena, Box, 2 * tree.leaves);
    size_t mark = arena_mark(arena);
    Tile *tiles = TAKE(arena, Tile, count);
    for (int number = 0; number < count; number++) {
        tiles[number] = (Tile){scaled(add(boxes[number].low, boxes[number].high), 0.5), number};
    }
    sort(tiles, count, sizeof(Tile), by_x);
    // A power of two, so that slices are subtrees.
    int slice = 1;
    while (slice * slice < count) {
        slice *= 2;
    }
    for (int first = 0; first < count; first += slice) {
        int size = count - first < slice ? count - first : slice;
        sort(tiles + first, size, sizeof(Tile), by_y);
    }
    clear_nodes(&tree);
    for (int leaf = 0; leaf < count; leaf++) {
        int number = tiles[leaf].number;
        tree.members[leaf] = number;
        tree.leaf_of[number] = leaf;
        tree.nodes[tree.leaves + (size_t)leaf] = boxes[number];
    }
    for (size_t node = tree.leaves - 1; node > 0; node--) {
        tree.nodes[node] = united(tree.nodes[2 * node], tree.nodes[2 * node + 1]);
    }
    arena_release(arena, mark);
    return tree;
}

Tree emptied(const Tree *tree, Arena *arena) {
    Tree other = *tree;
    other.nodes = TAKE(arena, Box, 2 * tree->leaves);
    clear_nodes(&other);
    return other;
}

void tree_set(Tree *tree, int number, Box box) {
    assert(number >= 0 && number < tree->count);
    size_t node = tree->leaves + (size_t)tree->leaf_of[number];
    tree->nodes[node] = box;
    for (node /= 2; node > 0; node /= 2) {
        tree->nodes[node] = united(tree->nodes[2 * node], tree->nodes[2 * node + 1]);
    }
}

void tree_query(const Tree *tree, Box box, bool (*found)(int number, void *data), void *data) {
    size_t stack[DEEPEST];
    int depth = 0;
    if (tree->count > 0) {
        stack[depth++] = 1;
    }
    while (depth > 0) {
        size_t node = stack[--depth];
        if (!overlap(tree->nodes[node], box)) {
            continue;
        }
        if (node < tree->leaves) {
            assert(depth + 2 <= DEEPEST);
            stack[depth++] = 2 * node + 1;
            stack[depth++] = 2 * node;
        } else if (!found(tree->members[node - tree->leaves], data)) {
            return;
        }
    }
}

static bool note_meeting(int number, void *data) {
    (void)number;
    *(bool *)data = true;
    return false;
}

bool tree_meets(const Tree *tree, Box box) {
    bool meets = false;
    tree_query(tree, box, note_meeting, &meets);
    return meets;
}
