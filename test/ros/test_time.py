# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Time goes back and on over ROS, and all that is shown again is so to the bit."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from physsim_ros.testing import disc, PhysSim, Refused
import pytest
from rclpy.node import Node
from std_msgs.msg import Float64

from .journey import (
    Journey,
    parameter,
    PERIOD,
    SECOND,
    seconds,
    STEP,
    succeeded,
)
from ..client import set_parameter
from ..outside import Outside

# Back, and on again


@pytest.mark.parametrize(
    ('ask', 'speed', 'known'),
    [('~/fast_rewind', -4.0, 90), (-0.5, -0.5, 40)],
)
def test_what_is_shown_going_back_is_what_was_shown_first(
    journey: Journey, ask: str | float, speed: float, known: int
) -> None:
    journey.live(200)
    if isinstance(ask, str):
        succeeded(journey.client.call(ask))
    else:
        journey.client.ask('~/speed', Float64(data=ask))

    journey.tick()
    before = len(journey.clocks)
    frames = journey.tick(round(known / max(1.0, -speed)))

    assert parameter(journey.physsim, 'speed') == speed
    stamps = [stamp for stamp, _ in frames]
    back = [before - after for before, after in pairwise(stamps)]
    # To a nanosecond or two; half a speed is two steps a frame.
    assert back == pytest.approx([-speed * PERIOD] * len(back), abs=2.0)
    clocks = [each.clock.sec * SECOND + each.clock.nanosec for each in journey.clocks[before:]]
    assert clocks == stamps
    journey.compare(frames, round(0.5 * known / max(1.0, -speed)) - 2)


def test_fast_forward_has_the_speed_that_is_set_and_the_same_bits(journey: Journey) -> None:
    journey.live(120)
    journey.seek(0.0)
    set_parameter(journey.physsim, 'fast_speed', 3.0)

    succeeded(journey.client.call('~/fast_forward'))
    journey.tick()
    frames = journey.tick(30)

    assert parameter(journey.physsim, 'speed') == 3.0
    on = [after - before for (before, _), (after, _) in pairwise(frames)]
    assert on == pytest.approx([3 * PERIOD] * len(on), abs=2.0)
    journey.compare(frames, 29)


# Parameters follow the time


def test_parameters_are_what_they_were_then(journey: Journey) -> None:
    journey.pause()
    physsim = journey.physsim
    values = {
        'gravity': [[0.0, -9.81], [1.0, -2.0], [0.0, 5.0]],
        'damping': [0.0, 0.1, 0.2],
        'iterations': [10, 11, 12],
        'bounds': [[], [-4.0, 0.0, 4.0, 8.0], [-5.0, -1.0, 5.0, 9.0]],
        'density': [1.0, 2.0, 3.0],
        'friction': [0.5, 0.6, 0.7],
    }
    for number in range(3):
        for name, these in values.items():
            set_parameter(physsim, name, these[number])
        physsim.step(60)

    def now() -> dict[str, Any]:
        return {name: parameter(physsim, name) for name in values}

    for number in (2, 0, 1, 2, 1, 0):
        journey.seek((number + 0.5) * SECOND)
        assert now() == {name: these[number] for name, these in values.items()}
    succeeded(journey.client.call('~/play'))
    for number in (0, 1, 2):
        journey.tick(20)
        assert now() == {name: these[number] for name, these in values.items()}
        journey.tick(40)
    journey.client.ask('~/speed', Float64(data=-3.0))
    for number in (2, 1, 0):
        journey.tick(20)
        assert now() == {name: these[number] for name, these in values.items()}
    assert all(
        event.name in {'~/seek', '~/speed', '~/play', '~/pause', 'history'}
        for event in journey.client.events
    )


def test_parameters_that_are_not_the_worlds_stay(journey: Journey) -> None:
    journey.live(30)
    for name, value in {'fast_speed': 7.0, 'history': 300.0, 'world_file': 'demo'}.items():
        set_parameter(journey.physsim, name, value)

    journey.seek(0.0)
    journey.tick()

    assert parameter(journey.physsim, 'fast_speed') == 7.0
    assert parameter(journey.physsim, 'history') == 300.0
    assert parameter(journey.physsim, 'world_file') == 'demo'


# In other people's tests


