# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests for bodies: spawned, changed, moved, commanded, anchored, deleted.

Laws: everything is checked before anything is changed: a handler that raises a `Refusal` has
changed nothing, but `spawn` of a robot and `cut`, which end with the joints. A body that is
spawned where it already is, in the colour that it has, keeps both to the bit, so that markers
which are published back change nothing.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
import math
from typing import Any

from physsim_ros.engine.bodies import RigidBody
from physsim_ros.engine.space import Space
from physsim_ros.model.answer import Answer
from physsim_ros.model.arrays import Floats
from physsim_ros.model.body_description import (
    changed_body,
    changed_twist,
    check_command,
    check_start,
    fields_set_by,
    new_body,
)
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.checks import check_pose
from physsim_ros.model.errors import BadProperty, nothing_at
from physsim_ros.model.names import names_in
from physsim_ros.model.requests import (
    Anchor,
    AtPoint,
    ChangeBody,
    Command,
    Cut,
    Delete,
    DeleteAll,
    DeleteBodies,
    MoveBodies,
    parts_of,
    Release,
    Spawn,
)
from physsim_ros.model.transform import local_to_world, ORIGIN, Point, Pose, REST
from physsim_ros.model.translation import counted, Text
from physsim_ros.simulation.world import joint_requests
from physsim_ros.simulation.world.assembly import (
    all_members,
    check_new_parts,
    check_same_parts,
    members,
    moving_with_parts,
    placed_with_parts,
)
from physsim_ros.simulation.world.live_space import LiveSpace
from physsim_ros.simulation.world.lookup import (
    body_of_name,
    is_same_pose,
    points_in_world,
    pose_in_world,
)
from physsim_ros.simulation.world.robot_requests import check_robot

# Difference within which two colours are the same [1]: markers have single precision.
_SAME_COLOR = 1e-6


def spawn(live: LiveSpace, request: Spawn) -> Answer:
    """
    Add a body, with its parts if it is a robot that has some, or change the one of that name.

    It may end half done: where a joint of a robot is refused.
    """
    space, name = live.space, request.name
    old = space.bodies.by_name.get(name)
    pose = pose_in_world(space, request.pose, request.frame)
    expires = live.step_after(request.lifetime)
    if old is not None:
        changes = fields_set_by(request, expires)
        if math.dist(changes.get('color', old.body.color), old.body.color) <= _SAME_COLOR:
            changes['color'] = old.body.color
        here = old.pose
        _change(live, old, changes, here if is_same_pose(here, pose) else pose, request)
        return Answer(subject=name, message=Text('changed {body}', body=name))
    links, joints = parts_of(replace(request, pose=pose, frame=''))
    check_new_parts(space, links, joints)
    made = [
        (*new_body(each, live.settings, expires), at)
        for each, at in ((request, pose), *((link, link.pose) for link in links))
    ]
    body = made[0][0]
    check_robot(space, body)
    check_start(body, space.bodies.by_name)
    live.capacity.check_robot(body)
    live.capacity.check_attraction(body)
    live.capacity.check_bodies([(each, at, None) for each, _, at in made])
    for each, twist, at in made:
        space.add(each, at, twist)
    for joint in joints:
        joint_requests.join(live, joint)
    message = Text('spawned {body}', body=name)
    if body.robot is not None and body.dynamic and any(live.settings.gravity):
        hint = 'gravity pulls it: robots are seen from above, with gravity [0, 0]'
        message = Text('{first}; {then}', first=message, then=Text(hint))
    return Answer(subject=name, message=message)


def change_body(live: LiveSpace, request: ChangeBody) -> Answer:
    """Change what a request names of a body."""
    space, name = live.space, request.name
    rigid = body_of_name(space, name)
    pose = rigid.pose
    if request.pose is not None:
        pose = pose_in_world(space, request.pose, request.frame)
    _change(live, rigid, fields_set_by(request), pose, request)
    return Answer(subject=name, message=Text('changed {body}', body=name))


