# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A body in Pymunk: how it is made of its description, and its pose, velocity and state.

Laws: the engine's body has its origin at the centre of mass, so that a state is saved and restored
without rounding (anchored bodies keep their own origin). The engine moves a body with the velocity
of the step before; a velocity that leads by half a step of its acceleration makes free flight
exact, so the engine's velocity leads while a body is in free flight. Reported velocities never
lead.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice
import math
import operator

import numpy as np
from physsim_ros.engine.core import dtype_of
from physsim_ros.engine.layout import address_of
from physsim_ros.model.applied_forces import wrench_of
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import Capsule, Circle, contains, Convex, Piece
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

# Discs are made smaller by this [m]. Otherwise discs side by side overlap by rounding, and an
# impact on a row acts on all discs at once. Ten times the rounding of a position within a
# kilometre of the origin (1.1e-13 m).
GRAZE = 1e-12
# Polygons are rounded by this [m] (Box2D: polygon skin). Otherwise rounding tells whether what
# lies on their faces touches them. A hundred times the same rounding.
SKIN = 1e-11
# The filter of shapes that touch nothing.
NOTHING = pymunk.ShapeFilter(categories=0, mask=0)
# The state of a body that has not been in a table: in free flight, its lead by fields to be found.
BODY_STATE = dtype_of('BodyState')
_NEW = np.zeros(1, BODY_STATE)[0]
_NEW['free'] = _NEW['fresh'] = _NEW['thrown'] = True
_SPAWNED, _WAITING = np.array([SPAWNED], ROBOT_STATE)[0], np.array([WAITING], ACTOR_STATE)[0]
# Pieces of a body that enter the engine's tree in their order [1]: of 1,000 segments in a row,
# blocks of 16 or 32 make the fastest steps; all in their order take three times as long to enter.
_BLOCK = 32
# Distance at which a point counts as inside [m]: on the seam of two pieces it lies inside neither.
SEAM = 1e-9


@dataclass(slots=True, eq=False)
class RigidBody:
    """
    A body and its engine objects; made by `build_body`.

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


def set_surface(shape: pymunk.Shape, friction: float, elasticity: float) -> None:
    """
    Set the surface of a shape, so that a pair has the geometric mean of both values.

    Pymunk multiplies what it is told of two shapes.
    """
    shape.friction, shape.elasticity = math.sqrt(friction), math.sqrt(elasticity)


def build_body(body: Body) -> RigidBody:
    """Make the engine objects of a body, outside any space, at the origin and at rest."""
    if body.anchored:
        pm_body = pymunk.Body(body_type=pymunk.Body.STATIC)
    elif body.kinematic:
        pm_body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    else:
        pm_body = pymunk.Body(body.total_mass, body.total_mass * body.shape.form.gyration)
    offset = offset_of(body)
    shapes = [_shape(piece, pm_body, offset) for piece in _in_blocks(body.shape.form.pieces)]
    rigid = RigidBody(body, pm_body, handles_of(pm_body, *shapes))
    _set_neighbors([shape for shape in shapes if isinstance(shape, pymunk.Segment)])
    for shape in shapes:
        set_surface(shape, body.friction, body.elasticity)
        shape.sensor = body.sensor
        # Groups of the engine are unsigned.
        shape.filter = pymunk.ShapeFilter(group=body.group % 2**32)
        if body.medium is not None:
            # A region has no contacts with the bodies in it.
            shape.filter = NOTHING
    return rigid


def handles_of(*objects: pymunk.Body | pymunk.Shape | pymunk.Constraint) -> tuple[object, ...]:
    """
    Remove the handles from objects of Pymunk, and return them.

    By its handle, which it holds itself, an object of Pymunk (7.3.1) is a cycle of references:
    only a collection of garbage would free it, and one of a thousand bodies stops all threads for
    some 20 ms. Callbacks of the engine find the object by the handle, which must live as long.
    """
    return tuple(
        vars(each).pop('_h' if isinstance(each, pymunk.Shape) else '_data_handle')
        for each in objects
    )


def scattered(number: int) -> int:
    """
    Return the place of a number in an order in which shapes enter the engine's tree.

    The tree of shapes in a row that enter from left to right is as deep as there are shapes: with
    20,000 bodies it took 10 s. Numbers are scattered by the golden ratio (Fibonacci hashing:
    Knuth, "The Art of Computer Programming" 3, section 6.4).
    """
    return number * 2654435761 % 2**32


def _in_blocks(pieces: Sequence[Piece]) -> Iterator[Piece]:
    """Yield the pieces of a body as they enter the engine's tree: in scattered blocks."""
    for block in sorted(range(-(-len(pieces) // _BLOCK)), key=scattered):
        yield from islice(pieces, block * _BLOCK, (block + 1) * _BLOCK)


def _shape(piece: Piece, pm_body: pymunk.Body, offset: Point) -> pymunk.Shape:
    def local(point: Point) -> Point:
        return point[0] - offset[0], point[1] - offset[1]

    match piece:
        case Circle(center, radius):
            return pymunk.Circle(pm_body, radius - GRAZE, local(center))
        case Capsule(start, end, radius):
            return pymunk.Segment(pm_body, local(start), local(end), radius)
        case Convex(vertices):
            return pymunk.Poly(pm_body, [local(vertex) for vertex in vertices], radius=SKIN)


def _set_neighbors(segments: list[pymunk.Segment]) -> None:
    """
    Set the neighbours of the segments of a chain.

    Without them a ball that rolls through a bend hits the round end of the next segment before its
    face, and is thrown off.
    """
    before = {segment.b: segment.a for segment in segments}
    after = {segment.a: segment.b for segment in segments}
    for segment in segments:
        a, b = segment.a, segment.b
        segment.set_neighbors(before.get(a, a), after.get(b, b))
