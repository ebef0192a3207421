# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Strokes on `~/stroke` are answered, whatever comes in them, and quickly."""

from __future__ import annotations

import math

from physsim_ros.model.errors import Malformed
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.ros.requests.conversions import stroke_samples
from physsim_ros.testing import disc, PhysSim
import pytest
from rclpy.parameter import Parameter
from visualization_msgs.msg import Marker, MarkerArray

from .messages import circle, stroke
from ..client import Client, KEPT


def test_a_stroke_becomes_a_body_and_is_told_with_its_confidence(
    client: Client,
) -> None:
    told, spawned = client.ask('~/stroke', stroke(*circle(3.0, 2.0, 1.5)))

    assert (told.level, told.name, told.code) == (0, '~/stroke', 'ok')
    assert told.hardware_id == 'drawn/0'
    assert told.values['reading'] == 'disc'
    assert 0.6 <= float(told.values['confidence']) <= 1.0
    assert told.values['requests'] == '1'
    assert (spawned.name, spawned.hardware_id, spawned.code) == ('~/stroke', 'drawn/0', 'ok')
    # m
    assert client.physsim.pose('drawn/0')[:2] == pytest.approx((3.0, 2.0), abs=0.01)


def test_a_reading_is_shown_until_the_next_or_until_a_tool_is_taken(client: Client) -> None:
    pictures = client.listen(MarkerArray, '~/preview', KEPT)
    client.ask('~/stroke', stroke(*circle(3.0, 2.0, 1.5)))
    clearing, outline, label = pictures[-1].markers
    assert clearing.action == Marker.DELETEALL
    assert outline.type == Marker.LINE_STRIP
    assert max(point.x for point in outline.points) == pytest.approx(4.5, abs=0.01)
    assert label.text.startswith('disc ')
    client.physsim.node.set_parameters([Parameter('tool', value='wall')])
    client.physsim.node.loop.apply_requests()
    client.spin_until(lambda: len(pictures[-1].markers) == 1)


def test_a_stroke_may_be_drawn_in_the_frame_of_a_body(client: Client) -> None:
    client.physsim.spawn(disc('a/0', at=(10.0, 5.0, math.pi / 2)))
    events = client.ask('~/stroke', stroke(*circle(3.0, 0.0, 1.0), frame='a/0'))
    assert [event.code for event in events] == ['ok', 'ok']
    assert client.physsim.pose('drawn/0')[:2] == pytest.approx((10.0, 8.0), abs=0.01)


def test_below_the_confidence_that_is_asked_for_nothing_is_built(
    client: Client, physsim: PhysSim
) -> None:
    pictures = client.listen(MarkerArray, '~/preview', KEPT)
    physsim.node.set_parameters([Parameter('sketch_confidence', value=1.0)])
    before = physsim.digest()
    (event,) = client.ask('~/stroke', stroke(*circle(0, 0, 1)))
    assert event.code == 'not_recognised'
    assert 'disc' in event.message
    assert event.values['reading'] == 'disc'
    assert 0.5 < float(event.values['confidence']) < 1.0
    assert physsim.digest() == before
    assert pictures[-1].markers[-1].text == 'not recognised'


# Samples


@pytest.mark.parametrize('frame', ['', 'w', 'world', 'Würfel/12', 'a' * 1000])
@pytest.mark.parametrize('count', [0, 1, 2, 7])
def test_every_sample_is_read_whatever_its_frame_is_called(frame: str, count: int) -> None:
    points = [(1.5 * number, -number / 3) for number in range(count)]
    found, samples, _ = stroke_samples(stroke(*points, frame=frame, frames=[frame] * count))
    assert samples.shape == (count, 3)
    assert list(map(tuple, samples[:, :2].tolist())) == points
    assert found == frame


@pytest.mark.parametrize('frames', [['', '', ''], ['map', '', 'map']])
@pytest.mark.parametrize('frame', ['', 'map'])
def test_a_frame_may_be_said_or_left_out(frame: str, frames: list[str]) -> None:
    found, *_ = stroke_samples(stroke((0, 0), (1, 1), (2, 2), frame=frame, frames=frames))
    assert found == ('map' if frame or any(frames) else '')


def test_poses_of_different_frames_are_no_stroke() -> None:
    message = stroke((0, 0), (1, 1), frame='a/0', frames=['a/0', 'b/0'])
    with pytest.raises(Malformed, match='one frame') as refused:
        stroke_samples(message)
    assert refused.value.field == 'header.frame_id'


@pytest.mark.parametrize('begin', [0, 10**18 + 999_999_999])
def test_times_count_from_the_first_sample(begin: int) -> None:
    points = ((0, 0, 0), (1, 0, 0.25), (2, 0, 0.125), (3, 0, 1.75))
    _, samples, _ = stroke_samples(stroke(*points, begin=begin))
    assert samples[:, 2].tolist() == [0.0, 0.25, 0.125, 1.75]


def test_as_many_samples_as_a_stroke_may_have_are_read_and_one_more_is_refused() -> None:
    points = [(0.001 * number, 0.0) for number in range(MOST_SAMPLES + 1)]
    _, samples, _ = stroke_samples(stroke(*points[:-1]))
    assert len(samples) == MOST_SAMPLES
    with pytest.raises(Malformed, match=str(MOST_SAMPLES + 1)) as refused:
        stroke_samples(stroke(*points))
    assert refused.value.field == 'poses'
