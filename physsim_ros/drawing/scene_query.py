# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Spatial queries on a snapshot of the world: bodies at a point, frames, free names.

Law: queries read a snapshot, past or present, and need neither engine nor clock.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cached_property
from itertools import count
import math

import numpy as np
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.errors import BadProperty, no_frame
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import split_name
from physsim_ros.model.robots import part_name, whole_of
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import (
    contain_each,
    contains_each,
    distances_from_outlines,
    extent_of,
)
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import (
    cross,
    dots,
    local_to_world,
    norms,
    Point,
    Pose,
    rotated_each,
    Twist,
    world_to_local,
)

# The namespace of drawn bodies and joints.
DRAWN = 'drawn'
# Other nodes may spawn into the namespace too: numbers from this one on are not counted.
_NUMBER_LIMIT = 10**9


class SceneQuery:
    """
    Queries on one snapshot.

    :param snapshot: of the world
    :param first: the lowest number for the next drawn body
    :param first_joint: the lowest number for the next drawn joint
    """

    def __init__(self, snapshot: Snapshot, *, first: int = 0, first_joint: int = 0) -> None:
        self.snapshot = snapshot
        self._first, self._first_joint = first, first_joint

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world."""
        return self.snapshot.scene.settings

    @property
    def names(self) -> tuple[str, ...]:
        """Return the names of all bodies, in spawn order."""
        return self.snapshot.scene.names

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Return the descriptions of all joints."""
        return self.snapshot.scene.joints

    def motor_between(self, a: str, b: str) -> str | None:
        """Return the name of the motor between two bodies, if there is one."""
        motors = (each for each in self.joints if each.kind is JointKind.MOTOR)
        return next((each.name for each in motors if {each.a, each.b} == {a, b}), None)

    def pivot(self, axle: Joint) -> Point:
        """Return the place of a weld or an axle [m]."""
        return self.in_world(axle.a, (axle.seat.ax, axle.seat.ay))

    def axles_at(self, point: Point, slack: float) -> list[Joint]:
        """
        Return the axles at a point.

        :param point: in the world [m]
        :param slack: the greatest distance of an axle from it [m]
        """
        axles = (each for each in self.joints if each.kind is JointKind.AXLE)
        return [each for each in axles if math.dist(self.pivot(each), point) <= slack]

    def body(self, name: str) -> Body:
        """Return the description of a body."""
        return self.snapshot.scene.bodies[self._rows[name]]

    def whole(self, name: str) -> str:
        """Return the name of the robot of which a body is a part, else that of the body."""
        return whole_of(name, lambda each: self.body(each).robot if each in self._rows else None)

    def parts(self, robot: str) -> tuple[str, ...]:
        """Return the names of the links of a robot that are there; of another body none."""
        mapping = self.body(robot).robot
        names = () if mapping is None else (part_name(robot, each.name) for each in mapping.links)
        return tuple(name for name in names if name in self._rows)

    def machine(self, name: str) -> tuple[str, ...]:
        """Return the names of a robot and its links for each of them; of another body its own."""
        robot = self.whole(name)
        return (robot, *self.parts(robot)) if robot in self._rows else (name,)

    def joints_of_robot(self, name: str) -> frozenset[str]:
        """Return the names of the joints of a robot; of another body none."""
        mapping = self.body(name).robot
        joints = () if mapping is None else mapping.joints
        return frozenset(part_name(name, each.name) for each in joints)

    def pose(self, name: str) -> Pose:
        """Return x, y [m] and yaw [rad] of a body's origin."""
        x, y, yaw = self.snapshot.poses[self._rows[name]].tolist()
        return x, y, yaw

    def centroid(self, name: str) -> Point:
        """Return the centre of mass of a body at uniform density [m]."""
        return self.in_world(name, self.body(name).shape.form.centroid)

    def twist(self, name: str) -> Twist:
        """Return vx, vy [m/s] of a body's centre of mass and its angular velocity [rad/s]."""
        vx, vy, spin = self.snapshot.twists[self._rows[name]].tolist()
        return vx, vy, spin

    def bodies_at(self, point: Point, slack: float = 0.0) -> tuple[str, ...]:
        """
        Return the names of the bodies that cover a point, the last spawned (topmost) first.

        Regions of media come after what is in them.

        :param point: in the world [m]
        :param slack: the greatest distance of the point from a body that still covers it [m]
        """
        offsets = self.snapshot.centers - point
        near = np.hypot(offsets[:, 0], offsets[:, 1]) <= self.snapshot.scene.outer_radii + slack
        rows = np.flatnonzero(near)[::-1]
        forms = [self.snapshot.scene.bodies[row].shape.form for row in rows]
        poses = self.snapshot.poses[rows]
        local = rotated_each(point - poses[:, :2], -poses[:, 2])
        covering = rows[contain_each(forms, local[:, 0], local[:, 1], slack)]
        bodies = self.snapshot.scene.bodies
        rows = covering.tolist()
        solid = [row for row in rows if bodies[row].medium is None]
        regions = [row for row in rows if bodies[row].medium is not None]
        names = self.names
        return tuple([names[row] for row in solid + regions])

    def bodies_near(self, point: Point, reach: float) -> tuple[str, ...]:
        """
        Return the bodies that cover a point, topmost first, or else those beside it.

        :param reach: the greatest distance of bodies beside the point; the nearest comes first [m]
        """
        if covering := self.bodies_at(point):
            return covering
        beside = self.bodies_at(point, reach)
        if len(beside) < 2:
            return beside
        rows = [self._rows[name] for name in beside]
        bodies, poses = self.snapshot.scene.bodies, self.snapshot.poses[rows]
        x, y = rotated_each(point - poses[:, :2], -poses[:, 2]).T
        away = distances_from_outlines([bodies[row].shape.form for row in rows], x, y)
        is_region = np.array([bodies[row].medium is not None for row in rows])
        return tuple(beside[at] for at in np.lexsort((away, is_region)).tolist())

    def bodies_along(self, start: Point, end: Point) -> tuple[str, ...]:
        """
        Return the names of the bodies that a line may meet, in spawn order.

        Left out are those whose circle about the centre of mass, or whose box in their own axes,
        the line does not meet.

        :param start: of the line in the world [m]
        :param end: of it [m]
        """
        scene, centers = self.snapshot.scene, self.snapshot.centers
        line = np.subtract(end, start)
        share = dots(centers - start, line) / max(math.hypot(*line) ** 2, 1e-300)
        nearest = start + np.clip(share, 0.0, 1.0)[:, None] * line
        rows = np.flatnonzero(norms(centers - nearest) <= scene.outer_radii)
        extents = [extent_of(scene.bodies[row].shape.form) for row in rows.tolist()]
        low, high = np.moveaxis(np.array(extents).reshape(-1, 2, 2), 1, 0)
        x, y, yaw = self.snapshot.poses[rows].T
        a, b = (rotated_each(at - np.column_stack((x, y)), -yaw) for at in (start, end))
        # Separating axes of a box and a line: those of the box, and the normal of the line.
        beside = (np.maximum(a, b) < low) | (np.minimum(a, b) > high)
        half, along = (high - low) / 2, np.abs(b - a)
        reach = along[:, 0] * half[:, 1] + along[:, 1] * half[:, 0]
        met = np.abs(cross(b - a, (low + high) / 2 - a)) <= reach
        return tuple(self.names[row] for row in rows[met & ~beside.any(axis=1)].tolist())

    def covers(self, name: str, points: Floats) -> Flags:
        """
        Return whether a body covers each of some points, (k,) bool.

        :param points: (k, 2) float64: in the world [m]
        """
        row = self._rows[name]
        x, y, yaw = self.snapshot.poses[row].tolist()
        local = rotated_each(points - (x, y), -yaw)
        form = self.snapshot.scene.bodies[row].shape.form
        return contains_each(form, local[:, 0], local[:, 1])

    def local(self, name: str, point: Point) -> Point:
        """Return a point of the world in the frame of a body [m]."""
        return world_to_local(point, self.pose(name))

    def in_world(self, name: str, point: Point) -> Point:
        """Return a point of the frame of a body in the world [m]."""
        return local_to_world(point, self.pose(name))

    def resolve_point(self, point: Point, frame: str) -> Point:
        """
        Return a point of a named frame in the world [m].

        :param point: [m]
        :param frame: of it: '' for the world, or the name of a body
        :raises UnknownFrame: there is no such body
        """
        if not frame:
            return point
        if frame not in self._rows:
            raise no_frame(frame, self._rows)
        return self.in_world(frame, point)

    def gravity_strength(self) -> float:
        """
        Return the magnitude of gravity [m/s²].

        :raises BadProperty: it is 0, which has no direction
        """
        strength = math.hypot(*self.settings.gravity)
        if strength == 0.0:
            raise BadProperty(
                'there is no gravity to turn; set the parameter gravity first', field='gravity'
            )
        return strength

    def new_bodies(self) -> Iterator[str]:
        """Return names for the next drawn bodies, numbered above all drawn before."""
        return (f'{DRAWN}/{each}' for each in count(number_above(self.names, self._first)))

    def new_joints(self) -> Iterator[str]:
        """Return names for the next drawn joints, numbered above all drawn before."""
        first = number_above((joint.name for joint in self.joints), self._first_joint)
        return (f'{DRAWN}/{each}' for each in count(first))

    def next_body(self) -> str:
        """Return the name of the next drawn body."""
        return next(self.new_bodies())

    def next_joint(self) -> str:
        """Return the name of the next drawn joint."""
        return next(self.new_joints())

    @cached_property
    def _rows(self) -> dict[str, int]:
        return {name: row for row, name in enumerate(self.names)}


def number_above(names: Iterable[str], first: int) -> int:
    """
    Return the lowest number above those of all drawn names among others.

    :param first: the least that it is
    """
    # Of thousands of names, few are drawn.
    numbers = (split_name(name) for name in names if name.startswith(DRAWN))
    drawn = (id_ for space, id_ in numbers if space == DRAWN and id_ < _NUMBER_LIMIT)
    return max(first, 1 + max(drawn, default=-1))
