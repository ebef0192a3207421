# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Time goes back and on over ROS: all that is shown again is so to the bit, and can be undone."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
import math
from pathlib import Path
from typing import Any

from physsim_ros.testing import disc, PhysSim, Refused
import pytest
from rclpy.node import Node
from std_msgs.msg import Float64

from .journey import clock_of, Journey, PERIOD, SECOND
from ..client import Client, parameter, set_parameter, stamp_of, succeeded

# Back, and on again


@pytest.mark.parametrize(
    ('ask', 'speed', 'known'),
    [('~/fast_rewind', -3.0, 90), (-0.5, -0.5, 40), ('~/fast_forward', 3.0, 90)],
)
def test_what_is_shown_again_is_what_was_shown_first(
    journey: Journey, ask: str | float, speed: float, known: int
) -> None:
    journey.live(200)
    set_parameter(journey.physsim, 'fast_speed', 3.0)
    if speed > 0.0:
        journey.seek(0.0)
    if isinstance(ask, str):
        succeeded(journey.client.call(ask))
    else:
        journey.client.ask('~/speed', Float64(data=ask))

    journey.tick()
    before = len(journey.clocks)
    frames = journey.tick(round(known / max(1.0, abs(speed))))

    assert parameter(journey.physsim, 'speed') == speed
    stamps = [stamp for stamp, _ in frames]
    on = [after - before for before, after in pairwise(stamps)]
    # To a nanosecond or two; half a speed is two steps a frame.
    assert on == pytest.approx([speed * PERIOD] * len(on), abs=2.0)
    clocks = [stamp_of(each) for each in journey.clocks[before:]]
    assert clocks == stamps
    journey.compare(frames, round(0.5 * known / max(1.0, abs(speed))) - 2)


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


# In other people's tests


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

    assert robot.get_clock().now().nanoseconds * 1e-9 == pytest.approx(0.5)
    assert parameter(physsim, 'gravity') == [0.0, -9.81]
    physsim.run(1.0)
    assert robot.get_clock().now().nanoseconds * 1e-9 == pytest.approx(1.5)
    assert parameter(physsim, 'gravity') == [0.0, 0.0]


@pytest.mark.parametrize('at_start', [False, True])
def test_the_source_of_the_clock_never_reads_one(
    start: Callable[..., PhysSim], *, at_start: bool
) -> None:
    # Anybody may publish one, with seconds below 0, too.
    physsim = start(use_sim_time=at_start)
    set_parameter(physsim, 'use_sim_time', value=True)
    assert '/clock' not in {each.topic_name for each in physsim.node.subscriptions}
    assert physsim.node.get_clock().now().nanoseconds > 0


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


@pytest.mark.parametrize(
    ('topic', 'message'),
    [
        ('~/seek', clock_of(0)),
        ('~/speed', Float64(data=math.nan)),
    ],
)
def test_what_was_asked_before_is_answered_before(
    physsim: PhysSim, client: Client, topic: str, message: Any
) -> None:
    physsim.run(0.5)
    # Both ways are known before anything is asked.
    client.ask('~/spawn', disc('a/0'))
    client.ask(topic, message)
    client.events.clear()

    client.publish('~/spawn', disc('b/0'))
    physsim.settle()
    client.ask(topic, message)

    names = [event.name for event in client.events if event.name[:2] == '~/']
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


# Undo and redo: what lies behind them is in `test/simulation/test_undo.py`.


@pytest.mark.parametrize('what', ['clear', 'load_world', 'gravity'])
def test_whatever_changes_the_world_is_undone_and_redone(journey: Journey, what: str) -> None:
    journey.live(45)
    physsim = journey.physsim
    physsim.spawn(disc('it/0', at=(0.0, 9.0)))
    set_parameter(physsim, 'world_file', 'demo')
    journey.run(5)
    before, gravity = physsim.digest(), parameter(physsim, 'gravity')
    match what:
        case 'clear' | 'load_world':
            succeeded(journey.client.call(f'~/{what}'))
        case 'gravity':
            set_parameter(physsim, 'gravity', [7.0, 7.0])
    journey.run(10)
    after = physsim.digest()
    assert after != before

    succeeded(journey.client.call('~/undo'))
    assert physsim.digest() == before
    assert parameter(physsim, 'gravity') == gravity
    succeeded(journey.client.call('~/redo'))

    assert physsim.digest() == after


def test_a_service_does_nothing_twice(journey: Journey, tmp_path: Path) -> None:
    physsim, client = journey.physsim, journey.client
    journey.live(60)
    set_parameter(physsim, 'world_file', 'mine')

    def done() -> tuple[object, ...]:
        message = succeeded(client.call(f'~/{service}'))
        files = [path.read_bytes() for path in tmp_path.glob('*.yaml')]
        return message, physsim.digest(), parameter(physsim, 'speed'), files

    for service in ('play', 'pause', 'rewind', 'fast_forward', 'fast_rewind', 'save_world'):
        assert done() == done(), service
    # The second save keeps the file of the first.
    saved = [path.relative_to(tmp_path) for path in tmp_path.rglob('*.yaml')]
    assert sorted(saved) == [Path('.kept/mine.yaml'), Path('mine.yaml')]
    assert journey.seek(journey.end).code == 'ok'
