# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Undo, redo and reset over ROS lead to the moments that they name, to the bit."""

from __future__ import annotations

from pathlib import Path

from physsim_ros.testing import disc, Refused
import pytest
from visualization_msgs.msg import MarkerArray

from .journey import (
    failed,
    Journey,
    parameter,
    SECOND,
    succeeded,
)
from ..client import set_parameter

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


def test_an_array_is_undone_whole(journey: Journey) -> None:
    journey.live(30)
    physsim, before = journey.physsim, journey.physsim.digest()
    physsim.spawn(MarkerArray(markers=[disc(f'new/{each}', at=(each, 9)) for each in range(3)]))
    after = physsim.digest()

    message = succeeded(journey.client.call('~/undo'))

    assert physsim.digest() == before, message
    succeeded(journey.client.call('~/redo'))
    assert physsim.digest() == after


@pytest.mark.parametrize('bad', [0, 2])
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


def test_undo_and_redo_of_nothing_are_refused_and_change_nothing(journey: Journey) -> None:
    journey.physsim.step(10)
    before = journey.physsim.digest()

    for service in ('~/undo', '~/redo'):
        assert failed(journey.client.call(service)).startswith('out_of_history: ')

    assert journey.physsim.digest() == before
    assert journey.physsim.time == pytest.approx(10 / 60)


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
