# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The scene: bodies and joints without their poses.

Law: everything here is immutable, and constant while the world steps.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from enum import IntEnum
from functools import cached_property
from inspect import get_annotations
import math
from typing import Annotated, Any, NamedTuple

import numpy as np
from physsim_ros.model.actors import Actor
from physsim_ros.model.applied_forces import AppliedForce
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.colors import Color
from physsim_ros.model.declarations import entry_of
from physsim_ros.model.joints import AS_DRAWN, DEFAULTS, JointKind, JointProperties
from physsim_ros.model.lesson import Lesson
from physsim_ros.model.media import Medium
from physsim_ros.model.names import WORLD
from physsim_ros.model.robots import Drive, part_name, Robot, Towed
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Shape
from physsim_ros.model.transform import (
    local_to_world,
    ORIGIN,
    Point,
    Pose,
    rotated,
    world_to_local,
)

# A click means a weld or an axle within this share of the body's inner radius [1], and within at
# least this distance [m].
_NEAR_SHARE, _NEAR = 0.35, 0.1


class Wakes(IntEnum):
    """Which bodies wake when a property of a body changes: those whose motion depends on it."""

    NOBODY = 0
    ITSELF = 1
    # The body and what touches it: Pymunk forgets their contacts, and finds them again.
    TOUCHING = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """
    A body without its pose and velocity, its properties as `Properties` declares them.

    Each field is annotated with the bodies that wake when it changes.

    :param name: unique in its world
    :param shape: geometry in the body's frame
    :param color: red, green, blue, alpha, each 0 .. 1
    :param density: [kg/m²]; of a body with a mass, that by its area
    :param mass: [kg]; None is density times area
    :param expires: step at whose end the body is removed; None is never
    """

    name: Annotated[str, Wakes.NOBODY]
    shape: Annotated[Shape, Wakes.TOUCHING]
    color: Annotated[Color, Wakes.NOBODY]
    mass: Annotated[float | None, Wakes.TOUCHING] = None
    density: Annotated[float, Wakes.TOUCHING]
    friction: Annotated[float, Wakes.TOUCHING]
    elasticity: Annotated[float, Wakes.TOUCHING]
    anchored: Annotated[bool, Wakes.TOUCHING] = False
    kinematic: Annotated[bool, Wakes.TOUCHING] = False
    group: Annotated[int, Wakes.TOUCHING] = 0
    sensor: Annotated[bool, Wakes.TOUCHING] = False
    expires: Annotated[int | None, Wakes.NOBODY] = None
    surface_velocity: Annotated[Point, Wakes.TOUCHING] = (0.0, 0.0)
    belt: Annotated[float, Wakes.TOUCHING] = 0.0
    rolling_resistance: Annotated[float, Wakes.TOUCHING] = 0.0
    one_way: Annotated[Point, Wakes.TOUCHING] = (0.0, 0.0)
    closed_sides: Annotated[bool, Wakes.TOUCHING] = False
    robot: Annotated[Robot | None, Wakes.ITSELF] = None
    towed: Annotated[Towed | None, Wakes.TOUCHING] = None
    label: Annotated[str, Wakes.NOBODY] = ''
    actor: Annotated[Actor | None, Wakes.ITSELF] = None
    forces: Annotated[tuple[AppliedForce, ...], Wakes.ITSELF] = ()
    charge: Annotated[float, Wakes.TOUCHING] = 0.0
    medium: Annotated[Medium | None, Wakes.TOUCHING] = None

    def wakes(self, changed: 'Body') -> Wakes:
        """Return which bodies wake when this one becomes another one of its name."""
        notes = (
            note for name, note in _WAKES.items() if getattr(self, name) != getattr(changed, name)
        )
        return max(notes, default=Wakes.NOBODY)

    @property
    def total_mass(self) -> float:
        """Return the mass: as given, or density times area [kg]."""
        return self.density * self.shape.form.area if self.mass is None else self.mass

    @property
    def dynamic(self) -> bool:
        """Whether forces move it: it is neither anchored nor kinematic."""
        return not (self.anchored or self.kinematic)

    @property
    def click_reach(self) -> float:
        """Return the distance from a click within which it means a weld or axle of it [m]."""
        return max(_NEAR, _NEAR_SHARE * self.shape.form.inner)

    @property
    def wheels(self) -> Drive | Towed | None:
        """Return the wheels that it stands on: of a robot's drive, or towed; None is none."""
        drive = None if self.robot is None else self.robot.drive
        return self.towed if drive is None else drive

    def entry(self) -> dict[str, Any]:
        """Return its properties, but those of any body, as the mapping that sets them."""
        values = {name: getattr(self, name) for name in _HELD}
        if self.mass is not None:
            del values['density']
        return {
            name: entry_of(value) for name, value in values.items() if value != BODY_DEFAULTS[name]
        }


