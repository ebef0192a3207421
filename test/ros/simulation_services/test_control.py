# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Features, time, end and errors of the simulator, by the standard services."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any

from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Disc
from physsim_ros.ros import frame_loop
from physsim_ros.ros.topics import CALLS
from physsim_ros.testing import disc, PhysSim
import pytest
from rclpy.action import ActionClient

from .caller import (
    Caller,
    names_in,
    OK,
    OPERATION_FAILED,
    UNSUPPORTED,
)
from ..journey import begin_seek
from ...client import set_parameter
from ...doors import fail

pytestmark = pytest.mark.slow


def simulate_steps(caller: Caller, steps: int) -> tuple[Any, list[tuple[int, int]]]:
    """Return the result of the action, and completed and remaining steps of its feedback."""
    from simulation_interfaces.action import SimulateSteps  # noqa: PLC0415

    client = ActionClient(caller.client.node, SimulateSteps, '/physsim/simulation/simulate_steps')
    caller.client.spin_until(client.server_is_ready)
    told: list[tuple[int, int]] = []
    sent = client.send_goal_async(
        SimulateSteps.Goal(steps=steps),
        lambda message: told.append(
            (message.feedback.completed_steps, message.feedback.remaining_steps)
        ),
    )
    caller.client.spin_until(sent.done)
    answered = sent.result().get_result_async()

    def is_done() -> bool:
        # The turn of the goal comes.
        caller.physsim.node.loop.apply_requests()
        return bool(answered.done())

    caller.client.spin_until(is_done)
    result = answered.result().result.result
    if result.result == OK:
        caller.client.spin_until(lambda: len(told) == steps)
    client.destroy()
    return result, told


def test_what_is_told_of_the_simulator_is_what_it_has(caller: Caller) -> None:
    from simulation_interfaces.msg import SimulatorFeatures  # noqa: PLC0415

    told = set(caller('GetSimulatorFeatures').features.features)
    constants = [getattr(SimulatorFeatures, each) for each in dir(SimulatorFeatures)]
    all_of_them = {each for each in constants if isinstance(each, int)}
    assert all_of_them - told == {
        SimulatorFeatures.ENTITY_BOUNDS_CONVEX,
        SimulatorFeatures.SIMULATION_RESET_TIME,
        SimulatorFeatures.SIMULATION_RESET_STATE,
        SimulatorFeatures.WORLD_RESOURCE_STRING,
    }
    spawnables = caller('GetSpawnables', sources=['elsewhere'])
    assert 'elsewhere' in spawnables.result.error_message
    uris = {each.uri for each in spawnables.spawnables}
    assert {'turtlebot3_burger', 'omni', 'disc', 'box'} <= uris
    # All of them can be spawned.
    for number, uri in enumerate(sorted(uris)):
        spawned = caller('SpawnEntity', name=f'some/{number}', uri=uri)
        assert (spawned.result.result, spawned.result.error_message) == (OK, '')
        assert spawned.entity_name == f'some/{number}'


def test_time_is_stopped_played_and_paused(caller: Caller) -> None:
    stopped, playing, paused, quitting, no_world, loading = range(6)

    def change(state: int) -> int:
        return caller.code('SetSimulationState', state__state=state)

    def now() -> int:
        return int(caller('GetSimulationState').state.state)

    caller.physsim.spawn(disc('a/0'))
    assert now() == stopped
    assert change(stopped) == 101
    for state in (quitting, no_world, loading, 99):
        assert change(state) == UNSUPPORTED
    # Paused at time 0 is not stopped, until it is stopped or loaded again.
    assert (change(paused), now()) == (OK, paused)
    assert change(paused) == 101
    assert (change(stopped), now()) == (OK, stopped)
    caller.physsim.spawn(disc('a/0'))
    assert (change(paused), now()) == (OK, paused)
    assert (change(playing), now()) == (OK, playing)
    assert caller.code('StepSimulation', steps=1) == OPERATION_FAILED
    caller.physsim.run(0.5)
    assert (change(paused), now()) == (OK, paused)
    assert (change(stopped), now()) == (OK, stopped)
    # A stop is a reset.
    assert caller.physsim.node.simulation.step == 0
    assert names_in(caller.physsim) == ()


