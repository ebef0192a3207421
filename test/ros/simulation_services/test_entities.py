# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies by the standard services: spawned, found, moved, described and deleted."""

from __future__ import annotations

import math
from typing import Any

from physsim_ros.testing import box, disc
import pytest

from .caller import (
    Caller,
    INVALID_POSE,
    NAME_INVALID,
    NAME_NOT_UNIQUE,
    names_in,
    NAMESPACE_INVALID,
    NO_RESOURCE,
    NOT_FOUND,
    OK,
    OPERATION_FAILED,
    RESOURCE_PARSE_ERROR,
    UNSUPPORTED,
    UNSUPPORTED_FORMAT,
)

pytestmark = pytest.mark.slow


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
    # A state that was told can be set, and changes nothing.
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
