# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Partitions of cells: exact, of few rectangles, within the budget, in time."""

from functools import lru_cache
import time

import numpy as np
from physsim_ros.maps import rectangles_of
from physsim_ros.model.errors import WorldFull
import pytest

PLENTY = 10**9


def cells(*rows):
    """Return cells by rows of # and ., the first one on top."""
    return np.array([[each == '#' for each in row] for row in rows[::-1]])


def painted(rectangles, shape):
    """Return how many rectangles cover each cell."""
    counts = np.zeros(shape, dtype=int)
    for first_row, first_column, last_row, last_column in rectangles:
        counts[first_row:last_row, first_column:last_column] += 1
    return counts


def fewest(occupied):
    """Return the least number of rectangles, by trying all for the first cell that is left."""
    height, width = occupied.shape

    @lru_cache(None)
    def best(left):
        if not left:
            return 0
        first_row, first_column = divmod((left & -left).bit_length() - 1, width)
        least = height * width
        for last_column in range(first_column, width):
            line = sum(1 << column for column in range(first_column, last_column + 1))
            covered = 0
            for row in range(first_row, height):
                if left & line << row * width != line << row * width:
                    break
                covered |= line << row * width
                least = min(least, 1 + best(left & ~covered))
        return least

    return best(sum(1 << int(at) for at in np.flatnonzero(occupied)))


def test_partitions_are_exact_and_have_few_rectangles():
    found = least = 0
    for seed in range(200):
        pick = np.random.default_rng(seed)
        occupied = pick.random(pick.integers(1, 6, 2)) < pick.choice([0.5, 0.7, 0.85])

        rectangles = rectangles_of(occupied, PLENTY)

        assert np.array_equal(painted(rectangles, occupied.shape), occupied)
        found += len(rectangles)
        least += fewest(occupied)
    assert least <= found <= 1.05 * least


@pytest.mark.parametrize(
    ('occupied', 'count'),
    [
        (np.zeros((0, 0), bool), 0),
        (np.zeros((3, 0), bool), 0),
        (np.zeros((3, 4), bool), 0),
        (np.ones((3, 4), bool), 1),
        (cells('#.', '.#'), 2),
        (cells('##', '#.'), 2),
        (cells('###', '#.#', '###'), 4),
        (cells('.#.', '###', '.#.'), 3),
        # One chord cuts both reflex vertices: two rectangles where each alone makes three.
        (cells('.##.', '####'), 2),
        # Chords that cross: of the two directions the one with more.
        (cells('.##.', '####', '####', '.##.'), 3),
    ],
)
def test_figures_have_as_few_as_they_can(occupied, count):
    assert len(rectangles_of(occupied, PLENTY)) == count


def test_rectangles_are_named_by_their_cells():
    assert rectangles_of(cells('....', '.##.', '.##.'), 1).tolist() == [[0, 1, 2, 3]]


def test_more_rectangles_than_there_may_be_are_refused():
    board = np.indices((4, 4)).sum(axis=0) % 2 == 0

    assert len(rectangles_of(board, 8)) == 8
    with pytest.raises(WorldFull, match='8 rectangles'):
        rectangles_of(board, 7)


def test_noise_of_a_million_cells_is_refused_without_being_partitioned():
    noise = np.random.default_rng(1).random((1000, 1000)) < 0.5
    began = time.process_time()

    with pytest.raises(WorldFull):
        rectangles_of(noise, 20_000)

    assert time.process_time() - began < 2.0


@pytest.mark.parametrize('share', [0.5, 0.97])
def test_a_million_cells_take_less_than_two_seconds(share):
    occupied = np.random.default_rng(1).random((1000, 1000)) < share
    began = time.process_time()

    rectangles = rectangles_of(occupied, PLENTY)

    # The collector and a loaded machine count, too: it takes 0.2 to 0.9 s.
    assert time.process_time() - began < 2.0
    assert np.array_equal(painted(rectangles, occupied.shape), occupied)
