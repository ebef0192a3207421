# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""When sensors read: at their rate, whatever the frames, each at a moment of its own."""

import itertools

from physsim_ros.sensing import is_due
import pytest

SECOND = 1_000_000_000


def count(name, rate, frame, seconds=10):
    times = range(0, seconds * SECOND + 1, SECOND // frame)
    return sum(is_due(name, rate, a, b) for a, b in itertools.pairwise(times))


@pytest.mark.parametrize('frame', [60, 240, 50])
@pytest.mark.parametrize('rate', [5.0, 10.0, 30.0])
def test_readings_come_at_their_rate_whatever_the_frames(frame, rate):
    assert count('tb3/0|scan', rate, frame) == pytest.approx(10 * rate, abs=1)


def test_no_more_than_one_reading_a_frame():
    assert count('a', 1000.0, 60) == 600


def test_sensors_of_one_rate_read_in_different_frames():
    frames = [
        next(
            k
            for k in range(60)
            if is_due(f'robot/{n}|scan', 5.0, k * SECOND // 60, (k + 1) * SECOND // 60)
        )
        for n in range(50)
    ]

    # 50 robots in 12 frames.
    assert max(frames.count(frame) for frame in frames) < 15


def test_nothing_is_due_where_time_stands_or_goes_back():
    assert not is_due('a', 1000.0, SECOND, SECOND)
    assert not any(is_due('a', 1000.0, SECOND, SECOND - step) for step in range(1, 10**8, 10**7))
