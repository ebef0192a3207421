# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The description of a robot as URDF.

RViz and others show a robot by its description: no meshes, no wheels. A disc of the shape is a
cylinder, a segment a box with two cylinders, a polygon the box around it. The links are the frames
of the robot, whose transforms the node publishes itself; positions of joints are those of
`joint_states`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import math
from xml.etree import ElementTree as ET

from physsim_ros.model.joints import DEFAULTS as JOINT_DEFAULTS
from physsim_ros.model.joints import JointKind
from physsim_ros.model.robots import Link, Robot
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import Capsule, Circle, Convex, Piece
from physsim_ros.model.transform import composed, ORIGIN, Point, Pose, rotated, seen_from
from physsim_ros.ros.robots.frames import (
    BASE,
    FOOTPRINT,
    frame_of,
    mounting_of,
    origin_of,
    RobotFrames,
)

# Limit of a joint without one [m], which URDF needs.
_UNLIMITED = 1e3
# Height of a robot in its description [m], which the world does not know: that of small ones.
_HEIGHT = 0.1


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
        _add_body(element, part, origin_of(robot, link.name), link.name)
        _join_link(urdf, frames, robot, link)
    for sensor in robot.sensors:
        ET.SubElement(urdf, 'link', name=frames.name(sensor.name))
        _join(urdf, frames, frame_of(sensor.link), sensor.name, mounting_of(robot, sensor))
    return ET.tostring(urdf, encoding='unicode')


def _add_color(urdf: ET.Element, name: str, body: Body) -> None:
    material = ET.SubElement(urdf, 'material', name=name)
    ET.SubElement(material, 'color', rgba=' '.join(f'{each:g}' for each in body.color))


def _add_body(element: ET.Element, body: Body, origin: Point, material: str) -> None:
    """
    Add shape and inertia of a body to a link.

    :param origin: of the frame of the link in that of the body [m]
    """
    geometries = (each for piece in body.shape.form.pieces for each in _geometries_of(piece))
    for x, y, yaw, geometry in geometries:
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
    place = composed(link.at, (*origin_of(robot, link.name), 0.0))
    parent = composed(robot.place_of(above.b), (*origin_of(robot, above.b), 0.0))
    joint = _add_joint(
        urdf,
        above.name,
        kind,
        (frames.name(frame_of(above.b)), frames.name(link.name)),
        seen_from(parent, place),
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


def _geometries_of(piece: Piece) -> Iterator[tuple[float, float, float, ET.Element]]:
    """Yield the place x, y [m] and yaw [rad] of each geometry, and the geometry."""
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


def _join(urdf: ET.Element, frames: RobotFrames, parent: str, child: str, pose: Pose) -> None:
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
