# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Spawning: bodies by the name of a spawnable or by an entry of a world file, one or many.

Law: of many, each is spawned or refused on its own, and has a result of its own; all of them are
one gesture, which `undo` reverts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
import re
from typing import Any

from physsim_ros.files import shipped_robots, spawn_from
from physsim_ros.model.errors import Exists, Malformed, Refusal, UnknownFrame
from physsim_ros.model.names import check_body_name
from physsim_ros.model.requests import Spawn
from physsim_ros.model.robots.robot import check_namespace
from physsim_ros.model.translation import counted
from physsim_ros.ros.node_control import NodeControl
from physsim_ros.ros.planar import named_frame, planar_pose
from physsim_ros.ros.requests.conversions import mapping_of
from physsim_ros.ros.simulation_services.new_names import NewNames
from physsim_ros.ros.simulation_services.results import (
    box_around,
    coded,
    CodedRefusal,
    coding_refusals,
    result_of,
)
from physsim_ros.ros.simulation_services.worlds import unknown_sources, Worlds
from simulation_interfaces.msg import Resource, Result, Spawnable, SpawnEntity, SpawnResult
from simulation_interfaces.srv import SpawnEntities

# Entities of one call: a tenth of a second on a laptop. Meanwhile nothing else is done.
MOST_ENTITIES = 300
# Bodies that can be spawned by name besides the shipped robots: entries of a world file [m].
_SHAPES: dict[str, Mapping[str, Any]] = {
    'disc': {'circle': {'radius': 0.5}},
    'box': {'box': {'width': 1.0, 'height': 1.0}},
    'wall': {'box': {'width': 0.1, 'height': 4.0}, 'anchored': True},
}
# Suffixes of formats that other simulators have.
_FOREIGN = ('.sdf', '.urdf', '.xacro', '.usd', '.usda', '.mjcf', '.xml', '.dae', '.stl')


class Spawning:
    """
    The services that spawn; each returns a message about what was done, '' for nothing.

    :param control: of the node
    :param worlds: of the services, since nothing is spawned where none is loaded
    """

    def __init__(self, control: NodeControl, worlds: Worlds) -> None:
        self._control = control
        self._worlds = worlds
        self._frame_id = str(control.values['frame_id'])

    def spawnables(self, request: Any, response: Any) -> str:
        """List what `spawn` takes by name: shipped robots and plain shapes."""
        response.spawnables = [
            Spawnable(
                uri=uri,
                description='a robot' if uri in shipped_robots() else 'a body',
                spawn_bounds=box_around(spawn_from({**_entry_of(uri), 'name': 'a/0'}).shape),
            )
            for uri in _spawnables()
        ]
        response.result.error_message = unknown_sources(request.sources)
        return ''

    def spawn(self, request: Any, response: Any) -> str:
        """Spawn a body by the name of a spawnable, or by an entry of a world file."""
        self._worlds.check_loaded()
        wanted = SpawnEntity(
            name=request.name,
            allow_renaming=request.allow_renaming,
            entity_resource=Resource(uri=request.uri, resource_string=request.resource_string),
            entity_namespace=request.entity_namespace,
            initial_pose=request.initial_pose,
        )
        names = NewNames(self._control.loop.bring_up_to_date().scene.row_of)
        spawn = self._request_of(wanted, names)
        message = self._perform(spawn, self._control.simulation.requests.begin_gesture())
        response.entity_name = spawn.name
        return message

    def spawn_many(self, request: Any, response: Any) -> str:
        """Spawn bodies, each on its own."""
        self._worlds.check_loaded()
        number = len(request.spawn_requests)
        if number > MOST_ENTITIES:
            raise coded(
                f'{number} entities are too many; a call has at most {MOST_ENTITIES}',
                Result.RESULT_OPERATION_FAILED,
                field='spawn_requests',
            )
        names = NewNames(self._control.loop.bring_up_to_date().scene.row_of)
        gesture = self._control.simulation.requests.begin_gesture()
        for each in request.spawn_requests:
            result = SpawnResult()
            response.results.append(result)
            try:
                spawn = self._request_of(each, names)
                self._perform(spawn, gesture)
            except Refusal as refusal:
                result.result.result = result_of(refusal)
                result.result.error_message = str(refusal)
                continue
            names.add(spawn.name)
            result.result.result = Result.RESULT_OK
            result.entity_name = spawn.name
        refused = [
            each.result for each in response.results if each.result.result != Result.RESULT_OK
        ]
        spawned = f'spawned {counted(number - len(refused), "body")}'
        if not refused:
            return spawned if number else ''
        # Some may have been spawned.
        self._control.note_change()
        raise coded(
            f'{spawned}, refused {len(refused)}; the first: {refused[0].error_message}',
            SpawnEntities.Response.ENTITIES_SPAWN_FAILED,
            field='spawn_requests',
        )

    def _request_of(self, wanted: SpawnEntity, names: NewNames) -> Spawn:
        """Return the request for a body, of a name that is free."""
        entry = dict(_entry(wanted))
        with coding_refusals(SpawnResult.NAMESPACE_INVALID):
            namespace = check_namespace(wanted.entity_namespace, 'entity_namespace')
        if namespace and 'robot' in entry:
            robot = entry['robot']
            robot = {'from': robot} if isinstance(robot, str) else robot
            if isinstance(robot, dict):
                entry['robot'] = {**robot, 'namespace': namespace}
        entry['name'] = _name(wanted, entry, names)
        with coding_refusals(SpawnResult.INVALID_POSE):
            pose = planar_pose(wanted.initial_pose.pose, 'initial_pose')
        with coding_refusals(SpawnResult.RESOURCE_PARSE_ERROR):
            spawn = spawn_from(entry)
        frame = named_frame(wanted.initial_pose.header.frame_id, self._frame_id)
        with coding_refusals(SpawnResult.INVALID_POSE):
            return replace(spawn, pose=pose, frame=frame)

    def _perform(self, spawn: Spawn, gesture: int) -> str:
        try:
            return self._control.simulation.perform(spawn, gesture)
        except Exists as refusal:
            # The namespace of another robot.
            raise CodedRefusal(refusal, SpawnResult.NAMESPACE_INVALID) from refusal
        except UnknownFrame as refusal:
            raise CodedRefusal(refusal, SpawnResult.INVALID_POSE) from refusal


