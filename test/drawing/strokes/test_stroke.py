# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A stroke is the same geometry, however it was sampled."""

from itertools import pairwise
import math

import numpy as np
from physsim_ros.drawing.strokes.corner_detection import corners, vertices
from physsim_ros.drawing.strokes.features import features_of
from physsim_ros.drawing.strokes.fitting import simplified
from physsim_ros.drawing.strokes.resampled import COUNT, smoothed, widened
from physsim_ros.drawing.strokes.samples import clean_samples, GRAIN
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import BadSize, Malformed
import pytest

ANGLE = np.linspace(0.0, 5.0, 60)
ARC = np.column_stack((np.cos(ANGLE), np.sin(ANGLE)))
SIZE = float(np.hypot(*np.ptp(ARC, axis=0)))
SQUARE = np.array([(0, 0), (2, 0), (2, 2), (0, 2), (0, 0)], dtype=np.float64)


def along(way: Floats, count: int) -> Floats:
    """Return that many samples along a way, corners not among them."""
    length = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(way, axis=0).T))))
    at = np.linspace(0.0, length[-1], count)
    return np.column_stack([np.interp(at, length, axis) for axis in way.T])


def found(samples: Floats) -> Floats:
    """Return the corners of a closed stroke, from the lowest left one on, counter-clockwise."""
    drawn = resample_stroke(samples)
    assert drawn.outline is not None
    outline, narrowed = widened(drawn.outline)
    at = corners(smoothed(outline, closed=True), closed=True)
    made = narrowed(vertices(outline, at, closed=True))
    middle = made.mean(axis=0)
    angle = np.arctan2(*(made - middle).T[::-1])
    return made[np.argsort(angle)]


@pytest.mark.parametrize('bow', [-0.15, -0.1, 0.0, 0.1, 0.2])
def test_a_check_with_bowed_arms_has_one_bend(bow: float) -> None:
    x = np.linspace(0.0, 1.0, 40)
    arm = np.column_stack((x, x + 4.0 * bow * x * (1.0 - x)))
    check = np.vstack((0.5 * arm[::-1] * (-1.0, 1.0), arm))

    assert features_of(resample_stroke(check)).bends == pytest.approx(
        np.array([(-0.5, 0.5), (0.0, 0.0), (1.0, 1.0)]), abs=0.15
    )


CORNERS = np.array([(0, 0), (2, 0), (2, 2), (0, 2)])
# Samples of a square, and by how far its corners may be off [m].
SQUARES = {
    'clicks': (SQUARE, 0.01),
    # 21 samples are 0.4 m apart and miss the corners.
    **{f'{count} samples': (along(SQUARE, count), 0.06) for count in (21, 60, 1003, 100_000)},
    'an end that was drawn twice': (along(np.vstack((SQUARE, [(0.7, 0.02)])), 150), 0.05),
    'ends that do not meet': (
        along(np.array([(0.15, 0), (2, 0), (2, 2), (0, 2), (0, 0.15)]), 150), 0.05,
    ),
}  # fmt: skip


@pytest.mark.parametrize(('samples', 'tolerance'), SQUARES.values(), ids=SQUARES)
def test_a_square_has_four_corners_however_it_was_sampled(
    samples: Floats, tolerance: float
) -> None:
    assert found(samples) == pytest.approx(CORNERS, abs=tolerance)


@pytest.mark.parametrize(('size', 'far'), [(0.01, 0.0), (1.0, 1e5)])
def test_a_stroke_is_the_same_in_any_size_and_far_from_the_origin(size: float, far: float) -> None:
    here = found(along(SQUARE, 200))

    assert (found(size * along(SQUARE, 200) + far) - far) / size == pytest.approx(here, abs=1e-6)


def test_hooks_of_the_pen_are_cut_off() -> None:
    hooked = np.array([(0.05, 0.12), (0, 0), (3, 0), (2.95, -0.1)])

    drawn = resample_stroke(along(hooked, 200))

    assert features_of(drawn).bends == pytest.approx(np.array([(0, 0), (3, 0)]), abs=0.06)


def test_a_line_that_goes_back_upon_itself_has_a_corner_there() -> None:
    arrow = np.array([(0, 0), (3, 0), (2.3, 0.5), (3, 0), (2.3, -0.5)])
    drawn = resample_stroke(along(arrow, 200))

    assert len(corners(features_of(drawn).path, closed=False)) == 5


def curve_of(way: Floats) -> Floats | None:
    features = features_of(resample_stroke(way))
    return simplified(features.path, features.bends, features.stroke.size)


def test_a_curve_is_kept_as_points_near_to_it_and_a_bow_of_a_line_is_not() -> None:
    x = np.linspace(0.0, 4.0, 150)
    hill, bow = (np.column_stack((x, high * np.sin(math.pi * x / 4))) for high in (1.0, 0.05))

    curve = curve_of(hill)

    assert curve is not None
    assert 6 <= len(curve) <= 30
    # m: 0.6 % of its size, and what smoothing takes
    assert curve[:, 1] == pytest.approx(np.sin(math.pi * curve[:, 0] / 4), abs=0.03)
    assert curve_of(bow) is None


