# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The services of `simulation_interfaces`, called with classes that are built for the test."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
import math
from typing import Any

from physsim_ros.testing import box, disc, PhysSim
import pytest
from rclpy.action import ActionClient

from ..built_interfaces import import_built
from ...client import Client, set_parameter
from ...doors import fail

pytestmark = pytest.mark.slow


class Caller:
    """Calls services of the standard by their names."""

    def __init__(self, physsim: PhysSim) -> None:
        self.physsim, self.client = physsim, Client(physsim)
        self.world_dir = physsim.node.world_files.directory

    def __call__(self, service: str, **fields: Any) -> Any:
        from simulation_interfaces import srv  # noqa: PLC0415 - built for the test

        kind = getattr(srv, service)
        name = ''.join(f'_{each.lower()}' if each.isupper() else each for each in service)
        request = kind.Request()
        for path, value in fields.items():
            *parts, last = path.split('__')
            target = request
            for part in parts:
                target = getattr(target, part)
            setattr(target, last, value)
        return self.client.request(kind, f'~/simulation/{name[1:]}', request)

    def code(self, service: str, **fields: Any) -> int:
        """Call a service, check that a refusal says why, and return the code of its result."""
        result = self(service, **fields).result
        assert (result.result == OK) or result.error_message
        return int(result.result)


@pytest.fixture
def caller(request: pytest.FixtureRequest, start: Callable[..., PhysSim]) -> Caller:
    """Give a test a world, paused at time 0, with the services."""
    import_built('simulation_interfaces', request)
    return Caller(start(speed=0.0, gravity=[0.0, 0.0]))


def names_in(physsim: PhysSim) -> tuple[str, ...]:
    """Return the names of the bodies of a world, whether a frame has shown them or not."""
    return physsim.node.simulation.world.snapshot().scene.names


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
    caller.client.spin_until(answered.done)
    result = answered.result().result.result
    if result.result == OK:
        caller.client.spin_until(lambda: len(told) == steps)
    client.destroy()
    return result, told


UNSUPPORTED, OK, NOT_FOUND, INCORRECT_STATE, OPERATION_FAILED = range(5)
NAME_NOT_UNIQUE, NAME_INVALID, UNSUPPORTED_FORMAT, NO_RESOURCE = 101, 102, 103, 104
NAMESPACE_INVALID, RESOURCE_PARSE_ERROR, INVALID_POSE = 105, 106, 109


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


def test_an_entity_lives_from_spawn_to_delete(caller: Caller) -> None:
    spawned = caller(
        'SpawnEntity',
        name='tb/0',
        uri='turtlebot3_burger',
        entity_namespace='/left',
        initial_pose__pose__position__x=2.0,
        initial_pose__pose__orientation__z=1.0,
        initial_pose__pose__orientation__w=0.0,
    )
    assert spawned.result.result == OK
    state = caller('GetEntityState', entity='tb/0').state
    assert (state.header.frame_id, state.pose.position.x) == ('world', 2.0)
    assert state.pose.orientation.z == pytest.approx(1.0)
    caller.physsim.step()
    topics = {name for name, _ in caller.client.node.get_topic_names_and_types()}
    assert '/left/odom' in topics
    info = caller('GetEntityInfo', entity='tb/0').info
    assert 'robot' in info.tags
    assert info.category.category == info.category.CATEGORY_ROBOT
    assert caller.code('DeleteEntity', entity='tb/0') == OK
    assert caller.physsim.names == ()
    assert caller.code('DeleteEntity', entity='tb/0') == NOT_FOUND


def test_an_entry_of_a_world_file_is_spawned_relative_to_a_body(caller: Caller) -> None:
    caller.physsim.spawn(box('table/0', at=(1.0, 0.0, math.pi / 2)))
    spawned = caller(
        'SpawnEntity',
        resource_string='{name: cup/0, circle: {radius: 0.25}, mass: 3, anchored: true}',
        initial_pose__header__frame_id='table/0',
        initial_pose__pose__position__x=2.0,
    )
    assert (spawned.result.result, spawned.entity_name) == (OK, 'cup/0')
    assert caller.physsim.pose('cup/0')[:2] == pytest.approx((1.0, 2.0))
    bounds = caller('GetEntityBounds', entity='cup/0').bounds
    assert bounds.type == bounds.TYPE_BOX
    assert [(each.x, each.y) for each in bounds.points] == [(0.25, 0.25), (-0.25, -0.25)]


