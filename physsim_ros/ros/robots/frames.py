# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The frames of a robot (REP 105), the transforms between them, and its description as URDF.

`odom` to `base_footprint` moves, as the odometry reckons, and each link on the one that it hangs
on; `base_footprint` to `base_link` and from links to their sensors stays. A link has its frame at
the point of the joint that it hangs on, about which the joint turns in URDF. Where the robot
really is, on `ground_truth`, is no transform: a localiser publishes `map` to `odom`.

RViz and others show a robot by its description: no meshes, no wheels. A disc of the shape is a
cylinder, a segment a box with two cylinders, a polygon the box around it. The links are the frames
of the robot, whose transforms the node publishes itself; positions of joints are those of
`joint_states`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import StrEnum
import math
from typing import Any
from xml.etree import ElementTree as ET

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Transform, TransformStamped, Vector3
from physsim_ros.model.joints import DEFAULTS as JOINT_DEFAULTS
from physsim_ros.model.joints import JointKind
from physsim_ros.model.robots import BASE as ROBOT_BASE
from physsim_ros.model.robots import Link, part_name, Robot, Sensor
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import Capsule, Circle, Convex, Piece
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import (
    local_to_world,
    ORIGIN,
    Point,
    Pose,
    rotated,
    world_to_local,
)
from physsim_ros.ros.planar import rotation_of

ODOM, FOOTPRINT, BASE = 'odom', 'base_footprint', 'base_link'
# Depth of `/tf`: that of tf2_ros.
TF_DEPTH = 100
# Limit of a joint without one [m], which URDF needs.
_UNLIMITED = 1e3
# Height of a robot in its description [m], which the world does not know: that of small ones.
_HEIGHT = 0.1


class RobotTf(StrEnum):
    """
    Where transforms of robots are published.

    Prefixed: on `/tf`, names of frames begin with the namespace; namespaced: on `<namespace>/tf`,
    plain names, as Nav2 has several robots.
    """

    PREFIXED = 'prefixed'
    NAMESPACED = 'namespaced'
    NONE = 'none'


class RobotFrames:
    """
    The frames of a robot.

    :param namespace: of the robot, '' or one without a slash in front
    :param robot_tf: where its transforms are published
    """

    def __init__(self, namespace: str, robot_tf: RobotTf) -> None:
        plain = not namespace or robot_tf is RobotTf.NAMESPACED
        self._prefix = '' if plain else f'{namespace}/'

    def name(self, frame: str) -> str:
        """Return the name of a frame, as `odom` or that of a sensor."""
        return f'{self._prefix}{frame}'

    def moving(self, stamp: Time, odometry: Pose) -> TransformStamped:
        """
        Return the transform from `odom` to `base_footprint`.

        :param odometry: x, y [m], yaw [rad] that the robot reckons
        """
        return self._transform(stamp, ODOM, FOOTPRINT, odometry)

    def fixed(self, stamp: Time, robot: Robot) -> list[TransformStamped]:
        """Return the transforms that stay: of `base_link`, and of the places of the sensors."""
        return [
            self._transform(stamp, FOOTPRINT, BASE, (0.0, 0.0, 0.0)),
            *(
                self._transform(stamp, _frame(each.link), each.name, _mounting(robot, each))
                for each in robot.sensors
            ),
        ]

    def of_links(
        self, stamp: Time, snapshot: Snapshot, body: str, robot: Robot
    ) -> list[TransformStamped]:
        """
        Return the transforms of links, each to the one that it hangs on; of those that are there.

        :param body: name of the robot's body
        """
        rows = snapshot.scene.row_of
        transforms = []
        for link in robot.links:
            above = robot.joint_above(link.name).b
            ends = part_name(body, above), part_name(body, link.name)
            if all(end in rows for end in ends):
                poses = (snapshot.poses[rows[end]].tolist() for end in ends)
                origin, place = (
                    _combined((x, y, yaw), (*_origin(robot, each), 0.0))
                    for (x, y, yaw), each in zip(poses, (above, link.name), strict=True)
                )
                pose = _seen_from(origin, place)
                transforms.append(self._transform(stamp, _frame(above), link.name, pose))
        return transforms

    def _transform(self, stamp: Time, parent: str, child: str, pose: Pose) -> TransformStamped:
        message = TransformStamped(child_frame_id=self.name(child))
        message.header.stamp, message.header.frame_id = stamp, self.name(parent)
        x, y, yaw = pose
        message.transform = Transform(translation=Vector3(x=x, y=y), rotation=rotation_of(yaw))
        return message