def cut(live: LiveSpace, request: Cut) -> Answer:
    """
    Cut bodies into pieces, move joints and hands to them, and remove severed joints.

    It may end half done. Joints that have broken since the cut was drawn are ignored.

    :raises UnknownJoint: it would cut joints alone, all of which have broken
    """
    joints = live.space.joints.by_name
    severed = [each.name for each in request.severed if each.name in joints]
    if not severed and not request.pieces:
        joint_requests.check_names(live.space, (each.name for each in request.severed), 'severed')
    for name in severed:
        live.space.unjoin(name)
    whole = []
    for piece in request.pieces:
        if isinstance(piece, Spawn):
            spawn(live, piece)
        else:
            whole.append(change_body(live, piece).subject)
    for joint in request.joints:
        if joint.name in joints:
            joint_requests.rejoin(live, joint)
    _regrip(live.space, whole, {piece.name for piece in request.pieces})
    subjects = whole + severed
    subject = subjects[0] if len(subjects) == 1 else ''
    values = {'count': len(request.pieces), 'joints': ', '.join(severed)}
    if not whole:
        message = Text('cut {joints}', **values)
    elif severed:
        message = Text('cut into {count} pieces, {joints}', **values)
    else:
        message = Text('cut into {count} pieces', **values)
    return Answer(subject=subject, message=message)


def _regrip(space: Space, whole: Collection[str], pieces: Collection[str]) -> None:
    """Put the grips of hands on bodies that were cut on the pieces under their points."""
    for grip in [each for each in space.grips if each.body in whole]:
        point = local_to_world(grip.anchor, space.bodies.by_name[grip.body].pose)
        under = [name for name in space.bodies.at(point) if name in pieces]
        if under and grip.body not in under:
            space.set_grip(grip._replace(body=under[0]))


def move_bodies(live: LiveSpace, request: MoveBodies) -> Answer:
    """Move bodies by one vector; their velocities are kept."""
    space = live.space
    rigids = [body_of_name(space, name, 'names') for name in request.names]
    dx, dy = request.by
    poses = {
        rigid.body.name: (rigid.pose[0] + dx, rigid.pose[1] + dy, rigid.pose[2])
        for rigid in rigids
    }
    for pose in poses.values():
        check_pose(pose, 'by')
    set_poses(live, poses)
    return _done('moved {bodies}', request.names)


def command(live: LiveSpace, request: Command) -> Answer:
    """Set poses, twists or wrenches of bodies."""
    space = live.space
    rigids = [body_of_name(space, name, 'joint_names') for name in request.names]
    for rigid in rigids:
        check_command(rigid.body, request)
    # Refuses an unknown frame, though twists and wrenches are in world axes.
    pose_in_world(space, ORIGIN, request.frame)
    poses = [pose_in_world(space, pose, request.frame) for pose in _tuples(request.poses)]
    set_poses(live, dict(zip(request.names, poses, strict=False)))
    twists = dict(zip(request.names, _tuples(request.twists), strict=False))
    for name, twist in moving_with_parts(space, twists).items():
        space.set_twist(space.bodies.by_name[name], twist)
    until = live.step_after(live.settings.command_timeout)
    for rigid, wrench in zip(rigids, _tuples(request.wrenches), strict=False):
        space.set_wrench(rigid, wrench, until)
    quantities = {'pose': request.poses, 'velocity': request.twists, 'force': request.wrenches}
    said = ' and '.join(noun for noun, rows in quantities.items() if len(rows)) or 'nothing'
    return _done('set {quantities} of {bodies}', request.names, quantities=Text(said))


def anchor(live: LiveSpace, request: Anchor) -> Answer:
    """
    Anchor the topmost body at a point.

    :raises NothingThere: there is none
    :raises BadProperty: it is a robot or an actor
    """
    space = live.space
    rigid, _ = _topmost(space, request)
    for role, noun in ((rigid.body.robot, Text('a robot')), (rigid.body.actor, Text('an actor'))):
        if role is not None:
            template = '{body} is {noun}; it cannot be anchored'
            raise BadProperty(template, field='point', body=rigid.body.name, noun=noun)
    if not rigid.body.anchored:
        space.change(rigid, replace(rigid.body, anchored=True), rigid.pose, REST)
    return _done('anchored {bodies}', (rigid.body.name,))


def release(live: LiveSpace, request: Release) -> Answer:
    """
    Release the topmost body at a point, and remove the pins and axles there.

    :raises NothingThere: there is none
    :raises BadProperty: it is a region of a medium, which forces do not move
    """
    space = live.space
    rigid, point = _topmost(space, request)
    name = rigid.body.name
    if rigid.body.anchored:
        body = replace(rigid.body, anchored=False)
        if body.medium is not None and body.dynamic:
            raise BadProperty(
                '{body} is filled with a medium; it cannot be released', field='point', body=name
            )
        live.capacity.check_body(body, rigid.pose, old=rigid)
        space.change(rigid, body, rigid.pose, REST)
    loosened = joint_requests.loosen(space, name, point)
    if not loosened:
        return _done('released {bodies}', (name,))
    removed = ' and removed '.join(loosened)
    return _done('released {bodies} and removed {joints}', (name,), joints=removed)


