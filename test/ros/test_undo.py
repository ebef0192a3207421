# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Undo, redo and reset over ROS lead to the moments that they name, to the bit."""

from __future__ import annotations

from pathlib import Path

from physsim_ros.testing import box, command, delete, disc, Refused
import pytest
from visualization_msgs.msg import MarkerArray

from .journey import (
    failed,
    Journey,
    parameter,
    PERIOD,
    SECOND,
    succeeded,
)
from ..client import set_parameter
from ..outside import Outside

# Undo, redo


def test_undo_goes_back_to_the_moment_before_the_last_request(journey: Journey) -> None:
    journey.live(60)
    physsim, before = journey.physsim, journey.physsim.digest()
    names, time = physsim.names, physsim.time
    physsim.spawn(disc('new/0', at=(0.0, 9.0)))
    journey.run(30)

    message = succeeded(journey.client.call('~/undo'))

    assert 'new/0' in message
    assert f'{time:.3f}' in message
    assert physsim.names == names
    assert physsim.time == time
    assert physsim.digest() == before


def test_redo_returns_to_where_undo_was_asked_for(journey: Journey) -> None:
    journey.live(60)
    physsim = journey.physsim
    physsim.spawn(disc('new/0', at=(0.0, 9.0)))
    journey.run(30)
    asked, time = physsim.digest(), physsim.time
    succeeded(journey.client.call('~/undo'))
    physsim.step(7)

    message = succeeded(journey.client.call('~/redo'))

    assert f'{time:.3f}' in message
    assert physsim.digest() == asked
    # All of what was cut off is there again.
    journey.shown()
    journey.seek(0.0)
    journey.shown()
    physsim.step(round(journey.end / PERIOD))
    journey.compare(journey.shown(), 85)


def test_redo_in_the_past_returns_to_the_past_and_to_what_lay_ahead(journey: Journey) -> None:
    journey.live(60)
    physsim = journey.physsim
    physsim.spawn(disc('new/0', at=(0.0, 9.0)))
    journey.run(60)
    journey.seek(1.5 * SECOND)
    asked = physsim.digest()

    succeeded(journey.client.call('~/undo'))
    assert journey.seek(1.5 * SECOND).code == 'out_of_history'
    succeeded(journey.client.call('~/redo'))

    assert physsim.digest() == asked
    journey.shown()
    assert journey.seek(journey.end).code == 'ok'
    journey.compare(journey.shown(), 1)


def test_many_requests_are_undone_one_by_one_and_redone(journey: Journey) -> None:
    physsim, call = journey.physsim, journey.client.call
    journey.pause()
    digests = [physsim.digest()]
    for number in range(5):
        physsim.spawn(disc(f'a/{number}', at=(2.0 * number, 1.0)))
        physsim.step(20 * (number % 2))
        digests.append(physsim.digest())

    undone = []
    for _ in range(5):
        succeeded(call('~/undo'))
        undone.append(len(physsim.names))
    assert failed(call('~/undo')).startswith('out_of_history: ')
    assert undone == [4, 3, 2, 1, 0]
    redone = []
    for _ in range(5):
        succeeded(call('~/redo'))
        redone.append(physsim.digest())

    assert failed(call('~/redo')).startswith('out_of_history: ')
    # Redo returns to where undo was asked for: the moments before the next request.
    assert [digest in digests for digest in redone] == [True] * 5
    assert redone[-1] == digests[-1]


def test_an_array_is_undone_whole(journey: Journey) -> None:
    journey.live(30)
    physsim, before = journey.physsim, journey.physsim.digest()
    physsim.spawn(MarkerArray(markers=[disc(f'new/{each}', at=(each, 9)) for each in range(3)]))
    after = physsim.digest()

    message = succeeded(journey.client.call('~/undo'))

    assert physsim.digest() == before, message
    succeeded(journey.client.call('~/redo'))
    assert physsim.digest() == after


