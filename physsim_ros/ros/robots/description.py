# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The description of a robot as URDF, by which RViz and others show it: no meshes, no wheels.

A disc of the shape is a cylinder, a segment a box with two cylinders, a polygon the box around it.
The links are the frames of the robot, whose transforms the node publishes itself.
"""

from __future__ import annotations

from collections.abc import Iterator
import math
from xml.etree import ElementTree as ET

from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import Capsule, Circle, Convex, Piece
from physsim_ros.ros.robots.frames import BASE, FOOTPRINT, RobotFrames

# Height of a robot [m], which the world does not know: that of small ones.
_HEIGHT = 0.1


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