_WAKES: dict[str, Wakes] = {
    name: hint.__metadata__[0] for name, hint in get_annotations(Body).items()
}
# Of the fields of a body; MISSING where the world or the request has it.
BODY_DEFAULTS = {each.name: each.default for each in fields(Body)}
# Its properties, in the order of their declarations.
_HELD = [name for name in Properties.FIELDS if name in BODY_DEFAULTS]


class Seat(NamedTuple):
    """
    The anchor points of a joint, its axis, reference angle and length, from when it was drawn.

    ax, ay [m]: anchor point in the frame of a; bx, by [m]: the same in the frame of b; ux, uy:
    unit vector of the axis of a slider or a rack in the frame of b; phase [rad]: angle of b times
    ratio minus angle of a; length [m]: distance of the two points. Box2D: localAnchorA,
    localAnchorB, localAxis, referenceAngle, length.
    """

    ax: float
    ay: float
    bx: float
    by: float
    ux: float
    uy: float
    phase: float
    length: float


def seat_of(
    kind: JointKind, points: tuple[Point, ...], pose_a: Pose, pose_b: Pose, phase: float
) -> Seat:
    """Return the seat of a joint that is drawn with points of the world [m]."""
    ux = uy = 0.0
    at_b = points[-1]
    if kind.schema.has_axis or kind.schema.rolls:
        (x1, y1), (x2, y2) = points
        length = math.dist(*points)
        ux, uy = rotated(((x2 - x1) / length, (y2 - y1) / length), -pose_b[2])
    if kind.schema.has_axis:
        at_b = points[0]
    if kind.schema.rolls:
        # A wheel that rolls to the right on a surface below it turns clockwise.
        ux, uy = -uy, ux
    length = math.dist(points[0], at_b)
    on_a, on_b = world_to_local(points[0], pose_a), world_to_local(at_b, pose_b)
    return Seat(*on_a, *on_b, ux, uy, phase, length)


