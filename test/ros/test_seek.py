# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A seek goes to any moment of the history; another future begins there."""

from __future__ import annotations

import math
import random
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
    seconds,
    STEP,
    succeeded,
)
from ..client import Event, set_parameter

# Seek


def test_any_time_is_sought_and_played_on_from(journey: Journey) -> None:
    journey.live(200)
    chance = random.Random(3)

    for _ in range(15):
        stamp = chance.randrange(journey.end)
        journey.shown()
        answer = journey.seek(stamp)
        assert answer == Event(0, '~/seek', '', answer.message, 'ok', '')
        ((there, bits),) = journey.shown()
        assert abs(there - stamp) <= STEP / 2 + 1
        # As it was shown the first time, and in each frame after that.
        journey.compare([(there, bits)], 0)
        # To a millisecond.
        assert float(answer.message.split()[1]) == pytest.approx(seconds(there), abs=1e-3)
        journey.physsim.step(min(4, round((journey.end - stamp) / PERIOD)))
        journey.compare(journey.shown(), 0)


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


def test_a_request_in_the_past_begins_a_branch(journey: Journey) -> None:
    journey.live(120)
    succeeded(journey.client.call('~/rewind'))
    journey.tick(60)
    succeeded(journey.client.call('~/pause'))
    now = journey.physsim.node.simulation.step * STEP

    events = journey.client.ask('~/spawn', disc('new/0', at=(0.0, 9.0)))

    told = [(each.name, each.level) for each in events]
    assert told[-2:] == [('~/spawn', 0), ('branch', 0)]
    assert 'new/0' in journey.physsim.names
    assert journey.seek(now + PERIOD).code == 'out_of_history'
    # The past is as it was.
    journey.shown()
    for stamp in sorted(journey.first)[:50:7]:
        journey.seek(stamp)
    journey.compare(journey.shown(), 8)


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


def test_no_history_is_a_world_without_a_past(journey: Journey) -> None:
    set_parameter(journey.physsim, 'history', 0.0)
    journey.live(100)

    succeeded(journey.client.call('~/rewind'))
    journey.tick(5)

    assert {stamp for stamp, _ in journey.shown()} <= {journey.end}
    assert parameter(journey.physsim, 'speed') == 0.0
    journey.physsim.step(10)
    assert seconds(journey.end) + 10 / 60 == pytest.approx(journey.physsim.time)