def test_seek_in_a_test_goes_to_a_time_and_on_from_there(physsim: PhysSim) -> None:
    physsim.load('demo')
    physsim.run(1.0)
    at_one = physsim.digest()
    physsim.run(2.0)
    at_three = physsim.digest()

    physsim.seek(1.0)
    assert physsim.time == 1.0
    assert physsim.digest() == at_one
    physsim.run(2.0)
    assert physsim.digest() == at_three
    physsim.seek(0.0)

    physsim.until(lambda: physsim.time >= 3.0)
    assert physsim.digest() == at_three


def test_seek_in_a_test_raises_what_is_refused(physsim: PhysSim) -> None:
    physsim.spawn(disc(at=(0.0, 5.0)))
    physsim.run(1.0)
    before = physsim.digest()

    with pytest.raises(Refused) as refused:
        physsim.seek(1.5)

    assert (refused.value.code, refused.value.field) == ('out_of_history', 'clock')
    assert (physsim.digest(), physsim.time) == (before, 1.0)


def test_after_a_seek_other_nodes_have_the_time_and_the_parameters_of_then(
    physsim: PhysSim,
) -> None:
    robot = Node('robot', context=physsim.context)
    physsim.add(robot)
    physsim.run(1.0)
    set_parameter(physsim, 'gravity', [0.0, 0.0])
    physsim.run(1.0)

    physsim.seek(0.5)

    assert seconds(robot.get_clock().now().nanoseconds) == pytest.approx(0.5)
    assert parameter(physsim, 'gravity') == [0.0, -9.81]
    physsim.run(1.0)
    assert seconds(robot.get_clock().now().nanoseconds) == pytest.approx(1.5)
    assert parameter(physsim, 'gravity') == [0.0, 0.0]


# From a process that knows nothing of the package


@pytest.mark.parametrize('seed', [1])
def test_somebody_elsewhere_travels_through_time(outside: Outside, seed: int) -> None:
    with outside.start_world(speed=0.0) as world:
        world.wait_for('ready')
        seen = outside.run_program('rewinder', seed)
        assert world.interrupt() == 0
        assert 'Traceback' not in ''.join(world.lines)

    # As JSON has it, keys are words.
    first = {int(stamp): bits for stamp, bits in seen['first'].items()}
    assert len(first) > 200, 'the machine is too slow to see enough'
    assert seen['most'] > 10
    assert seen['answered'] == seen['asked'] > 70
    assert seen['refused'] < seen['asked'] / 4

    def different(frames: list[list[Any]]) -> list[int]:
        return [stamp for stamp, bits in frames if first.get(stamp, bits) != bits]

    def known(frames: list[list[Any]]) -> int:
        return sum(stamp in first for stamp, _ in frames)

    passes = seen['passes']
    assert {what: different(frames) for what, frames in passes.items()} == {
        what: [] for what in passes
    }
    assert {what for what, frames in passes.items() if not known(frames)} == set()
    for what in ('rewind', 'speed -0.5', 'fast_rewind', 'speed -8', 'to the oldest'):
        stamps = [stamp for stamp, _ in passes[what]]
        assert stamps == sorted(set(stamps), reverse=True), what
    assert all(seen['clocks'])
    falls = sum(after < before for before, after in pairwise(seen['clocks']))
    assert falls > 60
    assert [success for success, _ in seen['twice']] == [True, True]
    assert seen['step while rewinding'][0] is False

    ((level, message),) = seen['stopped']
    assert (level, seen['speed then']) == (0, 0.0)
    assert 'oldest' in message
    assert passes['to the oldest'][-1][0] == 0
    assert seen['settings at the oldest']['gravity'] == seen['original']['gravity']
    assert seen['settings'] != seen['original']

    assert different(seen['all again']) == []
    assert known(seen['all again']) > 100
    assert seen['settings again'] == seen['settings']

    for stamp, (code, message, _), (after, bits) in seen['seeks']:
        assert code == 'ok', message
        assert 0 < after - stamp < PERIOD + STEP
        assert first.get(after, bits) == bits
    for code, message, field in seen['seeks to nowhere']:
        assert (code, field) == ('out_of_history', 'clock'), message
    assert different([seen['a step after them']]) == []

    assert 'branch' in seen['branch']
    assert seen['seek to what is dropped'][0] == 'out_of_history'
    middle = seen['middle']
    assert seen['other'][0] == pytest.approx(middle + PERIOD, abs=2)
    assert seen['undo'][0], seen['undo']
    assert 'other/0' in seen['undo'][1]
    # The steps ahead of it are gone, but not the moment itself.
    assert seen['after undo'] == [middle, first.get(middle, seen['after undo'][1])]
    assert seen['redo'][0], seen['redo']
    assert seen['after redo'] == seen['other']