class Guide(NamedTuple):
    """
    A body that a joint has beside its two: what a rope passes, or the carrier of a gear.

    body: its name, 'world' for the background; x, y [m]: the ring, or the centre of the wheel, in
    its frame; radius [m]: > 0 where the rope runs counter-clockwise around a wheel, < 0 clockwise,
    0 of a ring; yaw [rad]: of the body when the joint was drawn; heading_in, heading_out [rad]:
    directions in which the rope came and went then; span [m]: length of its span to here then.
    """

    body: str
    x: float
    y: float
    radius: float = 0.0
    yaw: float = 0.0
    heading_in: float = 0.0
    heading_out: float = 0.0
    span: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Joint:
    """
    A joint; together with the poses of its bodies, all that its motion depends on.

    :param name: unique among the joints of its world
    :param kind: of joint
    :param a: name of a body
    :param b: name of another body, or 'world' for the background
    :param seat: its anchor points on them, and what else was measured when it was drawn
    :param properties: those that a request has set
    :param guides: what it passes between its anchor points, in this order
    """

    name: str
    kind: JointKind
    a: str
    b: str
    seat: Seat
    properties: JointProperties
    guides: tuple[Guide, ...] = ()

    @property
    def bodies(self) -> tuple[str, ...]:
        """Return the names of its bodies, each once, the background among them."""
        return tuple(dict.fromkeys((self.a, self.b, *(guide.body for guide in self.guides))))

    @property
    def rest_length(self) -> float:
        """Return the length of a spring without force, or of a taut rope [m]."""
        properties = self.properties
        length = properties.rest_length if properties.length is None else properties.length
        return self.seat.length if length is None else length

    @property
    def stiffness(self) -> float:
        """Return the stiffness of a spring [N/m], or of an axle [N m/rad]; else 0."""
        if self.kind is JointKind.SPRING:
            return self.number('stiffness')
        return self.properties.stiffness or 0.0

    @property
    def is_elastic(self) -> bool:
        """Whether it has a spring or a damper: along a line, or of an axle about its point."""
        properties = self.properties
        return self.kind is JointKind.SPRING or bool(properties.stiffness or properties.damping)

    @property
    def is_driven(self) -> bool:
        """Whether it is a slider with a drive."""
        return self.kind is JointKind.SLIDER and self.properties.rate is not None

    @property
    def holding_force(self) -> float | None:
        """Return the greatest force with which it holds [N, N m]; None is no limit."""
        return None if self.is_driven else self.properties.max_force

    @property
    def collide(self) -> bool:
        """Whether the joined bodies collide with each other."""
        return bool(self.properties.collide)

    def number(self, name: str) -> float:
        """Return a property that has a number as its default."""
        value: float | None = getattr(self.properties, name)
        return DEFAULTS[name] if value is None else value

    def position(self, poses: Mapping[str, Pose]) -> float:
        """
        Return how far it has turned [rad] or, of a slider, moved [m]: a against b, as its limits.

        :param poses: of its bodies, by name
        """
        pose_a, pose_b, seat = poses[self.a], self._pose_of_b(poses), self.seat
        if not self.kind.schema.has_axis:
            return pose_a[2] - pose_b[2] + seat.phase
        x, y = world_to_local(local_to_world((seat.ax, seat.ay), pose_a), pose_b)
        return seat.ux * (x - seat.bx) + seat.uy * (y - seat.by)

    def _pose_of_b(self, poses: Mapping[str, Pose]) -> Pose:
        return ORIGIN if self.b == WORLD else poses[self.b]

    def drawn_points(self, poses: Mapping[str, Pose]) -> tuple[Point, ...]:
        """
        Return the points of the world with which it would be drawn now [m].

        :param poses: of its bodies, by name
        """
        seat = self.seat
        x, y = local_to_world((seat.ax, seat.ay), poses[self.a])
        if self.kind.points == 1:
            return ((x, y),)
        pose_b = self._pose_of_b(poses)
        if self.kind.schema.has_axis:
            ux, uy = rotated((seat.ux, seat.uy), pose_b[2])
            return (x, y), (x + ux, y + uy)
        passed = [
            local_to_world((guide.x, guide.y), poses.get(guide.body, ORIGIN))
            for guide in self.guides
        ]
        return (x, y), *passed, local_to_world((seat.bx, seat.by), pose_b)

    def drawn_values(self) -> dict[str, float]:
        """Return the properties whose default is the value as drawn, by name."""
        values = {
            'rest_length': self.rest_length,
            'length': self.rest_length,
            'phase': self.seat.phase,
        }
        fields, own = JointProperties.FIELDS, self.kind.schema.own
        drawn = [name for name in own if AS_DRAWN in fields[name].notes]
        return {name: values[name] for name in drawn if name in values}


