# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A path becomes samples in one frame; one that is too long is refused."""

from __future__ import annotations

from collections.abc import Sequence
import math

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
import numpy as np
from physsim_ros.model.errors import Malformed
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.ros.requests.conversions import stroke_samples
import pytest


def path(
    *points: Sequence[float], frame: str = '', frames: Sequence[str] = (), begin: int = 0
) -> Path:
    """Return a path, its points x, y and, where there are three, time [s]."""
    message = Path()
    message.header.frame_id = frame
    for number, point in enumerate(points):
        sample = PoseStamped()
        x, y, seconds = (*map(float, point), 0.0)[:3]
        sample.pose.position.x, sample.pose.position.y, sample.pose.position.z = x, y, 7.0
        stamp = begin + round(seconds * 1e9)
        sample.header.stamp.sec, sample.header.stamp.nanosec = divmod(stamp, 1_000_000_000)
        sample.header.frame_id = frames[number] if frames else ''
        message.poses.append(sample)
    return message


@pytest.mark.parametrize('frame', ['', 'w', 'world', 'Würfel/12', 'a' * 1000])
@pytest.mark.parametrize('count', [0, 1, 2, 7])
def test_every_sample_is_read_whatever_its_frame_is_called(frame: str, count: int) -> None:
    points = [(1.5 * number, -number / 3) for number in range(count)]
    found, samples, _ = stroke_samples(path(*points, frame=frame, frames=[frame] * count))
    assert samples.shape == (count, 3)
    assert list(map(tuple, samples[:, :2].tolist())) == points
    assert found == frame


@pytest.mark.parametrize('frames', [['', '', ''], ['map', '', 'map']])
@pytest.mark.parametrize('frame', ['', 'map'])
def test_a_frame_may_be_said_or_left_out(frame: str, frames: list[str]) -> None:
    found, *_ = stroke_samples(path((0, 0), (1, 1), (2, 2), frame=frame, frames=frames))
    assert found == ('map' if frame or any(frames) else '')


def test_poses_of_different_frames_are_no_stroke() -> None:
    message = path((0, 0), (1, 1), frame='a/0', frames=['a/0', 'b/0'])
    with pytest.raises(Malformed, match='one frame') as refused:
        stroke_samples(message)
    assert refused.value.field == 'header.frame_id'


@pytest.mark.parametrize('begin', [0, 10**18 + 999_999_999])
def test_times_count_from_the_first_sample(begin: int) -> None:
    points = ((0, 0, 0), (1, 0, 0.25), (2, 0, 0.125), (3, 0, 1.75))
    _, samples, _ = stroke_samples(path(*points, begin=begin))
    assert samples[:, 2].tolist() == [0.0, 0.25, 0.125, 1.75]


def test_what_is_not_finite_is_left_for_the_reader_to_refuse() -> None:
    _, samples, _ = stroke_samples(path((math.nan, math.inf)))
    assert np.isnan(samples[0, 0])
    assert np.isinf(samples[0, 1])


def test_as_many_samples_as_a_stroke_may_have_are_read_and_one_more_is_refused() -> None:
    points = [(0.001 * number, 0.0) for number in range(MOST_SAMPLES + 1)]
    _, samples, _ = stroke_samples(path(*points[:-1]))
    assert len(samples) == MOST_SAMPLES
    with pytest.raises(Malformed, match=str(MOST_SAMPLES + 1)) as refused:
        stroke_samples(path(*points))
    assert refused.value.field == 'poses'
