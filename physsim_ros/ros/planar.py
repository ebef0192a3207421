# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The plane in messages: poses and rotations about z, and frames, of messages and as messages.

Law: a rotation that is not about z is refused; all zero is the identity, as RViz reads it.
"""

from __future__ import annotations

import math

from geometry_msgs.msg import Point, PointStamped, Quaternion
from geometry_msgs.msg import Pose as PoseMessage
from physsim_ros.model.errors import Malformed, NotPlanar
from physsim_ros.model.transform import Pose

# The greatest roll and pitch of a planar rotation [rad]: rounding errors of float32 tools.
MOST_TILT = 1e-3


def rotation_of(yaw: float) -> Quaternion:
    """Return a rotation about z [rad] as a message."""
    return Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))


def pose_message(pose: Pose) -> PoseMessage:
    """Return a pose in the plane, x, y [m] and yaw [rad], as a message."""
    x, y, yaw = pose
    return PoseMessage(position=Point(x=x, y=y), orientation=rotation_of(yaw))


def planar_pose(pose: PoseMessage, field: str) -> Pose:
    """
    Return x, y [m] and yaw [rad] of a pose; the position is not validated.

    :param field: of the message, for the refusal
    :raises Malformed: the rotation is not finite
    :raises NotPlanar: it is not about z
    """
    yaw = yaw_of(pose.orientation, f'{field}.orientation')
    return pose.position.x, pose.position.y, yaw


def yaw_of(rotation: Quaternion, field: str) -> float:
    """
    Return the yaw of a rotation [rad].

    :param field: of the message, for the refusal
    :raises Malformed: it is not finite
    :raises NotPlanar: it is not about z
    """
    parts = rotation.x, rotation.y, rotation.z, rotation.w
    if not all(map(math.isfinite, parts)):
        raise Malformed('{field} is not finite', field=field)
    largest = max(map(abs, parts))
    if largest == 0.0:
        return 0.0
    # Scaled by its largest part first, so that squares neither overflow nor underflow.
    x, y, z, w = (part / largest for part in parts)
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    x, y, z, w = x / norm, y / norm, z / norm, w / norm
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    if max(abs(roll), abs(pitch)) > MOST_TILT:
        template = '{field} has roll {roll:.3g} and pitch {pitch:.3g} rad; the world is a plane'
        raise NotPlanar(template, field=field, roll=roll, pitch=pitch)
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def named_frame(frame: str, world_frame: str) -> str:
    """Return a frame, '' for the world, which is the empty one, too."""
    return '' if frame in ('', world_frame) else frame


def point_in_frame(message: PointStamped, frame_id: str) -> tuple[tuple[float, float], str]:
    """Return a point [m] and its frame, '' for the world; neither is validated."""
    return (message.point.x, message.point.y), named_frame(message.header.frame_id, frame_id)
