# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""What handlers share: bodies, poses and points of a request, found in a space."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.space import Space
from physsim_ros.model.checks import check_pose
from physsim_ros.model.errors import no_body, UnknownFrame
from physsim_ros.model.scene import Body
from physsim_ros.model.texts import nearest_name
from physsim_ros.model.transform import local_to_world, Point, Pose


def body_of_name(
    space: Space, name: str, field: str = 'name', *, others: tuple[str, ...] = ()
) -> RigidBody:
    """
    Return the body of a name.

    :param field: of the request, for the refusal
    :param others: names that the request takes beside those of bodies
    :raises UnknownBody: there is none
    """
    if name not in space.bodies.by_name:
        raise no_body(name, (*others, *space.bodies.by_name), field)
    return space.bodies.by_name[name]


def check_start(body: Body, names: Collection[str]) -> None:
    """
    Refuse an actor that waits for a body that there is not.

    :param names: of the bodies of the world
    :raises UnknownBody: the field is the key of `start`
    """
    waits_for = {} if body.actor is None else body.actor.start.bodies
    for field, name in waits_for.items():
        if name not in names:
            raise no_body(name, names, field)


def pose_in_world(space: Space, pose: Pose, frame: str) -> Pose:
    """
    Return a pose of a frame as a pose of the world.

    :param frame: '' for the world, or a body's name
    :raises UnknownFrame: there is no such body
    :raises BadProperty: the pose is too far away
    """
    if not frame:
        return pose
    if frame not in space.bodies.by_name:
        raise UnknownFrame(
            f'frame {frame!r} is neither the world nor a body'
            f'{nearest_name(frame, space.bodies.by_name)}',
            field='header.frame_id',
        )
    origin = space.bodies.by_name[frame].pose
    result = (*local_to_world(pose[:2], origin), origin[2] + pose[2])
    check_pose(result, 'pose')
    return result


def points_in_world(space: Space, points: Iterable[Point], frame: str) -> tuple[Point, ...]:
    """Return points of a frame as points of the world; raises as `pose_in_world`."""
    return tuple(pose_in_world(space, (*point, 0.0), frame)[:2] for point in points)
