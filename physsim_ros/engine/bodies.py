# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A body in the engine: its pose, velocity and state. `pymunk_bodies` makes it.

Laws: the engine's body has its origin at the centre of mass, so that a state is saved and restored
without rounding (anchored bodies keep their own origin). The engine moves a body with the velocity
of the step before; a velocity that leads by half a step of its acceleration makes free flight
exact, so the engine's velocity leads while a body is in free flight. Reported velocities never
lead.
"""

from __future__ import annotations

from dataclasses import dataclass, field
import math
import operator

import numpy as np
from physsim_ros.engine.core import dtype_of
from physsim_ros.engine.layout import address_of
from physsim_ros.model.applied_forces import wrench_of
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import contains
from physsim_ros.model.states import ACTOR_STATE, ROBOT_STATE, SPAWNED, WAITING
from physsim_ros.model.transform import (
    local_to_world,
    NO_WRENCH,
    Point,
    Pose,
    REST,
    rotated,
    Twist,
    world_to_local,
    Wrench,
)
import pymunk
from pymunk._chipmunk_cffi import lib

# The state of a body that has not been in a table: in free flight, its lead by fields to be found.
BODY_STATE = dtype_of('BodyState')
_NEW = np.zeros(1, BODY_STATE)[0]
_NEW['free'] = _NEW['fresh'] = _NEW['thrown'] = True
_SPAWNED, _WAITING = np.array([SPAWNED], ROBOT_STATE)[0], np.array([WAITING], ACTOR_STATE)[0]
# Distance at which a point counts as inside [m]: on the seam of two pieces it lies inside neither.
SEAM = 1e-9


@dataclass(slots=True, eq=False)
class RigidBody:
    """
    A body and its engine objects; made by `build_body` of `pymunk_bodies`.

    :param body: its description
    :param pm_body: the Pymunk body
    :param handles: of it and its shapes, by which the engine names them (`handles_of`)
    :param first_shape: the engine's number of its first shape
    :param row: in the table of bodies; -1 if it is in none yet
    :param wrench: force [N] and torque [N m] that act on the centre of mass
    :param wrench_until: step at which the wrench ends; None is never
    :param state: `BodyState`, in the table of the core once it is in one
    :param driven: `RobotState` of a robot, likewise
    :param acting: `ActorState` of an actor, likewise

    :ivar address: of the struct of Chipmunk
    """

    body: Body
    pm_body: pymunk.Body
    handles: tuple[object, ...] = field(repr=False)
    first_shape: int = 0
    row: int = -1
    wrench: Wrench = NO_WRENCH
    wrench_until: int | None = None
    state: np.void = field(default_factory=_NEW.copy)
    driven: np.void = field(default_factory=_SPAWNED.copy)
    acting: np.void = field(default_factory=_WAITING.copy)
    address: int = field(init=False)

    def __post_init__(self) -> None:
        self.address = address_of(self.pm_body)

    @property
    def shape_numbers(self) -> range:
        """Return the engine's numbers of its shapes."""
        return range(self.first_shape, self.first_shape + len(self.body.shape.form.pieces))

    @property
    def offset(self) -> Point:
        """Return the engine's origin in the body's frame [m]."""
        return offset_of(self.body)

    @property
    def center(self) -> Point:
        """Return the centre of mass in the world [m]."""
        x, y = self.pm_body.position
        return x, y

    @property
    def pose(self) -> Pose:
        """Return the body's origin in the world [m, rad]."""
        x, y = self.pm_body.position
        yaw = self.pm_body.angle
        offset_x, offset_y = rotated(self.offset, yaw)
        return x - offset_x, y - offset_y, yaw

    @pose.setter
    def pose(self, pose: Pose) -> None:
        self.pm_body.angle = pose[2]
        self.pm_body.position = local_to_world(self.offset, pose)
        index_at_rest(self.pm_body)

    def pose_after(self, seconds: float) -> Pose:
        """Return the body's origin after a time at its present velocity [m, rad]."""
        (x, y), (vx, vy) = self.pm_body.position, self.pm_body.velocity
        yaw = self.pm_body.angle + self.pm_body.angular_velocity * seconds
        offset_x, offset_y = rotated(self.offset, yaw)
        return x + vx * seconds - offset_x, y + vy * seconds - offset_y, yaw

    def take_over_roles(self, old: RigidBody, body: Body) -> None:
        """
        Continue with the states of robot and actor after a change of the body.

        A body that is no robot any more has none; a new actor waits for its start.

        :param old: the body before, or this one
        :param body: the new description
        """
        self.driven = _SPAWNED.copy() if body.robot is None else old.driven
        self.acting = old.acting if body.actor == old.body.actor else _WAITING.copy()

    def covers(self, point: Point) -> bool:
        """Return whether a point of the world lies in the body where it is now, edge included."""
        form, local = self.body.shape.form, world_to_local(point, self.pose)
        if math.dist(local, form.centroid) > form.outer + SEAM:
            return False
        return contains(form.pieces, *local, SEAM)

    def lead(self, gravity: Point, dt: float) -> Twist:
        """Return how far the engine's velocity is ahead of the true one in free flight."""
        x, y, turn = lead_of(self.body, self.wrench, self.pm_body.angle, gravity, dt)
        field_x, field_y, field_turn = self.state['field'].tolist()
        return x + field_x, y + field_y, turn + field_turn

    def twist(self, gravity: Point, dt: float) -> Twist:
        """Return the true velocity of the centre of mass [m/s] and spin [rad/s]."""
        ahead = self.lead(gravity, dt) if self.state['free'] else REST
        vx, vy = self.pm_body.velocity
        return vx - ahead[0], vy - ahead[1], self.pm_body.angular_velocity - ahead[2]

    def set_twist(self, twist: Twist, gravity: Point, dt: float, *, free: bool = True) -> None:
        """
        Set velocity [m/s] and spin [rad/s].

        :param free: whether the body is in free flight then
        """
        if self.body.anchored:
            return
        ahead = self.lead(gravity, dt) if free else REST
        self.pm_body.velocity = twist[0] + ahead[0], twist[1] + ahead[1]
        self.pm_body.angular_velocity = twist[2] + ahead[2]
        self.state['free'] = free

    def begin_fields(self) -> None:
        """Have the lead by fields be found as the next step begins; the true velocity stays."""
        x, y, turn = self.state['field'].tolist()
        if self.state['free'] and any((x, y, turn)):
            vx, vy = self.pm_body.velocity
            self.pm_body.velocity = vx - x, vy - y
            self.pm_body.angular_velocity -= turn
        self.state['field'], self.state['fresh'] = 0.0, True