def tf_message_type() -> Any:
    """Return the type of messages on `/tf`; None where its package is not installed."""
    try:
        from tf2_msgs.msg import TFMessage  # noqa: PLC0415 - no part of common_interfaces
    except ModuleNotFoundError:
        return None
    return TFMessage


def urdf_of(body: Body, frames: RobotFrames, parts: Sequence[tuple[Link, Body]] = ()) -> str:
    """
    Return the URDF of a robot.

    :param body: of the robot
    :param frames: of the robot
    :param parts: links of the robot, and their bodies
    """
    assert body.robot is not None  # noqa: S101 - by the contract above
    urdf = ET.Element('robot', name=body.name)
    _add_color(urdf, 'body', body)
    ET.SubElement(urdf, 'link', name=frames.name(FOOTPRINT))
    base = ET.SubElement(urdf, 'link', name=frames.name(BASE))
    _add_body(base, body, (0.0, 0.0), 'body')
    _join(urdf, frames, FOOTPRINT, BASE, ORIGIN)
    robot = body.robot
    for link, part in parts:
        _add_color(urdf, link.name, part)
        element = ET.SubElement(urdf, 'link', name=frames.name(link.name))
        _add_body(element, part, _origin(robot, link.name), link.name)
        _join_link(urdf, frames, robot, link)
    for sensor in robot.sensors:
        ET.SubElement(urdf, 'link', name=frames.name(sensor.name))
        _join(urdf, frames, _frame(sensor.link), sensor.name, _mounting(robot, sensor))
    return ET.tostring(urdf, encoding='unicode')


def _add_color(urdf: ET.Element, name: str, body: Body) -> None:
    material = ET.SubElement(urdf, 'material', name=name)
    ET.SubElement(material, 'color', rgba=' '.join(f'{each:g}' for each in body.color))


def _add_body(element: ET.Element, body: Body, origin: Point, material: str) -> None:
    """
    Add shape and inertia of a body to a link.

    :param origin: of the frame of the link in that of the body [m]
    """
    for x, y, yaw, geometry in _geometries(body):
        for kind in ('visual', 'collision'):
            part = ET.SubElement(element, kind)
            place = f'{x - origin[0]:.9g} {y - origin[1]:.9g} {_HEIGHT / 2:g}'
            ET.SubElement(part, 'origin', xyz=place, rpy=f'0 0 {yaw:.9g}')
            ET.SubElement(part, 'geometry').append(geometry)
            if kind == 'visual':
                ET.SubElement(part, 'material', name=material)
    _add_inertia(element, body, origin)


# Types of URDF by the kinds of joints.
_TYPES = {
    JointKind.PIN: 'fixed',
    JointKind.AXLE: 'revolute',
    JointKind.MOTOR: 'continuous',
    JointKind.SLIDER: 'prismatic',
}


def _join_link(urdf: ET.Element, frames: RobotFrames, robot: Robot, link: Link) -> None:
    """Add the joint that a link hangs on."""
    above, properties = robot.joint_above(link.name), robot.joint_above(link.name).properties
    limits = properties.lower, properties.upper
    kind = _TYPES[above.kind]
    if kind == 'revolute' and None in limits:
        kind = 'continuous'
    place = _combined(link.at, (*_origin(robot, link.name), 0.0))
    parent = _combined(robot.place_of(above.b), (*_origin(robot, above.b), 0.0))
    joint = _add_joint(
        urdf,
        above.name,
        kind,
        (frames.name(_frame(above.b)), frames.name(link.name)),
        _seen_from(parent, place),
    )
    if kind == 'prismatic':
        (x1, y1), (x2, y2) = above.points
        x, y = rotated((x2 - x1, y2 - y1), -link.at[2])
        length = math.hypot(x, y)
        ET.SubElement(joint, 'axis', xyz=f'{x / length:.9g} {y / length:.9g} 0')
    elif kind != 'fixed':
        ET.SubElement(joint, 'axis', xyz='0 0 1')
    span: dict[str, float] = {}
    if kind in ('prismatic', 'revolute'):
        span = {
            'lower': -_UNLIMITED if limits[0] is None else limits[0],
            'upper': _UNLIMITED if limits[1] is None else limits[1],
        }
    # URDF asks for both where there are limits; a motor has them in any case.
    if span or properties.effort:
        speed = properties.max_speed
        values = {
            **span,
            'effort': properties.effort or 0.0,
            'velocity': JOINT_DEFAULTS['max_speed'] if speed is None else speed,
        }
        ET.SubElement(joint, 'limit', {key: f'{value:.9g}' for key, value in values.items()})


