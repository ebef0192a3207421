// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// The arena of checked runs: each piece is a block of the heap.
//
// AddressSanitizer knows where a block of the heap ends. Of the pieces of a linear allocator it knows nothing, and a
// write past one of them goes into the next. A piece that was released is freed before the next one is taken.

#include "arena.h"
#include <stdlib.h>

typedef struct Block {
    struct Block *next;
    size_t begin; // what was in use when it was taken, as a mark
} Block;

// Free the pieces that were taken since a mark.
static void free_since(Arena *arena, size_t mark) {
    while (arena->extra != NULL && arena->extra->begin >= mark) {
        Block *next = arena->extra->next;
        free(arena->extra);
        arena->extra = next;
    }
}

void *arena_take(Arena *arena, size_t count, size_t size) {
    free_since(arena, arena->used);
    Block *block = calloc(1, sizeof(Block) + count * size);
    if (block == NULL) {
        abort();
    }
    *block = (Block){arena->extra, arena->used};
    arena->extra = block;
    arena->used++; // pieces are counted
    return block + 1;
}

void arena_release(Arena *arena, size_t mark) {
    assert(mark <= arena->used);
    arena->used = mark;
}

void arena_reset(Arena *arena) {
    free_since(arena, 0);
    arena->used = 0;
}

void arena_free(Arena *arena) {
    free_since(arena, 0);
    *arena = (Arena){0};
}
