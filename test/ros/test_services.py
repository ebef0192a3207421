# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Services do what their names say, say what they did, and do nothing twice."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from physsim_ros.testing import disc, PhysSim
import pytest
from rcl_interfaces.srv import SetParameters
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

from .journey import begin_seek, Journey
from ..client import (
    Client,
    Event,
    failed,
    message_of,
    parameter,
    set_parameter,
    succeeded,
)


def steps_after(journey: Journey, frames: int) -> list[int]:
    """Let frames go by, and return the number of steps of the world after each."""
    steps = []
    for _ in range(frames):
        journey.tick()
        steps.append(journey.physsim.node.simulation.world.step_count)
    return steps


# Play, pause; steps are in `test_timeline.py`


def test_pause_stops_time_and_play_lets_it_run_at_speed_1(
    journey: Journey, client: Client
) -> None:
    set_parameter(journey.physsim, 'speed', 4.0)
    assert steps_after(journey, 3)[-1] > 0
    succeeded(client.call('~/pause'))
    assert parameter(journey.physsim, 'speed') == 0.0
    assert len(set(steps_after(journey, 10))) == 1
    succeeded(client.call('~/play'))
    assert parameter(journey.physsim, 'speed') == 1.0
    steps_after(journey, 1)
    steps = steps_after(journey, 10)
    assert [after - before for before, after in pairwise(steps)] == [4] * 9


# Speed


@pytest.mark.parametrize('speed', [0.25, 64.0])
def test_time_runs_at_the_speed_that_is_set(
    journey: Journey, client: Client, speed: float
) -> None:
    (event,) = client.ask('~/speed', Float64(data=speed))
    assert event == Event(0, '~/speed', '', event.message, 'ok', '')
    assert parameter(journey.physsim, 'speed') == speed
    steps_after(journey, 1)
    steps = steps_after(journey, 60)
    # steps: a second of wall time, to a frame
    assert steps[-1] - steps[0] == pytest.approx(59 * 4 * speed, abs=4 * max(1.0, speed))
    if speed.is_integer():
        assert all(step % 4 == 0 for step in steps)


# Save, load


def test_a_world_is_loaded_by_the_path_of_its_file(
    physsim: PhysSim, client: Client, tmp_path: Path
) -> None:
    (tmp_path / 'below').mkdir()
    path = tmp_path / 'below' / 'one.yaml'
    path.write_text('format: 1\nbodies: [{name: a/0, circle: {radius: 1}}]\n')
    for name in ('below/one.yaml', str(path)):
        set_parameter(physsim, 'world_file', name)
        succeeded(client.call('~/load_world'))
        assert physsim.names == ('a/0',)
        succeeded(client.call('~/clear'))


# What else is refused: `test/files/test_world_file_refusals.py`.
BAD = {
    'no YAML': 'bodies: [',
    'a good one first': 'format: 1\nbodies: [{name: a/0, circle: {radius: 1}}, {name: b/0}]',
}


@pytest.mark.parametrize('what', BAD)
def test_a_bad_world_file_is_refused_and_changes_nothing(
    physsim: PhysSim, client: Client, tmp_path: Path, what: str
) -> None:
    physsim.spawn(disc('a/0', at=(0.0, 5.0)))
    (tmp_path / 'bad.yaml').write_text(BAD[what])
    set_parameter(physsim, 'world_file', 'bad')
    before = physsim.digest()
    message = failed(client.call('~/load_world'))
    assert message.startswith('bad_world_file: ')
    assert 'bad.yaml' in message
    assert '\n' not in message
    assert physsim.digest() == before


def test_a_peer_is_not_told_what_a_refused_file_holds(
    physsim: PhysSim, client: Client, tmp_path: Path
) -> None:
    for text, place in (
        ('format: 1\npassword: hunter2', 'line 2'),
        ('format: 1\ndamping: hunter2', 'line 2'),
        ('format: 1\nbodies:\n  - {name: hunter2/0, circle: {radius: hunter2}}', 'line 3'),
        ('format: 1\nbodies:\n  - {name: a/0, hunter2: 1}', 'line 3'),
        ('hunter2: 1\nhunter2: 1', 'line 2'),
        ('format: 1\n\nhunter2: !hunter2 1', 'line 3'),
        ('hunter2', ''),
    ):
        (tmp_path / 'w.yaml').write_text(text)
        set_parameter(physsim, 'world_file', 'w')
        message = failed(client.call('~/load_world'))
        assert message.startswith('bad_world_file: w.yaml')
        assert place in message
        assert 'hunter2' not in message


