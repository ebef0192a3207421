# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests for bodies: spawned, changed, moved, commanded, anchored and deleted.

Law: all is checked before anything is changed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from physsim_ros.engine.body import REST, RigidBody
from physsim_ros.engine.space import Space
from physsim_ros.model.arrays import Floats
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checks import check_pose
from physsim_ros.model.errors import Anchored, BadProperty, NothingThere
from physsim_ros.model.names import split_name
from physsim_ros.model.requests import ChangeBody, Command, MoveBodies, Spawn
from physsim_ros.model.scene import Body
from physsim_ros.model.transform import Point, Pose
from physsim_ros.simulation.world import joint_requests
from physsim_ros.simulation.world.body_description import (
    changed_body,
    changed_twist,
    new_body,
    spawn_changes,
)
from physsim_ros.simulation.world.capacity import Capacity
from physsim_ros.simulation.world.lookup import body_of_name, pose_in_world

# The result of a request: the body concerned, or '', and a sentence about it.
Done = tuple[str, str]


def spawn_body(
    space: Space, request: Spawn, capacity: Capacity, *, serial: int, expires: int | None
) -> Done:
    """
    Add a body, or change the one of that name.

    :param serial: of the body if it is new
    :param expires: step at whose end it is removed; None is never, or as before
    :raises Refusal: and nothing is changed
    """
    name = request.name
    old = space.bodies.by_name.get(name)
    pose = pose_in_world(space, request.pose, request.frame)
    if old is not None:
        changes = spawn_changes(request, expires)
        _change(space, old, changes, pose, properties=request.properties, capacity=capacity)
        return name, f'changed {name}'
    body, twist = new_body(request, capacity.settings, expires)
    capacity.check_body(space, body, pose)
    space.add(body, serial, pose, twist)
    return name, f'spawned {name}'


def change_body(space: Space, request: ChangeBody, capacity: Capacity) -> Done:
    """
    Change the properties of a body that a request names.

    :raises Refusal: and nothing is changed
    """
    rigid, name = body_of_name(space, request.name), request.name
    pose = rigid.pose
    if request.pose is not None:
        pose = pose_in_world(space, request.pose, request.frame)
    changes = {} if request.color is None else {'color': request.color}
    _change(space, rigid, changes, pose, properties=request.properties, capacity=capacity)
    return name, f'changed {name}'


def move_bodies(space: Space, request: MoveBodies, capacity: Capacity) -> Done:
    """
    Move bodies by one vector; their velocities are kept.

    :raises Refusal: and nothing is changed
    """
    rigids = [body_of_name(space, name, 'names') for name in request.names]
    dx, dy = request.by
    poses = [(rigid.pose[0] + dx, rigid.pose[1] + dy, rigid.pose[2]) for rigid in rigids]
    for pose in poses:
        check_pose(pose, 'by')
    capacity.check_poses(space, rigids, poses)
    _set_poses(space, rigids, poses)
    return _told('moved', request.names)


def command_bodies(space: Space, request: Command, until: int | None, capacity: Capacity) -> Done:
    """
    Set poses, twists or wrenches of bodies.

    :param until: step at which the wrenches end; None is never
    :raises Refusal: and nothing is changed
    """
    rigids = [body_of_name(space, name, 'joint_names') for name in request.names]
    for rigid in rigids:
        check_command(rigid.body, request)
    # Twists and wrenches are of the world, but a frame that there is not is a mistake.
    pose_in_world(space, REST, request.frame)
    poses = [pose_in_world(space, pose, request.frame) for pose in _tuples(request.poses)]
    capacity.check_poses(space, rigids, poses)
    _set_poses(space, rigids, poses)
    for rigid, twist in zip(rigids, _tuples(request.twists), strict=False):
        space.set_twist(rigid, twist)
    for rigid, wrench in zip(rigids, _tuples(request.wrenches), strict=False):
        space.set_wrench(rigid, wrench, until)
    return _told('commanded', request.names)


def check_command(body: Body, request: Command) -> None:
    """
    Refuse a command that a body cannot obey.

    :raises Anchored: it is anchored, and takes a pose only
    :raises BadProperty: it is kinematic, and forces do not move it
    """
    if body.anchored and (request.twists.size or request.wrenches.size):
        raise Anchored(f'{body.name} is anchored; it takes a pose only', field='joint_names')
    if body.kinematic and request.wrenches.size:
        raise BadProperty(f'{body.name} is kinematic; forces do not move it', field='wrench')


def set_anchored(space: Space, point: Point, capacity: Capacity, *, anchored: bool) -> Done:
    """
    Anchor or release the topmost body under a point of the world [m].

    :raises NothingThere: there is none
    """
    x, y = point
    name = next(iter(space.bodies.at(point)), None)
    if name is None:
        raise NothingThere(f'there is no body at ({x:g}, {y:g})', field='point')
    rigid = space.bodies.by_name[name]
    if rigid.body.anchored != anchored:
        body = replace(rigid.body, anchored=anchored)
        if not anchored:
            capacity.check_body(space, body, rigid.pose, old=rigid)
        space.change(rigid, body, rigid.pose, REST)
    if anchored:
        return name, f'anchored {name}'
    loosened = joint_requests.loosen(space, name, point)
    return name, ' and removed '.join((f'released {name}', *loosened))


def delete_bodies(space: Space, names: tuple[str, ...], field: str = 'names') -> Done:
    """
    Remove bodies, and their joints.

    :param field: of the request, for the refusal
    :raises UnknownBody: there is no body of one of the names; nothing is changed
    """
    for name in names:
        body_of_name(space, name, field)
    for name in names:
        space.remove(name)
    return _told('deleted', names)


def delete_all(space: Space, namespace: str | None) -> Done:
    """Remove all bodies, or all of a namespace, and their joints."""
    names = [
        name
        for name in space.bodies.by_name
        if namespace is None or split_name(name)[0] == namespace
    ]
    delete_bodies(space, tuple(names))
    return '', f'deleted {len(names)} {"body" if len(names) == 1 else "bodies"}'


def _tuples(rows: Floats) -> Iterator[Pose]:
    """Return rows of three numbers as tuples."""
    return ((x, y, z) for x, y, z in rows.tolist())


def _told(verb: str, names: tuple[str, ...]) -> Done:
    if len(names) == 1:
        return names[0], f'{verb} {names[0]}'
    return '', f'{verb} {len(names)} bodies'


def _set_poses(space: Space, rigids: list[RigidBody], poses: list[Pose]) -> None:
    """Set the poses of bodies, if there are any."""
    for rigid, pose in zip(rigids, poses, strict=False):
        space.set_pose(rigid, pose)


def _change(
    space: Space,
    old: RigidBody,
    changes: dict[str, Any],
    pose: Pose,
    *,
    properties: Properties,
    capacity: Capacity,
) -> None:
    body = changed_body(old.body, changes, properties)
    twist = REST if old.body.anchored else space.twist_of(old)
    twist = changed_twist(body, twist, properties)
    if (body.shape, body.anchored, pose) != (old.body.shape, old.body.anchored, old.pose):
        capacity.check_body(space, body, pose, old=old)
    space.change(old, body, pose, twist)