@pytest.mark.parametrize('is_asked_meanwhile', [False, True])
def test_the_state_does_not_depend_on_whether_it_was_asked_for(
    caller: Caller, is_asked_meanwhile: bool
) -> None:
    physsim = caller.physsim
    stopped, playing, paused = range(3)
    assert caller.code('SetSimulationState', state__state=paused) == OK
    physsim.node.control.time.play()
    physsim.run(0.5)
    if is_asked_meanwhile:
        assert caller('GetSimulationState').state.state == playing
    physsim.node.control.time.pause()
    physsim.node.simulation.seek(0)
    physsim.settle()
    assert caller('GetSimulationState').state.state == stopped


def test_a_paused_world_goes_on_by_steps(caller: Caller) -> None:
    world = caller.physsim.node.simulation
    assert caller.code('StepSimulation', steps=3) == OK
    assert world.step == 3 * world.frame_steps
    for steps in (0, 601, 2**64 - 1):
        assert caller.code('StepSimulation', steps=steps) == OPERATION_FAILED
    assert world.step == 3 * world.frame_steps


def test_an_action_goes_on_by_steps_and_tells_each(caller: Caller) -> None:
    world = caller.physsim.node.simulation
    result, told = simulate_steps(caller, 3)
    assert result.result == OK
    assert world.step == 3 * world.frame_steps
    assert told == [(1, 2), (2, 1), (3, 0)]
    set_parameter(caller.physsim, 'speed', 1.0)
    result, told = simulate_steps(caller, 3)
    assert (result.result, told) == (OPERATION_FAILED, [])


def test_a_burst_of_goals_is_answered(caller: Caller) -> None:
    from simulation_interfaces.action import SimulateSteps  # noqa: PLC0415

    services = ('goal', 'result', 'cancel')
    client = ActionClient(
        caller.client.node,
        SimulateSteps,
        '/physsim/simulation/simulate_steps',
        **{f'{name}_service_qos_profile': CALLS for name in services},
    )
    caller.client.spin_until(client.server_is_ready)
    # More than a service keeps by default.
    sent = [client.send_goal_async(SimulateSteps.Goal(steps=1)) for _ in range(20)]
    caller.client.spin_until(lambda: all(each.done() for each in sent))
    results = [each.result().get_result_async() for each in sent]
    caller.client.spin_until(lambda: all(each.done() for each in results))
    client.destroy()
    assert {each.result().result.result.result for each in results} == {OK}
    world = caller.physsim.node.simulation
    assert world.step == 20 * world.frame_steps


