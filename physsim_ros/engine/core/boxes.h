// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// A tree of boxes, by which those that overlap a box are found.

#ifndef PHYSSIM_BOXES_H
#define PHYSSIM_BOXES_H

#include "arena.h"
#include "motion.h"

typedef struct Tree {
    int count;
    size_t leaves; // a power of two
    int *members;  // (count): which box each leaf has
    int *leaf_of;  // (count): the leaf of each box
    Box *nodes;    // (2 * leaves): the root is 1, the children of k are 2 k and 2 k + 1
} Tree;

// Return the tree of boxes.
Tree tree_of(const Box *boxes, int count, Arena *arena);

// Return a tree of as many boxes, which are nowhere, each at the leaf that it has in another one.
Tree emptied(const Tree *tree, Arena *arena);

// Replace a box.
void tree_set(Tree *tree, int number, Box box);

// Whether a box overlaps one of the tree.
bool tree_meets(const Tree *tree, Box box);

// Call a function for each box that overlaps one, until it returns false.
void tree_query(const Tree *tree, Box box, bool (*found)(int number, void *data), void *data);

#endif