@pytest.mark.parametrize('bad', [0, 1, 2])
def test_what_is_refused_in_an_array_joins_it_to_nothing_else(journey: Journey, bad: int) -> None:
    physsim = journey.physsim
    physsim.spawn(disc('alone/0', at=(-3.0, 1.0)))
    before = physsim.digest()
    markers = [disc(f'new/{each}', at=(each, 9), diameter=1.0) for each in range(3)]
    markers[bad].type = 99
    with pytest.raises(Refused):
        physsim.spawn(MarkerArray(markers=markers))
    assert len(physsim.names) == 3

    succeeded(journey.client.call('~/undo'))

    assert physsim.digest() == before


def test_two_arrays_are_undone_one_after_the_other(journey: Journey) -> None:
    physsim = journey.physsim
    for namespace in ('a', 'b'):
        array = MarkerArray(markers=[disc(f'{namespace}/{each}') for each in range(2)])
        journey.client.publish('~/spawn_array', array)
    journey.tick()
    assert len(physsim.names) == 4

    succeeded(journey.client.call('~/undo'))

    assert physsim.names == ('a/0', 'a/1')


def test_a_new_request_makes_redo_impossible(journey: Journey) -> None:
    physsim = journey.physsim
    physsim.spawn(disc('a/0'))
    succeeded(journey.client.call('~/undo'))
    physsim.spawn(disc('b/0'))
    before = physsim.digest()

    assert failed(journey.client.call('~/redo')).startswith('out_of_history: ')

    assert physsim.digest() == before


def test_a_refused_request_leaves_redo_possible(journey: Journey) -> None:
    physsim = journey.physsim
    physsim.spawn(disc('a/0'))
    succeeded(journey.client.call('~/undo'))
    with pytest.raises(Refused):
        physsim.spawn(delete('nobody/0'))

    succeeded(journey.client.call('~/redo'))

    assert physsim.names == ('a/0',)


def test_undo_and_redo_of_nothing_are_refused_and_change_nothing(journey: Journey) -> None:
    journey.physsim.step(10)
    before = journey.physsim.digest()

    for service in ('~/undo', '~/redo'):
        assert failed(journey.client.call(service)).startswith('out_of_history: ')

    assert journey.physsim.digest() == before
    assert journey.physsim.time == pytest.approx(10 / 60)


@pytest.mark.parametrize('what', ['clear', 'load_world', 'gravity', 'anchor', 'command', 'change'])
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
        case 'anchor':
            physsim.anchor(physsim.pose('it/0')[:2])
        case 'command':
            physsim.command(command('it/0', twists=[(1.0, 2.0, 3.0)]))
        case 'change':
            physsim.spawn(box('it/0', at=(0.0, 9.0)))
    journey.run(10)
    after = physsim.digest()
    assert after != before

    succeeded(journey.client.call('~/undo'))
    assert physsim.digest() == before
    assert parameter(physsim, 'gravity') == gravity
    succeeded(journey.client.call('~/redo'))

    assert physsim.digest() == after


# Reset


def test_a_reset_is_undone_and_redone(journey: Journey) -> None:
    journey.live(100)
    physsim = journey.physsim
    set_parameter(physsim, 'gravity', [1.0, 2.0])
    journey.run(10)
    before, time = physsim.digest(), physsim.time

    succeeded(journey.client.call('~/reset'))
    assert (physsim.time, physsim.names) == (0.0, ())
    assert parameter(physsim, 'gravity') == [0.0, -9.81]
    succeeded(journey.client.call('~/undo'))

    assert (physsim.digest(), physsim.time) == (before, time)
    assert parameter(physsim, 'gravity') == [1.0, 2.0]
    # Its past is there again.
    journey.shown()
    journey.seek(SECOND)
    journey.compare(journey.shown(), 1)
    journey.seek(journey.end)
    succeeded(journey.client.call('~/redo'))
    assert (physsim.time, physsim.names) == (0.0, ())


def test_a_reset_in_the_past_is_undone_to_there(journey: Journey) -> None:
    journey.live(60)
    journey.seek(0.5 * SECOND)
    before = journey.physsim.digest()

    succeeded(journey.client.call('~/reset'))
    succeeded(journey.client.call('~/undo'))

    assert journey.physsim.digest() == before
    assert journey.seek(journey.end).code == 'ok'