def index_at_rest(pm_body: pymunk.Body) -> None:
    """
    Index the shapes of a body in its space as if it were at rest (see `core/tight_boxes.c`).

    Pymunk's own attributes would take five times as long.
    """
    raw, space = pm_body._body, pm_body.space  # noqa: SLF001
    if space is None:
        return
    velocity = lib.cpBodyGetVelocity(raw)
    lib.cpBodySetVelocity(raw, (0.0, 0.0))
    lib.cpSpaceReindexShapesForBody(space._space, raw)  # noqa: SLF001
    lib.cpBodySetVelocity(raw, velocity)


def offset_of(body: Body) -> Point:
    """Return the engine's origin in a body's frame [m]."""
    return (0.0, 0.0) if body.anchored else body.shape.form.centroid


def reach_of(body: Body) -> float:
    """Return the greatest distance of a point of a body from the engine's origin [m]."""
    form = body.shape.form
    return form.outer + math.dist(form.centroid, offset_of(body))


def lead_of(body: Body, wrench: Wrench, yaw: float, gravity: Point, dt: float) -> Twist:
    """
    Return the half-step lead of a body in free flight.

    :param wrench: of a command, beside the applied forces of the body
    :param yaw: of the body [rad]
    """
    if not body.dynamic:
        return REST
    applied = wrench_of(body.forces, body.shape.form.centroid, yaw)
    fx, fy, torque = map(operator.add, wrench, applied)
    half, mass = dt / 2, body.total_mass
    return (
        (gravity[0] + fx / mass) * half,
        (gravity[1] + fy / mass) * half,
        torque / (mass * body.shape.form.gyration) * half,
    )
