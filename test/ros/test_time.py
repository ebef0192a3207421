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
    succeeded,
)
from ..client import set_parameter

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