def _spawnables() -> tuple[str, ...]:
    return *shipped_robots(), *_SHAPES


def _entry_of(uri: str) -> Mapping[str, Any]:
    """Return the entry of a spawnable."""
    return _SHAPES.get(uri, {'robot': uri})


def _entry(wanted: SpawnEntity) -> Mapping[str, Any]:
    """Return the entry that is named, or is there as a text."""
    uri, text = wanted.entity_resource.uri, wanted.entity_resource.resource_string
    if not (uri or text):
        raise coded(
            'neither uri nor resource_string says what to spawn',
            SpawnResult.NO_RESOURCE,
            field='uri',
        )
    if uri.lower().endswith(_FOREIGN) or (not uri and text.lstrip().startswith('<')):
        raise coded(
            'spawned are shipped robots, shapes, and entries of a world file in YAML',
            SpawnResult.UNSUPPORTED_FORMAT,
            field='uri' if uri else 'resource_string',
        )
    if not uri:
        with coding_refusals(SpawnResult.RESOURCE_PARSE_ERROR):
            return mapping_of(text, 'resource_string')
    if uri not in _spawnables():
        raise coded(
            f'there is no spawnable {uri!r}; there are {", ".join(_spawnables())}',
            Result.RESULT_NOT_FOUND,
            field='uri',
        )
    return _entry_of(uri)


def _name(wanted: SpawnEntity, entry: Mapping[str, Any], names: NewNames) -> str:
    """Return the name of a new body."""
    name = wanted.name or entry.get('name', '')
    try:
        if not isinstance(name, str):
            raise Malformed('a name must be text', field='name')
        check_body_name(name)
    except Refusal as refusal:
        if not wanted.allow_renaming:
            raise CodedRefusal(refusal, SpawnResult.NAME_INVALID) from refusal
        stem = (
            re.sub('[^A-Za-z0-9_]+', '_', str(name)).strip('_')
            or wanted.entity_resource.uri
            or 'entity'
        )
        return names.free_name(stem[:100])
    if name not in names:
        return name
    if not wanted.allow_renaming:
        raise coded(
            f'there is an entity {name!r} already', SpawnResult.NAME_NOT_UNIQUE, field='name'
        )
    return names.free_name(name.rpartition('/')[0])
