# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A seek goes to any moment of the history; another future begins there."""

from __future__ import annotations

import math
from typing import Any

from physsim_ros.testing import disc
import pytest
from std_msgs.msg import Float64

from .journey import (
    clock_of,
    Journey,
    parameter,
    PERIOD,
    SECOND,
    STEP,
    succeeded,
)
from ..client import set_parameter

# Seek


def test_a_seek_while_time_runs_lets_it_run_on(journey: Journey) -> None:
    journey.live(100)
    succeeded(journey.client.call('~/play'))
    journey.tick(3)

    journey.seek(0.5 * SECOND)
    frames = journey.tick(20)

    assert frames[0][0] == pytest.approx(0.5 * SECOND, abs=2)
    assert frames[-1][0] == pytest.approx(0.5 * SECOND + 19 * PERIOD, abs=2 * PERIOD)
    assert parameter(journey.physsim, 'speed') == 1.0
    journey.compare(frames, 18)


# Just before the oldest step, just after the newest, and as far off as a clock tells.
@pytest.mark.parametrize('off', [-3_000_000, 3_000_000, 2_000_000_000 * 10**9])
def test_a_seek_out_of_history_is_refused_and_changes_nothing(journey: Journey, off: int) -> None:
    journey.live(60)
    before, speed = journey.physsim.digest(), parameter(journey.physsim, 'speed')
    journey.shown()

    answer = journey.seek(off if off < 0 else journey.end + off)

    assert answer.level == 2
    assert (answer.code, answer.field) == ('out_of_history', 'clock')
    assert journey.physsim.digest() == before
    assert parameter(journey.physsim, 'speed') == speed
    assert journey.tick(3) == []


@pytest.mark.parametrize(
    ('topic', 'message'),
    [
        ('~/seek', clock_of(0)),
        ('~/speed', Float64(data=math.nan)),
    ],
)
def test_what_was_asked_before_is_answered_before(
    journey: Journey, topic: str, message: Any
) -> None:
    journey.live(60)
    # Both ways are known before anything is asked.
    journey.client.ask('~/spawn', disc('a/0'))
    journey.client.ask(topic, message)
    told = len(journey.client.events)

    journey.client.publish('~/spawn', disc('b/0'))
    journey.physsim.settle()
    journey.client.ask(topic, message)

    names = [event.name for event in journey.client.events[told:] if event.name[:2] == '~/']
    assert names == ['~/spawn', topic]


# Something else in the past


def test_a_parameter_set_in_the_past_begins_a_branch(journey: Journey) -> None:
    journey.live(60)
    journey.seek(0.5 * SECOND)
    journey.client.events.clear()

    set_parameter(journey.physsim, 'gravity', [0.0, 3.0])
    journey.tick()

    assert [event.name for event in journey.client.events] == ['branch']
    assert journey.seek(journey.end).code == 'out_of_history'


def test_looking_and_changing_pace_in_the_past_begins_none(journey: Journey) -> None:
    journey.live(60)
    journey.seek(0.5 * SECOND)
    journey.client.events.clear()

    for service in ('play', 'pause', 'step', 'fast_forward', 'rewind', 'pause'):
        succeeded(journey.client.call(f'~/{service}'))
        journey.tick(2)
    gravity = parameter(journey.physsim, 'gravity')
    set_parameter(journey.physsim, 'gravity', gravity)

    journey.tick()
    assert {event.name for event in journey.client.events} == {
        f'~/{service}' for service in ('play', 'pause', 'step', 'fast_forward', 'rewind')
    }
    assert journey.seek(journey.end).code == 'ok'


# History


def test_history_is_how_far_back_it_goes(journey: Journey) -> None:
    journey.live(200)
    last = round(journey.end / STEP)
    set_parameter(journey.physsim, 'history', 1.0)

    for stamp in (journey.end - SECOND - 1.1 * STEP, 0.0):
        assert journey.seek(stamp).code == 'out_of_history'
    journey.shown()
    succeeded(journey.client.call('~/rewind'))
    frames = journey.tick(80)

    journey.compare(frames, 58)
    assert round(frames[-1][0] / STEP) == last - 240
    assert journey.client.events[-1].name == 'history'
    assert parameter(journey.physsim, 'speed') == 0.0
