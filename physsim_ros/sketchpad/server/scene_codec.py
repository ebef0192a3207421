# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Scenes as JSON: bodies, joints and settings, whenever they change.

Law: a body is encoded once and its text kept as long as the body is in the scene, so that one more
body costs one text.
"""

from __future__ import annotations

from collections.abc import Mapping
import json
from typing import Any

from physsim_ros.model.robots import part_name, Robot
from physsim_ros.model.scene import Body, BODY_DEFAULTS, Joint, Scene
from physsim_ros.model.shapes import (
    Box,
    Capsule,
    Chain,
    Circle,
    Compound,
    Convex,
    Disc,
    Polygon,
    Shape,
    Triangles,
)
from physsim_ros.model.transform import Point


class SceneCodec:
    """
    Encodes scenes, one after the other.

    :ivar epoch: number of the scene that was encoded last; frames name it
    :ivar scene: the scene that was encoded last; None before the first
    """

    def __init__(self) -> None:
        self.epoch = 0
        self.scene: Scene | None = None
        # The texts of the last scene, by name, with the bodies that they describe.
        self._texts: dict[str, tuple[Body, str]] = {}

    def encode(self, scene: Scene, *, kind: str = 'scene') -> str:
        """
        Return the message of a new scene.

        :param kind: `scene`, or `ghost` for that of a course that was left
        """
        self.epoch += 1
        self.scene = scene
        texts = {}
        for body in scene.bodies:
            kept = self._texts.get(body.name)
            # Scenes share the bodies that did not change.
            known = kept is not None and kept[0] is body
            texts[body.name] = kept if kept and known else (body, compact(body_entry(body)))
        self._texts = texts
        settings = scene.settings
        joints = [joint_entry(joint, scene.row_of) for joint in scene.joints]
        rest = compact(
            {
                'type': kind,
                'epoch': self.epoch,
                'joints': joints,
                'gravity': settings.gravity,
                'bounds': settings.bounds or [],
                'damping': settings.damping,
                'density': settings.density,
                'friction': settings.friction,
                'elasticity': settings.elasticity,
                'air_density': settings.air_density,
                'air_viscosity': settings.air_viscosity,
                'wind': settings.wind,
                'gusts': settings.gusts,
                'gravitation': settings.gravitation,
                'coulomb': settings.coulomb,
                'lesson': None if scene.lesson is None else scene.lesson.entry(),
            }
        )
        bodies = ','.join(text for _, text in texts.values())
        return f'{rest[:-1]},"bodies":[{bodies}]}}'


def compact(value: object) -> str:
    """Return a value as JSON without spaces; raise ValueError for a number that is not finite."""
    return json.dumps(value, separators=(',', ':'), allow_nan=False)


def body_entry(body: Body) -> dict[str, Any]:
    """Return a body without its pose; lengths in its own frame [m], mass [kg], moment [kg m²]."""
    form, robot = body.shape.form, body.robot
    return {
        'name': body.name,
        'shape': shape_entry(body.shape),
        'color': [round(channel, 4) for channel in body.color],
        'anchored': body.anchored,
        'kinematic': body.kinematic,
        'sensor': body.sensor,
        'mass': body.total_mass,
        'moment': body.total_mass * form.gyration,
        'centroid': form.centroid,
        'density': body.density,
        'friction': body.friction,
        'elasticity': body.elasticity,
        'group': body.group,
        'label': body.label,
        **({'belt': body.belt} if body.belt else {}),
        **{
            name: value
            for name in ('surface_velocity', 'rolling_resistance', 'one_way', 'closed_sides')
            if (value := getattr(body, name)) != BODY_DEFAULTS[name]
        },
        **({} if robot is None else {'robot': robot_entry(body.name, robot)}),
        **({} if body.actor is None else {'actor': body.actor.entry()}),
        **({} if body.medium is None else {'medium': body.medium.entry()}),
        **({'charge': body.charge} if body.charge else {}),
        **({'forces': [each.entry() for each in body.forces]} if body.forces else {}),
    }


def robot_entry(body: str, robot: Robot) -> dict[str, Any]:
    """
    Return the namespace of a robot, and what it has of these.

    The kind of its drive, with its greatest velocities [m/s, rad/s], and the names of its parts.

    :param body: its name
    """
    drive = robot.drive
    entry: dict[str, Any] = {'namespace': robot.namespace_of(body)}
    if drive is not None:
        entry |= {'kind': drive.KIND, 'max_speed': drive.max_speed, 'max_turn': drive.max_turn}
    if robot.links:
        entry['parts'] = [part_name(body, link.name) for link in robot.links]
    return entry


def joint_entry(joint: Joint, rows: Mapping[str, int]) -> dict[str, Any]:
    """
    Return a joint.

    :param rows: of bodies in the scene by name; -1 is the background
    """
    seat = joint.seat
    return {
        'name': joint.name,
        'kind': str(joint.kind),
        'a': rows[joint.a],
        'b': rows[joint.b],
        'points': [[seat.ax, seat.ay], [seat.bx, seat.by]],
        'axis': [seat.ux, seat.uy],
        'rest_length': joint.rest_length,
        **(
            {'guides': [[rows[each.body], each.x, each.y, each.radius] for each in joint.guides]}
            if joint.guides
            else {}
        ),
        **joint.properties.entry(),
    }


def shape_entry(shape: Shape) -> dict[str, Any]:
    """Return a shape, in the frame of its body [m]."""
    match shape:
        case Disc():
            return {'kind': 'disc', 'radius': shape.radius}
        case Box():
            sides = {'width': shape.width, 'height': shape.height}
            return _polygon(shape.corners()) | sides
        case Polygon():
            return _polygon(shape.outline)
        case Chain():
            return {'kind': 'chain', 'points': shape.points, 'thickness': shape.thickness}
        case Triangles() | Compound():
            pieces = [_piece_entry(piece) for piece in shape.form.pieces]
            return {'kind': 'pieces', 'pieces': pieces}


def _piece_entry(piece: Circle | Convex | Capsule) -> dict[str, Any]:
    match piece:
        case Circle(center, radius):
            return {'kind': 'disc', 'radius': radius, 'center': center}
        case Convex(vertices):
            return _polygon(vertices)
        case Capsule(start, end, radius):
            return {'kind': 'chain', 'points': [start, end], 'thickness': 2 * radius}


def _polygon(outline: tuple[Point, ...]) -> dict[str, Any]:
    return {'kind': 'polygon', 'outline': outline}
