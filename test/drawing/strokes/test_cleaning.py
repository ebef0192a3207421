# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Rests, spikes and jumps of pens are gone before a stroke is read."""

from itertools import pairwise

import numpy as np
from physsim_ros.drawing.strokes.cleaning import clean_samples, GRAIN
from physsim_ros.model.arrays import Floats
import pytest

ANGLE = np.linspace(0.0, 5.0, 60)
ARC = np.column_stack((np.cos(ANGLE), np.sin(ANGLE)))
SIZE = float(np.hypot(*np.ptp(ARC, axis=0)))


def length(points: Floats) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def test_distinct_samples_without_jumps_stay_as_they_are() -> None:
    assert (clean_samples(ARC) == ARC).all()


@pytest.mark.parametrize('at', [0, 17, 59])
def test_a_pen_that_rests_draws_no_length(at: int) -> None:
    rest = ARC[at] + np.random.default_rng(at).normal(0.0, 0.002 * SIZE, (400, 2))

    cleaned = clean_samples(np.vstack((ARC[:at], rest, ARC[at:])))

    assert length(cleaned) == pytest.approx(length(ARC), abs=2 * GRAIN * SIZE)


@pytest.mark.parametrize('at', [1, 30, 58])
@pytest.mark.parametrize('resting', [0, 50])
def test_a_spike_is_gone(at: int, resting: int) -> None:
    spiked = np.vstack((np.repeat(ARC[:1], resting, axis=0), ARC))
    spiked[resting + at] += (0.4 * SIZE, 0.3 * SIZE)

    assert clean_samples(spiked) == pytest.approx(np.delete(ARC, at, axis=0))


def test_a_late_first_sample_is_gone_and_so_is_a_last_one_of_the_next_stroke() -> None:
    assert clean_samples(np.vstack(([(9.0, 5.0)], ARC))) == pytest.approx(ARC)
    assert clean_samples(np.vstack((ARC, [(9.0, 5.0)]))) == pytest.approx(ARC)


def test_clicks_are_no_spikes() -> None:
    ways = np.array([(0, 0), (3, 0), (2.5, 0.4), (3, 0), (2.5, -0.4)], dtype=np.float64)
    teeth = np.array([(n, 5.0 * (n % 2)) for n in range(20)], dtype=np.float64)

    assert (clean_samples(ways) == ways).all()
    assert (clean_samples(teeth) == teeth).all()


@pytest.mark.parametrize('share', [0.15, 0.35])
@pytest.mark.parametrize('way', ['line', 'arc', 'square'])
def test_the_first_step_of_a_finger_is_kept(way: str, share: float) -> None:
    # A touch screen sends nothing until the finger has gone 61 to 71 pixels.
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], dtype=np.float64)
    square = np.vstack([np.linspace(a, b, 20, endpoint=False) for a, b in pairwise(corners)])
    line = np.linspace((0.0, 0.0), (2.0, 1.0), 60)
    points = {'line': line, 'arc': ARC, 'square': square}[way]
    size = float(np.hypot(*np.ptp(points, axis=0)))
    late = np.maximum.accumulate(np.hypot(*(points - points[0]).T)) > share * size
    received = np.vstack((points[:1], points[late]))

    for samples in (received, received[::-1]):
        assert (clean_samples(samples)[[0, -1]] == samples[[0, -1]]).all()


def test_of_a_stroke_sent_as_its_corners_all_is_kept() -> None:
    ends = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0), (0.0, 0.02)]
    # Where the hand trembles at a corner, more samples remain.
    corners = np.vstack([np.add(at, [(0.0, 0.0), (0.03, 0.02), (0.05, -0.02)]) for at in ends])

    assert (clean_samples(corners) == corners).all()