def test_what_cannot_be_spawned_is_told_and_changes_nothing(caller: Caller) -> None:
    caller.physsim.spawn(disc('a/0', at=(9.0, 0.0)))
    caller('SpawnEntity', name='robot/0', uri='omni', entity_namespace='taken')
    before = caller.physsim.digest()
    short = {
        'x': 'initial_pose__pose__position__x',
        'w': 'initial_pose__pose__orientation__w',
        'roll': 'initial_pose__pose__orientation__x',
        'frame': 'initial_pose__header__frame_id',
    }
    for fields, result in (
        ({'name': 'a/0', 'uri': 'disc'}, NAME_NOT_UNIQUE),
        ({'name': '', 'uri': 'disc'}, NAME_INVALID),
        ({'name': 'no number', 'uri': 'disc'}, NAME_INVALID),
        ({'name': 'b/0'}, NO_RESOURCE),
        ({'name': 'b/0', 'uri': 'nothing'}, NOT_FOUND),
        ({'name': 'b/0', 'uri': '/etc/passwd'}, NOT_FOUND),
        ({'name': 'b/0', 'uri': 'model.sdf'}, UNSUPPORTED_FORMAT),
        ({'name': 'b/0', 'resource_string': '<robot/>'}, UNSUPPORTED_FORMAT),
        ({'name': 'b/0', 'resource_string': '{circle: '}, RESOURCE_PARSE_ERROR),
        ({'name': 'b/0', 'resource_string': '[1, 2]'}, RESOURCE_PARSE_ERROR),
        ({'name': 'b/0', 'resource_string': '{mass: 1}'}, RESOURCE_PARSE_ERROR),
        ({'name': 'b/0', 'resource_string': '{circle: {radius: -1}}'}, RESOURCE_PARSE_ERROR),
        ({'name': 'b/0', 'resource_string': '{' * 60}, RESOURCE_PARSE_ERROR),
        ({'name': 'b/0', 'resource_string': 'x' * 100_000}, RESOURCE_PARSE_ERROR),
        ({'name': 'b/0', 'uri': 'omni', 'entity_namespace': '0 bad'}, NAMESPACE_INVALID),
        ({'name': 'b/0', 'uri': 'omni', 'entity_namespace': 'taken'}, NAMESPACE_INVALID),
        ({'name': 'b/0', 'uri': 'disc', 'x': math.nan}, INVALID_POSE),
        ({'name': 'b/0', 'uri': 'disc', 'x': 1e30}, INVALID_POSE),
        ({'name': 'b/0', 'uri': 'disc', 'w': math.inf}, INVALID_POSE),
        ({'name': 'b/0', 'uri': 'disc', 'roll': 1.0}, INVALID_POSE),
        ({'name': 'b/0', 'uri': 'disc', 'frame': 'nowhere'}, INVALID_POSE),
    ):
        values = {short.get(key, key): each for key, each in fields.items()}
        refused = caller('SpawnEntity', **values)
        assert refused.result.result == result, fields
        assert refused.result.error_message
        assert refused.entity_name == ''
        assert caller.physsim.digest() == before


def test_names_are_changed_where_that_is_allowed(caller: Caller) -> None:
    names = [
        caller('SpawnEntity', name=name, uri='disc', allow_renaming=True).entity_name
        for name in ('a/0', 'a/0', '', 'two words')
    ]
    assert names == ['a/0', 'a/1', 'disc/0', 'two_words/0']


def test_a_state_that_is_set_is_the_one_that_is_told(caller: Caller) -> None:
    caller.physsim.spawn(disc('a/0'))
    fields = {
        'state__pose__position__x': 3.0,
        'state__twist__linear__y': 2.0,
        'state__twist__angular__z': 0.5,
    }
    assert caller.code('SetEntityState', entity='a/0', **fields) == OK
    caller.physsim.run(1.0)
    states = caller('GetEntitiesStates')
    assert states.entities == ['a/0']
    (state,) = states.states
    position, twist = state.pose.position, state.twist
    assert (position.x, position.y) == pytest.approx((3.0, 2.0))
    assert (twist.linear.y, twist.angular.z) == pytest.approx((2.0, 0.5))
    assert state.header.stamp.sec == 1


