# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Entities: the bodies of the world, by the services of `simulation_interfaces`.

An entity's name is that of its body. Its twist is that of its centre of mass, in the world's axes,
as on `~/states`; accelerations are neither told nor heard.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import count
import re
from typing import Any

from geometry_msgs.msg import Vector3
import numpy as np
from physsim_ros.files import shipped_robots, spawn_from
from physsim_ros.model.errors import Exists, Malformed, Refusal, UnknownFrame
from physsim_ros.model.names import check_body_name
from physsim_ros.model.requests import Command, Delete, Spawn
from physsim_ros.model.robots.robot import check_namespace
from physsim_ros.model.shapes import extent_of
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import REST
from physsim_ros.ros.requests.conversions import mapping_of, named_frame, planar_pose
from physsim_ros.ros.robots.frames import rotation_of
from physsim_ros.ros.simulation_services.entity_filters import category_of, passing, tags_of
from physsim_ros.ros.simulation_services.results import Failed, failed, failing_with
from physsim_ros.sketchpad import WorldControl
from simulation_interfaces.msg import (
    Bounds,
    EntityCategory,
    EntityInfo,
    EntityState,
    Result,
    Spawnable,
)
from simulation_interfaces.srv import SpawnEntity

# What can be spawned by name besides the shipped robots: entries of a world file [m].
_SHAPES: dict[str, Mapping[str, Any]] = {
    'disc': {'circle': {'radius': 0.5}},
    'box': {'box': {'width': 1.0, 'height': 1.0}},
    'wall': {'box': {'width': 0.1, 'height': 4.0}, 'anchored': True},
}
# Suffixes of formats that other simulators have.
_FOREIGN = ('.sdf', '.urdf', '.xacro', '.usd', '.usda', '.mjcf', '.xml', '.dae', '.stl')


class Entities:
    """
    The services for entities; each returns a message about what was done, '' for nothing.

    :param control: of the node
    """

    def __init__(self, control: WorldControl) -> None:
        self._control = control
        self._frame_id = str(control.values['frame_id'])

    def spawnables(self, request: Any, response: Any) -> str:
        """List what `spawn` takes by name: shipped robots and plain shapes."""
        response.spawnables = [
            Spawnable(
                uri=uri,
                description='a robot' if uri in shipped_robots() else 'a body',
                spawn_bounds=_box(spawn_from({**_entry_of(uri), 'name': 'a/0'}).shape),
            )
            for uri in (*shipped_robots(), *_SHAPES)
        ]
        response.result.error_message = unknown_sources(request.sources)
        return ''

    def spawn(self, request: Any, response: Any) -> str:
        """Spawn a body by the name of a spawnable, or by an entry of a world file."""
        entry = dict(_entry(request))
        with failing_with(SpawnEntity.Response.NAMESPACE_INVALID):
            namespace = check_namespace(request.entity_namespace, 'entity_namespace')
        if namespace and 'robot' in entry:
            robot = entry['robot']
            robot = {'from': robot} if isinstance(robot, str) else robot
            if isinstance(robot, dict):
                entry['robot'] = {**robot, 'namespace': namespace}
        names = self._control.current_snapshot().scene.names
        entry['name'] = _name(request, entry, names)
        with failing_with(SpawnEntity.Response.INVALID_POSE):
            pose = planar_pose(request.initial_pose.pose, 'initial_pose')
        with failing_with(SpawnEntity.Response.RESOURCE_PARSE_ERROR):
            spawn = spawn_from(entry)
        frame = named_frame(request.initial_pose.header.frame_id, self._frame_id)
        with failing_with(SpawnEntity.Response.INVALID_POSE):
            spawn = replace(spawn, pose=pose, frame=frame)
        message = self._perform_spawn(spawn)
        response.entity_name = spawn.name
        return message

    def delete(self, request: Any, _: Any) -> str:
        """Delete a body."""
        return self._control.simulation.perform(Delete(name=request.entity))

    def state(self, request: Any, response: Any) -> str:
        """Tell pose and twist of a body."""
        snapshot = self._control.current_snapshot()
        response.state = self._state_of(snapshot, snapshot.row(request.entity))
        return ''

    def set_state(self, request: Any, _: Any) -> str:
        """Set pose and twist of a body, both in the frame of the world."""
        state, name = request.state, request.entity
        snapshot = self._control.current_snapshot()
        body = snapshot.scene.bodies[snapshot.row(name)]
        if named_frame(state.header.frame_id, self._frame_id):
            raise failed(
                f'a state is set in the frame {self._control.values["frame_id"]!r} only',
                Result.RESULT_FEATURE_UNSUPPORTED,
                field='state.header.frame_id',
            )
        linear, angular = state.twist.linear, state.twist.angular
        twist = linear.x, linear.y, angular.z
        # An anchored body takes a pose, and rest.
        rests = body.anchored and twist == REST
        command = Command(
            names=(name,),
            poses=np.array([planar_pose(state.pose, 'state.pose')]),
            twists=np.empty((0, 3)) if rests else np.array([twist]),
        )
        return self._control.simulation.perform(command)

    def names(self, request: Any, response: Any) -> str:
        """Tell the names of all bodies that pass filters."""
        snapshot = self._control.current_snapshot()
        rows = passing(snapshot, request.filters)
        response.entities = [snapshot.scene.names[row] for row in rows]
        return ''

    def states(self, request: Any, response: Any) -> str:
        """Tell names, poses and twists of all bodies that pass filters."""
        snapshot = self._control.current_snapshot()
        rows = list(passing(snapshot, request.filters))
        response.entities = [snapshot.scene.names[row] for row in rows]
        response.states = [self._state_of(snapshot, row) for row in rows]
        return ''

    def info(self, request: Any, response: Any) -> str:
        """Tell what a body is."""
        snapshot = self._control.current_snapshot()
        body = snapshot.scene.bodies[snapshot.row(request.entity)]
        response.info = EntityInfo(
            category=EntityCategory(category=category_of(body)),
            description=f'{body.shape.KEY}, {body.total_mass:.4g} kg',
            tags=list(tags_of(body)),
        )
        return ''

    def bounds(self, request: Any, response: Any) -> str:
        """Tell the box around a body, in the body's frame."""
        snapshot = self._control.current_snapshot()
        response.bounds = _box(snapshot.scene.bodies[snapshot.row(request.entity)].shape)
        return ''

    def _perform_spawn(self, spawn: Spawn) -> str:
        try:
            return self._control.simulation.perform(spawn)
        except Exists as refusal:
            # The namespace of another robot.
            raise Failed(refusal, SpawnEntity.Response.NAMESPACE_INVALID) from refusal
        except UnknownFrame as refusal:
            raise Failed(refusal, SpawnEntity.Response.INVALID_POSE) from refusal

    def _state_of(self, snapshot: Snapshot, row: int) -> EntityState:
        state = EntityState()
        state.header.frame_id = self._frame_id
        state.header.stamp.sec, state.header.stamp.nanosec = divmod(snapshot.stamp, 10**9)
        x, y, yaw = snapshot.poses[row].tolist()
        state.pose.position.x, state.pose.position.y = x, y
        state.pose.orientation = rotation_of(yaw)
        vx, vy, spin = snapshot.twists[row].tolist()
        state.twist.linear.x, state.twist.linear.y, state.twist.angular.z = vx, vy, spin
        return state


