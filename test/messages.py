# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages as people write them: one line each, so that a test shows what matters in it."""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import Any

from builtin_interfaces.msg import Duration
from geometry_msgs.msg import (
    Point,
    PointStamped,
    Pose,
    Quaternion,
    Transform,
    Twist,
    Vector3,
    Wrench,
)
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker

Number3 = tuple[float, float, float]

# A concave outline, closed as a marker closes it: an L of two bars, 3 m² [m].
ELL = ((0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0), (0.0, 0.0))


def rotation(yaw: float) -> Quaternion:
    return Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))


def yaw_of(quaternion: Quaternion) -> float:
    return 2 * math.atan2(quaternion.z, quaternion.w)


def marker(
    kind: int,
    name: str = 'body/0',
    *,
    at: Sequence[float] = (0.0, 0.0),
    scale: Sequence[float] = (1.0, 1.0, 0.1),
    points: Sequence[Sequence[float]] = (),
    text: str = '',
    frame: str = '',
    color: Sequence[float] = (0.0, 0.0, 0.0, 0.0),
    lifetime: float = 0.0,
    action: int = Marker.ADD,
) -> Marker:
    """
    Return a marker.

    :param name: as the world will call the body; '/7' has no namespace
    :param at: x, y [m] and, where there are three, yaw [rad]
    """
    namespace, _, id_ = name.rpartition('/')
    x, y, yaw = (*at, 0.0)[:3]
    seconds, fraction = divmod(lifetime, 1.0)
    return Marker(
        header=Header(frame_id=frame),
        ns=namespace,
        id=int(id_),
        type=kind,
        action=action,
        pose=Pose(position=Point(x=float(x), y=float(y)), orientation=rotation(yaw)),
        scale=Vector3(**dict(zip('xyz', map(float, scale), strict=False))),
        color=ColorRGBA(**dict(zip('rgba', map(float, color), strict=True))),
        lifetime=Duration(sec=int(seconds), nanosec=round(fraction * 1e9)),
        points=[Point(x=float(x), y=float(y)) for x, y in points],
        text=text,
    )


def box(name: str = 'body/0', *, size: tuple[float, float] = (1.0, 1.0), **more: Any) -> Marker:
    return marker(Marker.CUBE, name, scale=(*size, 0.1), **more)


def disc(name: str = 'body/0', *, diameter: float = 1.0, **more: Any) -> Marker:
    return marker(Marker.CYLINDER, name, scale=(diameter, diameter, 0.1), **more)


def polygon(name: str = 'body/0', *, outline: Sequence[Sequence[float]], **more: Any) -> Marker:
    """Return a line strip; its outline has to end where it began to be a polygon."""
    return marker(Marker.LINE_STRIP, name, scale=(0.02, 0.0, 0.0), points=outline, **more)


def delete(name: str) -> Marker:
    return marker(0, name, action=Marker.DELETE)


def delete_all(namespace: str = '') -> Marker:
    return Marker(ns=namespace, action=Marker.DELETEALL)


def point(x: float, y: float, frame: str = '') -> PointStamped:
    return PointStamped(header=Header(frame_id=frame), point=Point(x=float(x), y=float(y)))


def command(
    *names: str,
    poses: Sequence[Number3] = (),
    twists: Sequence[Number3] = (),
    wrenches: Sequence[Number3] = (),
    frame: str = '',
) -> MultiDOFJointState:
    """
    Return a command.

    :param poses: x, y [m], yaw [rad]
    :param twists: vx, vy [m/s], spin [rad/s]
    :param wrenches: fx, fy [N], torque [N m]
    """
    return MultiDOFJointState(
        header=Header(frame_id=frame),
        joint_names=list(names),
        transforms=[
            Transform(translation=Vector3(x=float(x), y=float(y)), rotation=rotation(yaw))
            for x, y, yaw in poses
        ],
        twist=[
            Twist(linear=Vector3(x=float(x), y=float(y)), angular=Vector3(z=float(spin)))
            for x, y, spin in twists
        ],
        wrench=[
            Wrench(force=Vector3(x=float(x), y=float(y)), torque=Vector3(z=float(torque)))
            for x, y, torque in wrenches
        ],
    )