def test_what_is_done_after_a_reset_is_undone_before_it(journey: Journey) -> None:
    journey.live(40)
    physsim, before = journey.physsim, journey.physsim.digest()
    succeeded(journey.client.call('~/reset'))
    physsim.spawn(disc('new/0'))
    physsim.step(10)

    assert 'new/0' in succeeded(journey.client.call('~/undo'))
    assert (physsim.time, physsim.names) == (0.0, ())
    assert 'reset' in succeeded(journey.client.call('~/undo'))

    assert physsim.digest() == before


def test_there_is_nothing_before_or_ahead_of_a_reset(journey: Journey) -> None:
    journey.live(40)

    succeeded(journey.client.call('~/reset'))

    assert journey.seek(PERIOD).code == 'out_of_history'
    succeeded(journey.client.call('~/rewind'))
    assert {stamp for stamp, _ in journey.tick(4)} <= {0}


# Worlds that are saved


def test_a_saved_world_goes_on_in_another_process_as_it_does_here(
    journey: Journey, outside: Outside, tmp_path: Path
) -> None:
    journey.live(100)
    journey.run(80)
    set_parameter(journey.physsim, 'world_file', 'mine')
    succeeded(journey.client.call('~/save_world'))
    journey.shown()

    journey.physsim.step(240)
    here = journey.shown()
    with outside.start_world(world_file=tmp_path / 'mine.yaml', speed=0.0) as world:
        world.wait_for('ready')
        there = outside.run_program('rewinder', 'step', 240)['frames']
        assert world.interrupt() == 0

    assert len(here) == len(there) == 240
    assert [one == other for (_, one), (_, other) in zip(here, there, strict=True)] == [True] * 240


def test_saving_changes_nothing_of_what_is_shown_again(journey: Journey) -> None:
    journey.live(60)
    set_parameter(journey.physsim, 'world_file', 'mine')
    succeeded(journey.client.call('~/save_world'))
    journey.run(60)
    journey.seek(0.5 * SECOND)
    succeeded(journey.client.call('~/save_world'))
    journey.shown()

    journey.physsim.step(80)

    journey.compare(journey.shown(), 80)
    assert 'branch' not in [event.name for event in journey.client.events]


def test_a_load_can_be_rewound_through(journey: Journey) -> None:
    journey.live(60)
    set_parameter(journey.physsim, 'world_file', 'demo')
    bounds = parameter(journey.physsim, 'bounds')
    succeeded(journey.client.call('~/load_world'))
    journey.run(60)

    succeeded(journey.client.call('~/rewind'))
    back = journey.tick(100)
    assert parameter(journey.physsim, 'bounds') == bounds
    succeeded(journey.client.call('~/play'))
    on = journey.tick(80)

    journey.compare(back, 95)
    journey.compare(on, 75)


# Nothing twice


@pytest.mark.parametrize(
    'service', ['play', 'pause', 'rewind', 'fast_forward', 'fast_rewind', 'save_world']
)
def test_a_service_does_nothing_twice(journey: Journey, tmp_path: Path, service: str) -> None:
    journey.live(60)
    set_parameter(journey.physsim, 'world_file', 'mine')

    messages, digests, speeds = [], [], []
    for _ in range(2):
        messages.append(succeeded(journey.client.call(f'~/{service}')))
        digests.append(journey.physsim.digest())
        speeds.append(parameter(journey.physsim, 'speed'))
        files = [path.read_bytes() for path in tmp_path.iterdir()]

    assert messages[0] == messages[1]
    assert digests[0] == digests[1]
    assert speeds[0] == speeds[1]
    assert len(files) == (service == 'save_world')
    assert journey.seek(journey.end).code == 'ok'


def test_a_reset_after_a_reset_leaves_the_first_to_be_undone(journey: Journey) -> None:
    journey.live(60)
    before = journey.physsim.digest()

    succeeded(journey.client.call('~/reset'))
    succeeded(journey.client.call('~/reset'))
    succeeded(journey.client.call('~/undo'))

    assert journey.physsim.digest() == before


def test_a_clear_after_a_clear_leaves_the_first_to_be_undone(journey: Journey) -> None:
    journey.live(60)
    before = journey.physsim.digest()

    succeeded(journey.client.call('~/clear'))
    succeeded(journey.client.call('~/clear'))
    succeeded(journey.client.call('~/undo'))

    assert journey.physsim.digest() == before