def _entry_of(uri: str) -> Mapping[str, Any]:
    """Return the entry of a spawnable."""
    return _SHAPES.get(uri, {'robot': uri})


def _entry(request: Any) -> Mapping[str, Any]:
    """Return the entry that a request names, or has."""
    uri, text = request.uri, request.resource_string
    if not (uri or text):
        raise failed(
            'neither uri nor resource_string says what to spawn',
            SpawnEntity.Response.NO_RESOURCE,
            field='uri',
        )
    if uri.lower().endswith(_FOREIGN) or (not uri and text.lstrip().startswith('<')):
        raise failed(
            'spawned are shipped robots, shapes, and entries of a world file in YAML',
            SpawnEntity.Response.UNSUPPORTED_FORMAT,
            field='uri' if uri else 'resource_string',
        )
    if not uri:
        with failing_with(SpawnEntity.Response.RESOURCE_PARSE_ERROR):
            return mapping_of(text, 'resource_string')
    if uri not in (*shipped_robots(), *_SHAPES):
        known = ', '.join((*shipped_robots(), *_SHAPES))
        raise failed(
            f'there is no spawnable {uri!r}; there are {known}',
            Result.RESULT_NOT_FOUND,
            field='uri',
        )
    return _entry_of(uri)


def _name(request: Any, entry: Mapping[str, Any], taken: tuple[str, ...]) -> str:
    """Return the name of a new body."""
    name = request.name or entry.get('name', '')
    try:
        if not isinstance(name, str):
            raise Malformed('a name must be text', field='name')
        check_body_name(name)
    except Refusal as refusal:
        if not request.allow_renaming:
            raise Failed(refusal, SpawnEntity.Response.NAME_INVALID) from refusal
        stem = re.sub('[^A-Za-z0-9_]+', '_', str(name)).strip('_') or request.uri or 'entity'
        return next(each for each in _numbered(stem[:100]) if each not in taken)
    if name not in taken:
        return name
    if not request.allow_renaming:
        raise failed(
            f'there is an entity {name!r} already',
            SpawnEntity.Response.NAME_NOT_UNIQUE,
            field='name',
        )
    return next(each for each in _numbered(name.rpartition('/')[0]) if each not in taken)


def _numbered(stem: str) -> Iterator[str]:
    return (f'{stem}/{number}' for number in count())


def _box(shape: Any) -> Bounds:
    low, high = extent_of(shape.form)
    points = [Vector3(x=high[0], y=high[1]), Vector3(x=low[0], y=low[1])]
    return Bounds(type=Bounds.TYPE_BOX, points=points)


def unknown_sources(sources: list[str]) -> str:
    """Return a message about sources, of which none is known; '' for none."""
    return f'unknown sources: {", ".join(sources)}'[:500] if sources else ''