def test_a_state_that_cannot_be_is_refused(caller: Caller) -> None:
    caller.physsim.spawn(disc('a/0'))
    before = caller.physsim.digest()
    for fields, result in (
        ({'entity': 'b/0'}, NOT_FOUND),
        ({'state__pose__position__x': math.nan}, 101),
        ({'state__pose__position__y': 1e30}, 101),
        ({'state__pose__orientation__w': math.nan}, 101),
        ({'state__pose__orientation__x': 1.0}, 101),
        ({'state__twist__linear__x': math.inf}, OPERATION_FAILED),
        ({'state__twist__linear__x': 1e30}, OPERATION_FAILED),
        ({'state__header__frame_id': 'a/0'}, UNSUPPORTED),
    ):
        assert caller.code('SetEntityState', **{'entity': 'a/0', **fields}) == result, fields
        assert caller.physsim.digest() == before


def test_entities_are_filtered(caller: Caller) -> None:
    from geometry_msgs.msg import Vector3  # noqa: PLC0415
    from simulation_interfaces.msg import Bounds, EntityCategory, TagsFilter  # noqa: PLC0415

    physsim = caller.physsim
    physsim.spawn(box('wall/0', at=(0.0, 5.0), size=(4.0, 1.0), anchored=True))
    for number in range(3):
        physsim.spawn(disc(f'ball/{number}', at=(2.0 * number, 0.0)))
    caller('SpawnEntity', name='robot/0', uri='omni', initial_pose__pose__position__x=-5.0)

    def names(**filters: Any) -> list[str]:
        found = caller('GetEntities', **{f'filters__{key}': each for key, each in filters.items()})
        assert found.result.result == OK
        return list(found.entities)

    assert names(filter='^ball/[02]$') == ['ball/0', 'ball/2']
    assert names(filter='(a+)+$') == []
    robots = [EntityCategory(category=EntityCategory.CATEGORY_ROBOT)]
    assert names(categories=robots) == ['robot/0']
    assert names(tags=TagsFilter(tags=['anchored', 'robot'])) == ['wall/0', 'robot/0']
    both = TagsFilter(tags=['anchored', 'box'], filter_mode=TagsFilter.FILTER_MODE_ALL)
    assert names(tags=both) == ['wall/0']
    sphere = [Vector3(x=1.0), Vector3(x=0.6)]
    assert names(bounds=Bounds(type=Bounds.TYPE_SPHERE, points=sphere)) == ['ball/0', 'ball/1']
    corners = [Vector3(x=9.0, y=9.0), Vector3(x=1.9, y=4.0)]
    assert names(bounds=Bounds(type=Bounds.TYPE_BOX, points=corners)) == ['wall/0']
    hull = Bounds(type=Bounds.TYPE_CONVEX_HULL, points=[*sphere, Vector3()])
    assert caller.code('GetEntities', filters__bounds=hull) == UNSUPPORTED
    assert caller.code('GetEntities', filters__filter='(') == OPERATION_FAILED
    nowhere = Bounds(type=Bounds.TYPE_BOX, points=[Vector3(x=math.nan)])
    assert caller.code('GetEntities', filters__bounds=nowhere) == OPERATION_FAILED
    for service in ('GetEntityState', 'GetEntityInfo', 'GetEntityBounds'):
        assert caller.code(service, entity='ball/9') == NOT_FOUND


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
    assert caller.code('StepSimulation', steps=1) == INCORRECT_STATE
    caller.physsim.run(0.5)
    assert (change(paused), now()) == (OK, paused)
    assert (change(stopped), now()) == (OK, stopped)
    # A stop is a reset.
    assert caller.physsim.node.simulation.step == 0
    assert names_in(caller.physsim) == ()


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
    assert (result.result, told) == (INCORRECT_STATE, [])


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