def _columns(parts: Sequence[Any]) -> dict[str, list[Any]]:
    """Return the fields of values of one class, but those that all have at the default."""
    declared = fields(parts[0]) if parts else ()
    columns = ((each, [getattr(part, each.name) for part in parts]) for each in declared)
    return {each.name: column for each, column in columns if column != [each.default] * len(parts)}


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """
    Bodies, joints and settings of a world: all that is constant while it steps.

    Scenes are compared by identity: two frames with one scene have the same bodies in the same
    order. A request that changes the world makes a new scene.

    :param bodies: in spawn order
    :param settings: of the world
    :param joints: in the order in which they were made
    :param lesson: the task that belongs to the world, which moves nothing; None is none
    """

    bodies: tuple[Body, ...]
    settings: WorldSettings
    joints: tuple[Joint, ...] = ()
    lesson: Lesson | None = None

    @cached_property
    def key(self) -> bytes:
        """Its content as bytes, for digests, but for the lesson."""
        parts = (self.settings,), self.bodies, self.joints
        return repr([*map(_columns, parts)]).encode()

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the bodies, in spawn order."""
        return tuple(body.name for body in self.bodies)

    @cached_property
    def piece_count(self) -> int:
        """Total of the convex pieces of all bodies."""
        return sum(len(body.shape.form.pieces) for body in self.bodies)

    @cached_property
    def owners(self) -> Ints:
        """(n,) int64: row of the robot of which each body is a part, else its own."""
        owners = np.arange(len(self.bodies))
        for row, robot in zip(self.robot_rows.tolist(), self.robots, strict=True):
            for link in robot.links:
                name = part_name(self.names[row], link.name)
                if name in self.row_of:
                    owners[self.row_of[name]] = row
        return owners

    def robot_number(self, row: int) -> int:
        """Return the number of a robot among those of the scene, by the row of its body."""
        return int(np.searchsorted(self.robot_rows, row))

    @cached_property
    def robot_rows(self) -> Ints:
        """(r,) int64: rows of the robots, in spawn order."""
        rows = [row for row, body in enumerate(self.bodies) if body.robot is not None]
        return np.array(rows, np.int64)

    @cached_property
    def actor_rows(self) -> Ints:
        """Rows of the actors, in spawn order: (a,) int64."""
        rows = [row for row, body in enumerate(self.bodies) if body.actor is not None]
        return np.array(rows, np.int64)

    @cached_property
    def sensor_rows(self) -> Ints:
        """Rows of the bodies that are sensors, in spawn order: (s,) int64."""
        rows = [row for row, body in enumerate(self.bodies) if body.sensor]
        return np.array(rows, np.int64)

    @property
    def floor_friction(self) -> Floats:
        """Return (n,) float64: coefficient of friction with the floor; 0 where none acts."""
        rows = [self._friction_below(body) * body.dynamic for body in self.bodies]
        return np.array(rows, np.float64)

    def _friction_below(self, body: Body) -> float:
        if body.wheels is not None:
            return body.wheels.traction
        return self.settings.floor_friction if body.actor is None else body.actor.traction

    @cached_property
    def robots(self) -> tuple[Robot, ...]:
        """Robots, in spawn order."""
        return tuple(body.robot for body in self.bodies if body.robot is not None)

    @cached_property
    def inertia(self) -> Floats:
        """(n, 2) float64: mass [kg], moment of inertia [kg m²]; 0 unless dynamic."""
        rows = [
            (body.total_mass, body.total_mass * body.shape.form.gyration)
            if body.dynamic
            else (0.0, 0.0)
            for body in self.bodies
        ]
        return np.array(rows, dtype=np.float64).reshape(-1, 2)

    @cached_property
    def centroids(self) -> Floats:
        """(n, 2) float64: centre of mass in the body's frame [m]."""
        rows = [body.shape.form.centroid for body in self.bodies]
        return np.array(rows, dtype=np.float64).reshape(-1, 2)

    @cached_property
    def outer_radii(self) -> Floats:
        """(n,) float64: greatest distance of a point of each body from its centre of mass [m]."""
        return np.array([body.shape.form.outer for body in self.bodies], np.float64)

    @cached_property
    def row_of(self) -> Mapping[str, int]:
        """Rows of the bodies by name; -1 is the background."""
        return {name: row for row, name in enumerate(self.names)} | {WORLD: -1}

    @cached_property
    def torsion_springs(self) -> tuple[Joint, ...]:
        """Axles that have a stiffness."""
        return tuple(
            joint for joint in self.joints if joint.kind is JointKind.AXLE and joint.stiffness
        )

    @cached_property
    def joint_rows(self) -> Ints:
        """(j, 2) int64: rows of the bodies a and b of each joint; -1 is the background."""
        pairs = [(self.row_of[joint.a], self.row_of[joint.b]) for joint in self.joints]
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)

    @cached_property
    def seats(self) -> Floats:
        """(j, 8) float64: the seat of each joint, by its fields."""
        return np.array([joint.seat for joint in self.joints], dtype=np.float64).reshape(-1, 8)