def delete(live: LiveSpace, request: Delete) -> Answer:
    """Remove a body, or the robot of which it is a part, and its joints."""
    body_of_name(live.space, request.name)
    live.space.remove(members(live.space, request.name))
    return _done('deleted {bodies}', (request.name,))


def delete_bodies(live: LiveSpace, request: DeleteBodies) -> Answer:
    """
    Remove several bodies with their joints, and other joints.

    :raises UnknownBody: there is no body of a name
    :raises UnknownJoint: there is no joint of a name
    """
    joint_requests.check_names(live.space, request.joints, 'joints')
    for name in request.names:
        body_of_name(live.space, name, 'names')
    for name in request.joints:
        live.space.unjoin(name)
    live.space.remove(all_members(live.space, request.names))
    if request.names:
        return _done('deleted {bodies}', request.names)
    subject = request.joints[0] if len(request.joints) == 1 else ''
    deleted = counted(len(request.joints), 'joint')
    return Answer(subject=subject, message=Text('deleted {joints}', joints=deleted))


def delete_all(live: LiveSpace, request: DeleteAll) -> Answer:
    """Remove all bodies, or all of a namespace, and their joints."""
    names = all_members(live.space, names_in(live.space.bodies.by_name, request.namespace))
    if 0 < len(names) == len(live.space.bodies.by_name):
        # One by one, 15,000 bodies take a second.
        lesson = live.space.table.scene.lesson
        live.begin(WorldState(settings=live.settings, lesson=lesson), live.step_count)
    else:
        live.space.remove(names)
    return Answer(message=Text('deleted {bodies}', bodies=counted(len(names), 'body')))


def _topmost(space: Space, request: AtPoint) -> tuple[RigidBody, Point]:
    """Return the topmost body at the point of a request, and that point of the world [m]."""
    (point,) = points_in_world(space, (request.point,), request.frame)
    name = next(iter(space.bodies.at(point)), None)
    if name is None:
        raise nothing_at(point, 'point')
    return space.bodies.by_name[name], point


def _tuples(rows: Floats) -> Iterator[tuple[float, float, float]]:
    """Return rows of three numbers as tuples."""
    return ((x, y, z) for x, y, z in rows.tolist())


def _done(template: str, names: tuple[str, ...], **values: str) -> Answer:
    """Return the answer about bodies: by its name where it is one, else by their number."""
    subject = names[0] if len(names) == 1 else ''
    bodies = subject or counted(len(names), 'body')
    return Answer(subject=subject, message=Text(template, bodies=bodies, **values))


def set_poses(live: LiveSpace, poses: Mapping[str, Pose]) -> None:
    """
    Set the poses of bodies, and of parts that follow them.

    :raises WorldFull: too many pieces would overlap; nothing is changed
    """
    if not poses:
        return
    bodies = live.space.bodies.by_name
    placed = [(bodies[name], at) for name, at in placed_with_parts(live.space, poses).items()]
    live.capacity.check_bodies([(rigid.body, pose, rigid) for rigid, pose in placed])
    live.space.set_poses(placed)


def _change(
    live: LiveSpace,
    old: RigidBody,
    changes: dict[str, Any],
    pose: Pose,
    request: Spawn | ChangeBody,
) -> None:
    """Change fields and properties of a body, and its pose."""
    body = changed_body(old.body, changes, request, live.settings)
    check_robot(live.space, body)
    check_same_parts(old.body, body)
    if body.actor != old.body.actor:
        check_start(body, live.space.bodies.by_name)
    live.capacity.check_robot(body)
    live.capacity.check_attraction(body)
    twist = REST if old.body.anchored else live.space.twist_of(old)
    twist = changed_twist(body, twist, request)
    if (body.shape, body.anchored, pose) != (old.body.shape, old.body.anchored, old.pose):
        live.capacity.check_body(body, pose, old=old)
    followers = placed_with_parts(live.space, {body.name: pose}) if pose != old.pose else {}
    live.space.change(old, body, pose, twist)
    bodies = live.space.bodies.by_name
    live.space.set_poses(
        [(bodies[name], followers[name]) for name in followers if name != body.name]
    )