def test_entities_are_spawned_each_on_its_own(caller: Caller) -> None:
    from simulation_interfaces.msg import Resource, SpawnEntity  # noqa: PLC0415

    disc_of = Resource(uri='disc')

    def wanted(name: str, resource: Resource = disc_of, **fields: Any) -> SpawnEntity:
        return SpawnEntity(name=name, entity_resource=resource, **fields)

    assert caller.code('SpawnEntities') == OK
    answer = caller('SpawnEntities', spawn_requests=[wanted('a/0'), wanted('a/1')])
    assert answer.result.result == OK
    assert [each.entity_name for each in answer.results] == ['a/0', 'a/1']
    assert [each.result.result for each in answer.results] == [OK, OK]
    answer = caller(
        'SpawnEntities',
        spawn_requests=[
            wanted('b/0'),
            wanted('b/0'),
            wanted('b/0', allow_renaming=True),
            wanted('c/0', Resource()),
            wanted('c/0', Resource(uri='model.sdf')),
            wanted('c/0', Resource(resource_string='{circle: {radius: 0.25}}')),
        ],
    )
    assert answer.result.result == 150
    assert 'spawned 3 bodies, refused 3' in answer.result.error_message
    assert [(each.result.result, each.entity_name) for each in answer.results] == [
        (OK, 'b/0'),
        (NAME_NOT_UNIQUE, ''),
        (OK, 'b/1'),
        (NO_RESOURCE, ''),
        (UNSUPPORTED_FORMAT, ''),
        (OK, 'c/0'),
    ]
    assert names_in(caller.physsim) == ('a/0', 'a/1', 'b/0', 'b/1', 'c/0')
    # Those of a call are one gesture.
    assert caller.client.call('~/undo').success
    assert names_in(caller.physsim) == ('a/0', 'a/1')
    many = [wanted(f'd/{number}') for number in range(301)]
    assert caller.code('SpawnEntities', spawn_requests=many) == OPERATION_FAILED
    assert names_in(caller.physsim) == ('a/0', 'a/1')


def test_a_description_is_the_label_of_a_body(caller: Caller) -> None:
    from simulation_interfaces.msg import EntityCategory  # noqa: PLC0415

    caller.physsim.spawn(box('crate/0', anchored=True))
    info = caller('GetEntityInfo', entity='crate/0').info
    before = caller.physsim.digest()
    # What was told can be set, and changes nothing.
    assert caller.code('SetEntityInfo', entity='crate/0', info=info) == OK
    for fields, result in (
        ({'entity': 'crate/1'}, NOT_FOUND),
        ({'info__tags': ['fragile']}, UNSUPPORTED),
        ({'info__category__category': EntityCategory.CATEGORY_HUMAN}, UNSUPPORTED),
        ({'info__description': 'x' * 201}, OPERATION_FAILED),
    ):
        assert caller.code('SetEntityInfo', **{'entity': 'crate/0', **fields}) == result
        assert caller.physsim.digest() == before
    assert caller.code('SetEntityInfo', entity='crate/0', info__description='bricks') == OK
    assert caller('GetEntityInfo', entity='crate/0').info.description == 'bricks'
    scene = caller.physsim.node.simulation.world.snapshot().scene
    assert [each.label for each in scene.bodies] == ['bricks']


def test_places_are_named_poses(caller: Caller) -> None:
    from simulation_interfaces.msg import TagsFilter  # noqa: PLC0415

    at = (1.0, 2.0, math.pi / 2)
    caller.physsim.spawn(
        box('goal/0', at=at, size=(2.0, 1.0), anchored=True, sensor=True, label='park here')
    )
    caller.physsim.spawn(box('wall/0', at=(9.0, 0.0), anchored=True))
    caller.physsim.spawn(disc('zone/0', at=(5.0, 5.0), sensor=True))
    (place,) = caller('GetNamedPoses').poses
    assert (place.name, place.description) == ('goal/0', 'park here')
    assert set(place.tags) == {'box', 'anchored', 'sensor'}
    assert (place.pose.position.x, place.pose.position.y) == (1.0, 2.0)
    assert place.pose.orientation.z == pytest.approx(math.sqrt(0.5))
    assert list(caller('GetNamedPoses', tags=TagsFilter(tags=['circle'])).poses) == []
    bounds = caller('GetNamedPoseBounds', name='goal/0').bounds
    assert [(each.x, each.y) for each in bounds.points] == [(1.0, 0.5), (-1.0, -0.5)]
    for name in ('wall/0', 'zone/0', 'nothing/0'):
        assert caller.code('GetNamedPoseBounds', name=name) == NOT_FOUND


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
    from physsim_ros.ros.simulation_services.services import (  # noqa: PLC0415
        SimulationServices,
    )
    from simulation_interfaces import srv  # noqa: PLC0415

    fill, node = vars(SimulationServices)['_fill'], caller.physsim.node
    errors: list[BaseException] = []
    node.boundary.on_error = errors.append
    monkeypatch.setattr(
        SimulationServices,
        '_fill',
        lambda self, topic, _, *others: fill(self, topic, fail, *others),
    )
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