@pytest.mark.parametrize('waits', [False, True])
def test_a_service_that_needs_the_world_waits_for_the_end_of_a_seek_and_replies_then(
    physsim: PhysSim, client: Client, monkeypatch: pytest.MonkeyPatch, *, waits: bool
) -> None:
    simulation = physsim.node.simulation
    client.ask('~/spawn', disc('disc/0', at=(0.0, 5.0)))
    client.ask('~/spawn', disc('disc/1', at=(3.0, 5.0)))
    clear, pause = (client.service(Trigger, f'~/{name}') for name in ('clear', 'pause'))
    begin_seek(physsim, monkeypatch)
    if not waits:
        assert not simulation.applier.apply_ready()
    cleared, paused = clear.call_async(Trigger.Request()), pause.call_async(Trigger.Request())
    physsim.settle()
    assert not simulation.applier.apply_ready()
    client.spin_until(paused.done)
    assert not cleared.done()
    physsim.node.loop.apply_requests()
    client.spin_until(cleared.done)
    assert succeeded(cleared.result()) == 'deleted 2 bodies'
    assert simulation.world.stamp == 500_000_000
    assert len(simulation.world) == 0


def test_a_world_that_waits_to_be_loaded_is_that_which_was_named_before(
    physsim: PhysSim, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    physsim.spawn(disc('first/0', at=(0.0, 5.0)))
    set_parameter(physsim, 'world_file', 'first')
    succeeded(client.call('~/save_world'))
    load = client.service(Trigger, '~/load_world')
    name = client.service(SetParameters, '~/set_parameters')
    begin_seek(physsim, monkeypatch)
    assert not physsim.node.simulation.applier.apply_ready()
    loaded = load.call_async(Trigger.Request())
    physsim.settle()
    second = message_of('world_file', 'second')
    named = name.call_async(SetParameters.Request(parameters=[second]))
    physsim.settle()
    assert not loaded.done()
    physsim.node.loop.apply_requests()
    client.spin_until(lambda: loaded.done() and named.done())
    assert 'first.yaml' in succeeded(loaded.result())
    assert parameter(physsim, 'world_file') == 'second'


@pytest.mark.parametrize(
    ('name', 'value'), [('gravity', [0.0, -1.0]), ('history', 300.0), ('tool', 'anchor')]
)
def test_a_parameter_waits_for_the_end_of_a_seek_where_the_world_has_it(
    physsim: PhysSim, client: Client, monkeypatch: pytest.MonkeyPatch, name: str, value: object
) -> None:
    service = client.service(SetParameters, '~/set_parameters')
    begin_seek(physsim, monkeypatch)
    assert not physsim.node.simulation.applier.apply_ready()
    named = service.call_async(SetParameters.Request(parameters=[message_of(name, value)]))
    physsim.settle()
    physsim.settle()
    assert not physsim.node.simulation.applier.apply_ready()
    assert named.done() is (name == 'tool')
    physsim.node.loop.apply_requests()
    client.spin_until(named.done)
    assert parameter(physsim, name) == value


def test_an_undo_is_answered_though_its_replay_is_long_and_time_does_not_go_on(
    physsim: PhysSim, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Here no replay is so short that a service finishes it at once.
    monkeypatch.setattr('physsim_ros.ros.frame_loop.MOST_TICK_NS', -1)
    client.ask('~/spawn', disc('disc/0', at=(0.0, 5.0)))
    physsim.run(2.0)
    client.ask('~/spawn', disc('disc/1', at=(3.0, 5.0)))
    physsim.run(1.0)
    digest = physsim.digest()
    assert 'back at 2.000 s' in succeeded(client.call('~/undo'))
    assert len(physsim.node.simulation.world) == 1
    assert 'at 3.000 s' in succeeded(client.call('~/redo'))
    assert physsim.digest() == digest