def test_points_are_evenly_spaced_and_of_one_count() -> None:
    uneven = along(SQUARE, 300)[np.r_[0:40, 40:300:7]]

    points = resample_stroke(uneven).points

    assert points.shape == (COUNT, 2)
    steps = np.hypot(*np.diff(points, axis=0).T)
    # Around a corner the way between two points is longer than their distance.
    assert steps.max() <= steps.mean() * 1.01


def test_times_are_not_needed() -> None:
    samples = along(SQUARE, 90)
    timed = np.column_stack((samples, np.linspace(0.0, 3.0, 90) ** 2))

    assert (resample_stroke(timed).points == resample_stroke(samples).points).all()


def test_samples_that_came_in_another_order_are_put_in_that_of_their_times() -> None:
    samples = np.column_stack((along(SQUARE, 90), np.arange(90) / 60.0))
    shuffled = np.random.default_rng(0).permutation(samples)

    assert (resample_stroke(shuffled).points == resample_stroke(samples).points).all()


@pytest.mark.parametrize(
    ('samples', 'refusal'),
    [
        ([], Malformed),
        ([(1.0, 1.0)], BadSize),
        ([(1.0, 1.0)] * 50, BadSize),
        ([(0.0, 0.0), (1e-5, 0.0)], BadSize),
        ([(0.0, 0.0), (math.nan, 1.0)], Malformed),
        ([(0.0, 0.0), (math.inf, 1.0)], Malformed),
        ([(0.0, 0.0), (1e8, 1.0)], BadSize),
        ([(0.0, 0.0), (1e300, 1.0)], BadSize),
    ],
)
def test_what_is_no_stroke_is_refused(
    samples: list[tuple[float, float]], refusal: type[Exception]
) -> None:
    with pytest.raises(refusal) as caught:
        resample_stroke(np.array(samples, dtype=np.float64).reshape(-1, 2))

    assert caught.value.field == 'poses'


@pytest.mark.parametrize(('number', 'refusal'), [(math.inf, Malformed), (1e300, BadSize)])
def test_samples_with_times_are_refused_before_they_are_computed_with(
    number: float, refusal: type[Exception]
) -> None:
    samples = np.column_stack((ARC, ANGLE))
    samples[[3, 7], 0] = number
    with np.errstate(all='raise'), pytest.raises(refusal):
        resample_stroke(samples)


def length(points: Floats) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


ENDS = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0), (0.0, 0.02)]
# Samples of which all were meant.
KEPT = {
    'without jumps': ARC,
    'clicks of an arrow': np.array([(0, 0), (3, 0), (2.5, 0.4), (3, 0), (2.5, -0.4)]),
    'clicks of teeth': np.array([(n, 5.0 * (n % 2)) for n in range(20)]),
    # More samples remain where the hand trembles at a corner.
    'corners': np.vstack([np.add(at, [(0, 0), (0.03, 0.02), (0.05, -0.02)]) for at in ENDS]),
}


@pytest.mark.parametrize('samples', KEPT.values(), ids=KEPT)
def test_distinct_samples_that_were_meant_stay_as_they_are(samples: Floats) -> None:
    assert (clean_samples(samples) == samples).all()


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


@pytest.mark.parametrize('share', [0.15, 0.35])
@pytest.mark.parametrize('way', ['line', 'arc', 'square'])
@pytest.mark.parametrize('batch', [1, 4])
def test_the_first_step_of_a_finger_is_kept(way: str, share: float, batch: int) -> None:
    # A touch screen sends nothing until the finger has gone 61 to 71 pixels, and then samples at
    # an even pace, several with one time where the page was busy.
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], dtype=np.float64)
    square = np.vstack([np.linspace(a, b, 20, endpoint=False) for a, b in pairwise(corners)])
    line = np.linspace((0.0, 0.0), (2.0, 1.0), 60)
    points = {'line': line, 'arc': ARC, 'square': square}[way]
    size = float(np.hypot(*np.ptp(points, axis=0)))
    late = np.maximum.accumulate(np.hypot(*(points - points[0]).T)) > share * size
    received = np.vstack((points[:1], points[late]))
    times = np.arange(len(received)) // batch * batch / 60.0

    for samples in (received, received[::-1]):
        drawn = resample_stroke(np.column_stack((samples, times)))
        assert drawn.points[[0, -1]] == pytest.approx(samples[[0, -1]])


def test_the_long_sides_between_the_round_ends_of_a_plank_of_few_samples_stay_straight() -> None:
    angle = np.linspace(-math.pi / 2, math.pi / 2, 5)
    end = 0.1 * np.column_stack((np.cos(angle), np.sin(angle)))
    end[:, 0] += 1.0
    plank = np.vstack((end, -end, end[:1]))

    outline = resample_stroke(plank).outline

    assert np.abs(outline[:, 1]).max() < 0.12
