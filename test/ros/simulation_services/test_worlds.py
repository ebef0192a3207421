# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Worlds by the standard services: listed, loaded, reset and unloaded."""

from __future__ import annotations

from pathlib import Path
from threading import get_ident

from physsim_ros.files import title_of
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.ros import time_control, world_files
from physsim_ros.simulation.world import Beginning, beginning_of
from physsim_ros.testing import disc
import pytest

from .caller import (
    Caller,
    INCORRECT_STATE,
    names_in,
    NOT_FOUND,
    OK,
    UNSUPPORTED,
)
from ...client import set_parameter

pytestmark = pytest.mark.slow


def test_worlds_are_listed_and_loaded(caller: Caller) -> None:
    from simulation_interfaces.msg import TagsFilter  # noqa: PLC0415

    assert caller.code('GetCurrentWorld') == 101
    listed = {each.world_resource.uri: each for each in caller('GetAvailableWorlds').worlds}
    assert {'corridor', 'maze', 'demo'} <= set(listed)
    assert listed['corridor'].description
    own = caller('GetAvailableWorlds', filter=TagsFilter(tags=['own']))
    assert list(own.worlds) == []
    set_parameter(caller.physsim, 'speed', 1.0)
    answer = caller('LoadWorld', uri='maze')
    assert (answer.result.result, answer.world.name) == (OK, 'maze')
    assert answer.world.world_resource.uri == 'maze'
    assert caller('GetCurrentWorld').world.world_resource.uri == 'maze'
    assert caller('GetSimulationState').state.state == 0
    names = names_in(caller.physsim)
    for fields, result in (
        ({}, 102),
        ({'uri': 'nowhere'}, NOT_FOUND),
        ({'uri': '../../etc/passwd'}, NOT_FOUND),
        ({'uri': 'world.sdf'}, 101),
        ({'resource_string': 'format: 1'}, UNSUPPORTED),
    ):
        assert caller.code('LoadWorld', **fields) == result
    assert names_in(caller.physsim) == names
    assert caller('GetCurrentWorld').world.world_resource.uri == 'maze'


def test_the_current_world_is_the_file_that_was_loaded(
    caller: Caller, monkeypatch: pytest.MonkeyPatch
) -> None:
    from physsim_ros.ros.simulation_services import worlds  # noqa: PLC0415

    titles: list[Path] = []
    monkeypatch.setattr(worlds, 'title_of', lambda path: titles.append(path) or title_of(path))
    files = caller.physsim.node.world_files
    world = '# {}.\nformat: 1\nbodies:\n- {{name: {}/0, circle: {{radius: 0.5}}}}\n'
    for path in (
        files.directory / 'sub' / 'demo.yaml',
        files.directory / 'mine.yaml',
        files.lessons / 'corridor.yaml',
    ):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(world.format(f'The {path.stem}', path.stem))
    for uri, names, description in (
        ('sub/demo.yaml', ('demo/0',), ''),
        ('mine', ('mine/0',), 'The mine'),
        ('mine.yaml', ('mine/0',), 'The mine'),
        ('corridor', ('corridor/0',), 'The corridor'),
    ):
        loaded = caller('LoadWorld', uri=uri).world
        assert names_in(caller.physsim) == names
        titles.clear()
        current = caller('GetCurrentWorld').world
        assert (current, current.description) == (loaded, description)
        # No file is opened but its own.
        assert len(titles) <= 1
        # It is the world that its uri loads, which the list has, too.
        assert caller.code('LoadWorld', uri=current.world_resource.uri) == OK
        assert names_in(caller.physsim) == names
        listed = [each for each in caller('GetAvailableWorlds').worlds if each == current]
        assert len(listed) == bool(description)


def test_sources_of_worlds_that_are_unknown_are_refused_or_told(caller: Caller) -> None:
    refused = caller('GetAvailableWorlds', additional_sources=['https://worlds.example'])
    assert refused.result.result == UNSUPPORTED
    assert list(refused.worlds) == []
    listed = caller(
        'GetAvailableWorlds', additional_sources=['https://worlds.example'], continue_on_error=True
    )
    assert listed.result.result == OK
    assert 'https://worlds.example' in listed.result.error_message
    assert listed.worlds
    # The directory of own worlds is a file.
    caller.world_dir.rmdir()
    caller.world_dir.touch()
    assert caller.code('GetAvailableWorlds') == 101
    assert caller.code('GetAvailableWorlds', continue_on_error=True) == OK


def test_a_world_is_unloaded(caller: Caller) -> None:
    from simulation_interfaces.msg import SpawnEntity  # noqa: PLC0415

    stopped, playing, _, no_world = 0, 1, 2, 4
    assert caller.code('LoadWorld', uri='maze') == OK
    caller.physsim.run(0.5)
    assert caller.code('UnloadWorld') == OK
    assert names_in(caller.physsim) == ()
    assert caller('GetSimulationState').state.state == no_world
    assert caller.code('UnloadWorld') == 101
    assert caller.code('GetCurrentWorld') == 101
    for state in (stopped, playing):
        assert caller.code('SetSimulationState', state__state=state) == 103
    for service, fields in (
        ('SpawnEntity', {'name': 'a/0', 'uri': 'disc'}),
        ('SpawnEntities', {'spawn_requests': [SpawnEntity(name='a/0')]}),
        ('StepSimulation', {'steps': 1}),
        ('ResetSimulation', {}),
    ):
        assert caller.code(service, **fields) == INCORRECT_STATE
    assert names_in(caller.physsim) == ()
    assert caller.code('LoadWorld', uri='corridor') == OK
    assert caller('GetSimulationState').state.state == stopped
    # By topics of the node an empty world is one.
    assert caller.code('UnloadWorld') == OK
    caller.physsim.spawn(disc('a/0'))
    assert caller('GetSimulationState').state.state == stopped


def test_a_reset_has_scopes(caller: Caller) -> None:
    physsim = caller.physsim
    assert caller.code('LoadWorld', uri='corridor') == OK
    loaded = set(names_in(physsim))
    caller('SpawnEntity', name='mine/0', uri='disc')
    physsim.run(0.5)
    time, spawned, all_of_it = 1, 4, 255
    assert caller.code('ResetSimulation', scope=time) == UNSUPPORTED
    assert 'mine/0' in physsim.names
    assert caller.code('ResetSimulation', scope=spawned) == OK
    simulation = physsim.node.simulation
    assert set(names_in(physsim)) == loaded
    assert simulation.step > 0
    assert caller.code('ResetSimulation', scope=all_of_it) == OK
    assert simulation.step == 0


def test_no_service_builds_a_world_on_the_thread_of_time(
    caller: Caller, monkeypatch: pytest.MonkeyPatch
) -> None:
    threads: list[int] = []

    def build(state: WorldState, physics_rate: float) -> Beginning:
        threads.append(get_ident())
        return beginning_of(state, physics_rate)

    for module in (time_control, world_files):
        monkeypatch.setattr(module, 'beginning_of', build)
    stopped, playing, spawned_and_state = 0, 1, 6
    calls = (
        ('LoadWorld', {'uri': 'corridor'}, 2),
        ('SetSimulationState', {'state__state': playing}, 0),
        ('SetSimulationState', {'state__state': stopped}, 1),
        ('ResetSimulation', {}, 1),
        ('ResetSimulation', {'scope': spawned_and_state}, 1),
        ('UnloadWorld', {}, 1),
    )
    for service, fields, count in calls:
        threads.clear()
        assert caller.code(service, **fields) == OK
        assert len(threads) == count, service
        assert get_ident() not in threads
