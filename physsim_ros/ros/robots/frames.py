# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The frames of a robot (REP 105), the transforms between them, and its description as URDF.

`odom` to `base_footprint` moves, as the odometry reckons; `base_footprint` to `base_link` and from
that to the sensors stays. Where the robot really is, on `ground_truth`, is no transform: a
localiser publishes `map` to `odom`.

RViz and others show a robot by its description: no meshes, no wheels. A disc of the shape is a
cylinder, a segment a box with two cylinders, a polygon the box around it. The links are the frames
of the robot, whose transforms the node publishes itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum
import math
from typing import Any
from xml.etree import ElementTree as ET

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Transform, TransformStamped, Vector3
from physsim_ros.model.robots import Robot
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import Capsule, Circle, Convex, Piece
from physsim_ros.model.transform import Pose
from physsim_ros.ros.planar import rotation_of

ODOM, FOOTPRINT, BASE = 'odom', 'base_footprint', 'base_link'
# Depth of `/tf`: that of tf2_ros.
TF_DEPTH = 100
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
            *(self._transform(stamp, BASE, each.name, each.at) for each in robot.sensors),
        ]

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


def urdf_of(body: Body, frames: RobotFrames) -> str:
    """
    Return the URDF of a robot.

    :param body: of the robot
    :param frames: of the robot
    """
    assert body.robot is not None  # noqa: S101 - by the contract above
    urdf = ET.Element('robot', name=body.name)
    material = ET.SubElement(urdf, 'material', name='body')
    ET.SubElement(material, 'color', rgba=' '.join(f'{each:g}' for each in body.color))
    ET.SubElement(urdf, 'link', name=frames.name(FOOTPRINT))
    base = ET.SubElement(urdf, 'link', name=frames.name(BASE))
    for x, y, yaw, geometry in _geometries(body):
        for kind in ('visual', 'collision'):
            part = ET.SubElement(base, kind)
            place, turn = f'{x:.9g} {y:.9g} {_HEIGHT / 2:g}', f'0 0 {yaw:.9g}'
            ET.SubElement(part, 'origin', xyz=place, rpy=turn)
            ET.SubElement(part, 'geometry').append(geometry)
            if kind == 'visual':
                ET.SubElement(part, 'material', name='body')
    _add_inertia(base, body)
    _join(urdf, frames, FOOTPRINT, BASE, (0.0, 0.0, 0.0))
    for sensor in body.robot.sensors:
        ET.SubElement(urdf, 'link', name=frames.name(sensor.name))
        _join(urdf, frames, BASE, sensor.name, sensor.at)
    return ET.tostring(urdf, encoding='unicode')


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


def _add_inertia(link: ET.Element, body: Body) -> None:
    mass, form = body.total_mass, body.shape.form
    x, y = form.centroid
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
    x, y, yaw = pose
    joint = ET.SubElement(urdf, 'joint', name=f'{frames.name(child)}_joint', type='fixed')
    ET.SubElement(joint, 'parent', link=frames.name(parent))
    ET.SubElement(joint, 'child', link=frames.name(child))
    ET.SubElement(joint, 'origin', xyz=f'{x:.9g} {y:.9g} 0', rpy=f'0 0 {yaw:.9g}')
