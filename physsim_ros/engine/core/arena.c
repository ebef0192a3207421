// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

#include "arena.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

// Pieces begin at multiples of this [bytes].
enum { ALIGNMENT = 16 };

typedef struct Block {
    struct Block *next;
    size_t padding; // so that what follows is aligned
} Block;

void *arena_take(Arena *arena, size_t count, size_t size) {
    assert(size > 0 && size <= INT32_MAX && count <= INT32_MAX); // a negative count is not
    size_t bytes = (count * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    void *piece = NULL;
    if (arena->used + bytes <= arena->size) {
        piece = arena->memory + arena->used;
    } else {
        Block *block = calloc(1, sizeof(Block) + bytes);
        if (block == NULL) {
            abort(); // as every allocation of Chipmunk's does
        }
        block->next = arena->extra;
        arena->extra = block;
        piece = block + 1;
    }
    arena->used += bytes;
    if (arena->used > arena->most) {
        arena->most = arena->used;
    }
    return piece;
}

// Clear what was taken since a mark.
static void clear_since(Arena *arena, size_t mark) {
    size_t end = arena->used < arena->size ? arena->used : arena->size;
    if (mark < end) {
        memset(arena->memory + mark, 0, end - mark);
    }
}

void arena_release(Arena *arena, size_t mark) {
    assert(mark <= arena->used);
    clear_since(arena, mark);
    arena->used = mark;
}

static void free_extra(Arena *arena) {
    while (arena->extra != NULL) {
        Block *next = arena->extra->next;
        free(arena->extra);
        arena->extra = next;
    }
}

void arena_reset(Arena *arena) {
    free_extra(arena);
    clear_since(arena, 0);
    if (arena->most > arena->size) {
        free(arena->memory);
        // A half more, since what a sub-step needs varies.
        arena->size = arena->most + arena->most / 2;
        arena->memory = calloc(1, arena->size);
        if (arena->memory == NULL) {
            abort();
        }
    }
    arena->used = arena->most = 0;
}

void arena_free(Arena *arena) {
    free_extra(arena);
    free(arena->memory);
    *arena = (Arena){0};
}