def _geometries(body: Body) -> Iterator[tuple[float, float, float, ET.Element]]:
    """Yield the place x, y [m] and yaw [rad] of each geometry, and the geometry."""
    for piece in body.shape.form.pieces:
        yield from _geometries_of(piece)


def _geometries_of(piece: Piece) -> Iterator[tuple[float, float, float, ET.Element]]:
    match piece:
        case Circle((x, y), radius):
            yield x, y, 0.0, _cylinder(radius)
        case Capsule(start, end, radius):
            for x, y in (start, end):
                yield x, y, 0.0, _cylinder(radius)
            yaw = math.atan2(end[1] - start[1], end[0] - start[0])
            x, y = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
            yield x, y, yaw, _box(math.dist(start, end), 2 * radius)
        case Convex(vertices):
            xs, ys = zip(*vertices, strict=True)
            middle = (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2
            yield *middle, 0.0, _box(max(xs) - min(xs), max(ys) - min(ys))


def _cylinder(radius: float) -> ET.Element:
    return ET.Element('cylinder', radius=f'{radius:.9g}', length=f'{_HEIGHT:g}')


def _box(width: float, depth: float) -> ET.Element:
    return ET.Element('box', size=f'{width:.9g} {depth:.9g} {_HEIGHT:g}')


def _add_inertia(link: ET.Element, body: Body, origin: Point) -> None:
    mass, form = body.total_mass, body.shape.form
    x, y = form.centroid[0] - origin[0], form.centroid[1] - origin[1]
    inertial = ET.SubElement(link, 'inertial')
    ET.SubElement(inertial, 'origin', xyz=f'{x:.9g} {y:.9g} {_HEIGHT / 2:g}')
    ET.SubElement(inertial, 'mass', value=f'{mass:.9g}')
    # Only turns about z are known; of a flat body, the other two share that one.
    about_z = mass * form.gyration
    about = {'ixx': about_z / 2, 'iyy': about_z / 2, 'izz': about_z}
    values = {
        key: f'{about.get(key, 0.0):.9g}' for key in ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')
    }
    ET.SubElement(inertial, 'inertia', values)


def _join(
    urdf: ET.Element,
    frames: RobotFrames,
    parent: str,
    child: str,
    pose: tuple[float, float, float],
) -> None:
    ends = frames.name(parent), frames.name(child)
    _add_joint(urdf, f'{frames.name(child)}_joint', 'fixed', ends, pose)


def _add_joint(
    urdf: ET.Element, name: str, kind: str, ends: tuple[str, str], pose: Pose
) -> ET.Element:
    """Add a joint between a parent and a child, with the pose of the child at 0; return it."""
    x, y, yaw = pose
    joint = ET.SubElement(urdf, 'joint', name=name, type=kind)
    ET.SubElement(joint, 'parent', link=ends[0])
    ET.SubElement(joint, 'child', link=ends[1])
    ET.SubElement(joint, 'origin', xyz=f'{x:.9g} {y:.9g} 0', rpy=f'0 0 {yaw:.9g}')
    return joint


def _frame(link: str) -> str:
    """Return the frame of a link."""
    return BASE if link == ROBOT_BASE else link


def _origin(robot: Robot, link: str) -> Point:
    """Return the origin of the frame of a link in that of its body [m]."""
    if link == ROBOT_BASE:
        return ORIGIN[:2]
    return world_to_local(robot.joint_above(link).points[0], robot.place_of(link))


def _mounting(robot: Robot, sensor: Sensor) -> Pose:
    """Return the pose of a sensor in the frame of its link."""
    x, y = _origin(robot, sensor.link)
    return sensor.at[0] - x, sensor.at[1] - y, sensor.at[2]


def _combined(pose: Pose, inner: Pose) -> Pose:
    """Return a pose in a frame that has a pose itself."""
    return *local_to_world(inner[:2], pose), pose[2] + inner[2]


def _seen_from(pose: Pose, other: Pose) -> Pose:
    """Return another pose as seen from a pose."""
    return *world_to_local(other[:2], pose), other[2] - pose[2]
