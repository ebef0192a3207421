# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Builders of the messages that a world takes, so that a line of a test is enough for each.

Properties of bodies and joints are given by keyword: `disc('ball/0', at=(0, 5), elasticity=0.9)`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import json
from typing import Any, TypedDict, Unpack

from builtin_interfaces.msg import Duration
from geometry_msgs.msg import Point, PointStamped, Transform, Twist, Vector3, Wrench
from physsim_ros.model.colors import color_from
from physsim_ros.ros.planar import pose_message, rotation_of
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker

Numbers = Sequence[float]


class BodyProperties(TypedDict, total=False):
    """Properties of a body (`model.body_properties.Properties`); None restores the default."""

    # properties: made by `make tables`
    mass: float | None
    density: float | None
    friction: float | None
    elasticity: float | None
    velocity: Numbers | None
    spin: float | None
    anchored: bool | None
    kinematic: bool | None
    group: int | None
    sensor: bool | None
    surface_velocity: Numbers | None
    belt: float | None
    rolling_resistance: float | None
    one_way: Numbers | None
    closed_sides: bool | None
    robot: str | Mapping[str, Any] | None
    towed: Mapping[str, Any] | None
    actor: Mapping[str, Any] | None
    forces: Sequence[Mapping[str, Any]] | None
    charge: float | None
    medium: Mapping[str, Any] | None
    label: str | None


# end: made by `make tables`
class MarkerOptions(BodyProperties, total=False):
    """
    What the markers of all shapes may have.

    :ivar at: x, y [m] and, where there are three, yaw [rad]
    :ivar frame: name of a body, in whose frame `at` is; '' is the world
    :ivar color: '#rrggbb', or red, green, blue, alpha, 0 .. 1; alpha 0 is the world's choice
    :ivar lifetime: simulation time after which the body is removed [s]; 0 is for ever
    :ivar text: properties as a YAML mapping, if they are not given by keyword
    """

    at: Numbers
    frame: str
    color: Numbers | str
    lifetime: float
    text: str


def disc(name: str = 'body/0', *, diameter: float = 1.0, **more: Unpack[MarkerOptions]) -> Marker:
    """Return the marker of a disc, whose diameter is in metres."""
    return marker(Marker.CYLINDER, name, scale=(diameter, diameter, 0.1), **more)


def box(
    name: str = 'body/0', *, size: tuple[float, float] = (1.0, 1.0), **more: Unpack[MarkerOptions]
) -> Marker:
    """Return the marker of a box, whose size is width and height [m]."""
    return marker(Marker.CUBE, name, scale=(*size, 0.1), **more)


def polygon(
    name: str = 'body/0', *, outline: Sequence[Numbers], **more: Unpack[MarkerOptions]
) -> Marker:
    """Return the marker of a solid polygon, whose corners are in order, x and y [m] each."""
    is_open = len(outline) > 0 and tuple(outline[0]) != tuple(outline[-1])
    closed = [*outline, *outline[:1]] if is_open else outline
    return marker(Marker.LINE_STRIP, name, scale=(0.02, 0.0, 0.0), points=closed, **more)


def chain(
    name: str = 'body/0',
    *,
    points: Sequence[Numbers],
    thickness: float = 0.1,
    **more: Unpack[MarkerOptions],
) -> Marker:
    """Return the marker of a chain of segments, for walls and terrain, in metres."""
    return marker(Marker.LINE_STRIP, name, scale=(thickness, 0.0, 0.0), points=points, **more)


def marker(
    kind: int,
    name: str = 'body/0',
    *,
    at: Numbers = (0.0, 0.0),
    scale: Numbers = (1.0, 1.0, 0.1),
    points: Sequence[Numbers] = (),
    text: str = '',
    frame: str = '',
    color: Numbers | str = (0.0, 0.0, 0.0, 0.0),
    lifetime: float = 0.0,
    action: int = Marker.ADD,
    **properties: Unpack[BodyProperties],
) -> Marker:
    """
    Return a marker; `MarkerOptions` has what the keywords mean.

    :param kind: type of the marker, which with `scale` and `points` is the shape
    :param name: as the world will call the body; '/7' has no namespace
    :raises TypeError: there are properties by keyword and in `text`
    :raises ValueError: the name has no number after a slash
    """
    if text and properties:
        raise TypeError('properties are given by keyword or in text, not both')
    namespace, slash, id_ = name.rpartition('/')
    if not slash or not id_.removeprefix('-').isdecimal():
        raise ValueError(f'a name is a namespace, / and a number, as box/0; got {name!r}')
    if len(at) not in {2, 3}:
        raise ValueError(f'at is x and y, or x, y and yaw; got {at!r}')
    x, y, yaw = (*at, 0.0)[:3]
    seconds, fraction = divmod(lifetime, 1.0)
    channels = color_from(color) if isinstance(color, str) else color
    return Marker(
        header=Header(frame_id=frame),
        ns=namespace,
        id=int(id_),
        type=kind,
        action=action,
        pose=pose_message((float(x), float(y), yaw)),
        scale=Vector3(**dict(zip('xyz', map(float, scale), strict=False))),
        color=ColorRGBA(**dict(zip('rgba', map(float, channels), strict=True))),
        lifetime=Duration(sec=int(seconds), nanosec=round(fraction * 1e9)),
        points=[Point(x=float(x), y=float(y)) for x, y in points],
        text=json.dumps(properties) if properties else text,
    )


def joint(
    kind: str, points: Sequence[Numbers], name: str = 'joint/0', *, frame: str = '', **terms: Any
) -> Marker:
    """
    Return the marker of a joint, for `~/join`.

    :param kind: as `axle` or `spring`
    :param points: one or two, as the kind has [m]
    :param terms: the bodies `a` and `b`, if they are not those under the points, and properties
    """
    text = json.dumps({'kind': kind, **terms})
    return marker(Marker.LINE_LIST, name, points=points, text=text, frame=frame)


def delete(name: str) -> Marker:
    """Return the marker that deletes a body or joint."""
    return marker(Marker.ARROW, name, action=Marker.DELETE)


def delete_all(namespace: str = '') -> Marker:
    """Return the marker that deletes all bodies or joints, or those of a namespace."""
    return Marker(ns=namespace, action=Marker.DELETEALL)


def point(x: float, y: float, frame: str = '') -> PointStamped:
    """Return a point [m] in the frame of a body, or '' for the world."""
    return PointStamped(header=Header(frame_id=frame), point=Point(x=float(x), y=float(y)))


def command(
    *names: str,
    poses: Sequence[Numbers] = (),
    twists: Sequence[Numbers] = (),
    wrenches: Sequence[Numbers] = (),
    frame: str = '',
) -> MultiDOFJointState:
    """
    Return a command for bodies, which has a pose, twist or wrench for each, or none.

    :param poses: x, y [m], yaw [rad]
    :param twists: vx, vy [m/s], spin [rad/s]
    :param wrenches: fx, fy [N], torque [N m]
    """
    return MultiDOFJointState(
        header=Header(frame_id=frame),
        joint_names=list(names),
        transforms=[
            Transform(translation=Vector3(x=float(x), y=float(y)), rotation=rotation_of(yaw))
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
