// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Memory of one sub-step: taken piece by piece, given back all at once.
//
// Method: a linear allocator (Box2D v3, `arena_allocator.c`). A sub-step that needs more than there is gets the rest
// from the heap, and the arena has as much from the next sub-step on; so sub-steps allocate nothing once a world has
// been running.
// Law: all bits of what is free are 0. Small pieces, of which a joint needs some 70 in a sub-step, are cleared
// together.

#ifndef PHYSSIM_ARENA_H
#define PHYSSIM_ARENA_H

#include <assert.h>
#include <stddef.h>
#include <string.h>

typedef struct Arena {
    char *memory;
    size_t size, used, most; // [bytes]; `most` is what was in use at once in this sub-step
    struct Block *extra;     // from the heap
} Arena;

// Return memory for a number of values, all bits 0; it lasts until a release of an earlier mark, or a reset.
void *arena_take(Arena *arena, size_t count, size_t size);

// Return memory that begins with a copy of values.
static inline void *arena_copy(Arena *arena, const void *values, size_t count, size_t size) {
    return memcpy(arena_take(arena, count, size), values, count * size);
}

// Return a mark, to which `arena_release` gives back what is taken from now on.
static inline size_t arena_mark(const Arena *arena) {
    return arena->used;
}

void arena_release(Arena *arena, size_t mark);

// Give back everything, between sub-steps, and grow to what the last sub-step needed.
void arena_reset(Arena *arena);

void arena_free(Arena *arena);

// The one macro of the core: a function cannot be given a type.
#define TAKE(arena, type, count) ((type *)arena_take((arena), (size_t)(count), sizeof(type)))

#endif