def test_steps_are_made_when_they_are_told_though_a_seek_was_under_way(
    caller: Caller, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = caller.physsim.node.simulation
    begin_seek(caller.physsim, monkeypatch)
    result, told = simulate_steps(caller, 2)
    assert (result.result, told) == (OK, [(1, 1), (2, 0)])
    assert world.step == 32 * world.frame_steps


def test_a_step_is_made_when_it_is_told_though_a_request_waits_behind_it(
    caller: Caller, monkeypatch: pytest.MonkeyPatch
) -> None:
    from simulation_interfaces.srv import StepSimulation  # noqa: PLC0415

    world = caller.physsim.node.simulation
    begin_seek(caller.physsim, monkeypatch)
    service = caller.client.service(StepSimulation, '~/simulation/step_simulation')
    stepped = service.call_async(StepSimulation.Request(steps=1))
    caller.physsim.settle()
    assert not stepped.done()
    world.requests.submit(Spawn(name='a/0', shape=Disc(radius=0.5), pose=(0.0, 3.0, 0.0)))
    caller.physsim.node.loop.apply_requests()
    caller.client.spin_until(stepped.done)
    assert stepped.result().result.result == OK
    assert world.step == 31 * world.frame_steps


def test_other_calls_are_answered_between_the_frames_of_a_call_and_requests_after_them(
    caller: Caller, monkeypatch: pytest.MonkeyPatch
) -> None:
    from simulation_interfaces.srv import StepSimulation  # noqa: PLC0415

    steps, node, client = 6, caller.physsim.node, caller.client
    world = node.simulation
    monkeypatch.setattr(node.loop, 'started', True)
    # A tick has no time for more than a request.
    monkeypatch.setattr(frame_loop, 'MOST_REQUESTS_NS', -1)
    service = client.service(StepSimulation, '~/simulation/step_simulation')
    stepped = service.call_async(StepSimulation.Request(steps=steps))
    client.spin_until(lambda: world.step)
    spawned = Spawn(name='a/0', shape=Disc(radius=0.5), pose=(0.0, 3.0, 0.0))
    world.requests.submit(spawned)
    for frames in range(2, steps):
        # Each call lets the steps go on by a frame.
        assert client.call('~/pause').success
        assert world.step == frames * world.frame_steps
        assert not stepped.done()
        assert names_in(caller.physsim) == ()
    for now in range(2):
        node.tick(now)
    client.spin_until(stepped.done)
    assert stepped.result().result.result == OK
    assert world.step == steps * world.frame_steps
    assert names_in(caller.physsim) == ('a/0',)


def test_steps_end_where_time_begins_to_run(
    caller: Caller, monkeypatch: pytest.MonkeyPatch
) -> None:
    from simulation_interfaces.srv import StepSimulation  # noqa: PLC0415

    node, client = caller.physsim.node, caller.client
    monkeypatch.setattr(node.loop, 'started', True)
    monkeypatch.setattr(frame_loop, 'MOST_REQUESTS_NS', -1)
    service = client.service(StepSimulation, '~/simulation/step_simulation')
    stepped = service.call_async(StepSimulation.Request(steps=600))
    client.spin_until(lambda: node.simulation.step)
    assert client.call('~/play').success
    node.tick(0)
    client.spin_until(stepped.done)
    assert stepped.result().result.result == OPERATION_FAILED
    assert 'time is running' in stepped.result().result.error_message


def test_the_program_ends_after_its_reply(caller: Caller) -> None:
    quitting = 3
    ended: list[str] = []
    node = caller.physsim.node
    node.control.on_quit = lambda: ended.append('ended')
    set_parameter(caller.physsim, 'speed', 1.0)
    assert caller.code('SetSimulationState', state__state=quitting) == OK
    assert caller('GetSimulationState').state.state == quitting
    assert node.simulation.speed == 0.0
    assert caller.code('SetSimulationState', state__state=1) == 103
    assert ended == []
    node.tick(0)
    node.tick(1)
    assert ended == ['ended']


def test_an_error_that_nobody_expected_fails_a_call_and_nothing_else(
    caller: Caller, monkeypatch: pytest.MonkeyPatch
) -> None:
    from physsim_ros.ros.simulation_services import services  # noqa: PLC0415
    from simulation_interfaces import srv  # noqa: PLC0415

    node = caller.physsim.node
    errors: list[BaseException] = []
    node.boundary.on_error = errors.append
    monkeypatch.setattr(services, 'in_slices', fail)
    kinds = [each for each in vars(srv) if each[0].isupper() and '_' not in each]
    offered = [each.srv_name for each in node.services if '/simulation/' in each.srv_name]
    # Each service of the standard is there.
    assert len(kinds) == len([each for each in offered if '/_action/' not in each]) == 22
    for number, kind in enumerate(kinds, 1):
        response = caller(kind)
        if kind != 'GetSimulatorFeatures':
            assert response.result.result == OPERATION_FAILED
            assert 'failure 1 in the log' in response.result.error_message
        assert len(errors) == number
    result, _ = simulate_steps(caller, 1)
    assert result.result == OPERATION_FAILED
    assert {type(each) for each in errors} == {ZeroDivisionError}
    monkeypatch.undo()
    assert caller.code('StepSimulation', steps=1) == OK


@pytest.mark.skipif(
    find_spec('simulation_interfaces') is not None, reason='simulation_interfaces is installed'
)
def test_without_the_package_there_are_no_services(physsim: PhysSim) -> None:
    assert not [each for each in physsim.node.services if '/simulation/' in each.srv_name]
