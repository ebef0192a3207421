# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies, frames and places that a request names, as they are in a space."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
import math

from physsim_ros.engine.bodies import RigidBody
from physsim_ros.engine.space import Space
from physsim_ros.model.checks import check_pose
from physsim_ros.model.errors import no_body, no_frame
from physsim_ros.model.transform import local_to_world, Point, Pose

# Difference within which places are the same [1, of their size]: markers that come back have the
# digits of a double; no person draws a point twice so exactly.
_SAME = 1e-9


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
        raise no_frame(frame, space.bodies.by_name)
    origin = space.bodies.by_name[frame].pose
    result = (*local_to_world(pose[:2], origin), origin[2] + pose[2])
    check_pose(result, 'pose')
    return result


def are_same(points: Sequence[Point], others: Sequence[Point]) -> bool:
    """Return whether points are the same as others, but for rounding [m]."""
    size = 1.0 + max(abs(number) for point in points for number in point)
    pairs = zip(points, others, strict=True)
    return all(math.dist(here, there) <= _SAME * size for here, there in pairs)


def is_same_pose(pose: Pose, other: Pose) -> bool:
    """Return whether two poses are the same, but for rounding and whole turns [m, rad]."""
    turn = math.remainder(other[2] - pose[2], math.tau)
    return are_same((pose[:2],), (other[:2],)) and abs(turn) <= _SAME


def points_in_world(space: Space, points: Iterable[Point], frame: str) -> tuple[Point, ...]:
    """Return points of a frame as points of the world; raises as `pose_in_world`."""
    return tuple(pose_in_world(space, (*point, 0.0), frame)[:2] for point in points)
