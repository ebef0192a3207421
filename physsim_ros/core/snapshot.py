# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
What is so: arrays and values that leave the world.

Law: what crosses the border is an immutable value or a fresh array, never an engine object.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.core.errors import Refusal
from physsim_ros.core.joint_properties import DEFAULTS, JointKind, JointProperties
from physsim_ros.core.names import WORLD
from physsim_ros.core.preview import NOTHING, Preview
from physsim_ros.core.rotation import turned
from physsim_ros.core.settings import WorldSettings
from physsim_ros.core.shapes import Color, Pose, Shape

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

# What every message has, beside what it is made of.
_FRAME = 'header.frame_id'


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """
    What a body is, apart from where it is.

    :param name: unique in its world
    :param shape: geometry in the body's frame
    :param color: red, green, blue, alpha, each 0 .. 1
    :param mass: as given [kg], or None where the density counts
    :param density: [kg/m²]
    :param friction: of its material
    :param elasticity: of its material
    :param anchored: fixed to the background
    :param kinematic: moves as commanded whatever it touches
    :param group: bodies of the same non-zero group pass through each other
    :param sensor: reports contacts, pushes nothing
    :param expires: step at whose end the body goes; None is never
    """

    name: str
    shape: Shape
    color: Color
    mass: float | None
    density: float
    friction: float
    elasticity: float
    anchored: bool
    kinematic: bool
    group: int
    sensor: bool
    expires: int | None

    @property
    def weight(self) -> float:
        """Return the mass that counts [kg]."""
        return self.density * self.shape.form.area if self.mass is None else self.mass

    @property
    def fixed(self) -> bool:
        """Whether forces do not move it."""
        return self.anchored or self.kinematic


class Seat(NamedTuple):
    """
    Where a joint sits on its two bodies, as it was when it was drawn.

    ax, ay [m]: its point in the frame of a; bx, by [m]: the same in the frame of b; ux, uy: the
    unit vector of a slider's line in the frame of b; phase [rad]: turn of b times ratio less turn
    of a; length [m]: distance of the two points as drawn.
    """

    ax: float
    ay: float
    bx: float
    by: float
    ux: float
    uy: float
    phase: float
    length: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Joint:
    """
    What a joint is: all that it goes on from.

    :param name: unique among the joints of its world
    :param kind: how it holds its bodies
    :param a: a body's name
    :param b: another one's, or 'world' for the background
    :param seat: where it sits on them
    :param properties: as far as said
    """

    name: str
    kind: JointKind
    a: str
    b: str
    seat: Seat
    properties: JointProperties

    @property
    def rest_length(self) -> float:
        """Return the length at which a spring is slack, or a rope taut [m]."""
        said = self.properties
        length = said.length if self.kind is JointKind.ROPE else said.rest_length
        return self.seat.length if length is None else length

    @property
    def stiffness(self) -> float:
        """Return that of a spring [N/m], 0 for other kinds."""
        return float(self.number('stiffness')) if self.kind is JointKind.SPRING else 0.0

    @property
    def collide(self) -> bool:
        """Whether the joined bodies collide with each other."""
        return bool(self.properties.collide)

    def number(self, name: str) -> float:
        """Return a property that is said, or its default."""
        value: float | None = getattr(self.properties, name)
        default: float = getattr(DEFAULTS, name)
        return default if value is None else value


class Motion(NamedTuple):
    """
    The engine's own numbers for a body: enough to go on from to the bit.

    x, y [m], yaw [rad] of the engine's origin; vx, vy [m/s], spin [rad/s] as the engine has them;
    whether the body is in free flight.
    """

    x: float
    y: float
    yaw: float
    vx: float
    vy: float
    spin: float
    free: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyState:
    """
    A body and all that it goes on from.

    :param body: what it is; `expires` counts from the moment of the state
    :param pose: of its origin in the world [m, rad]
    :param twist: velocity of the centre of mass [m/s] and spin [rad/s]
    :param motion: the engine's numbers for these two; None where they come from a person
    :param wrench: force [N] and torque [N m] that act on it
    :param wrench_steps: steps for which the wrench still acts; None is for ever
    """

    body: Body
    pose: Pose
    twist: Pose = (0.0, 0.0, 0.0)
    motion: Motion | None = None
    wrench: Pose = (0.0, 0.0, 0.0)
    wrench_steps: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class WorldState:
    """
    A whole world at a moment, as it is saved and restored; it has no time of its own.

    :param settings: of the world
    :param bodies: in spawn order
    :param joints: in the order in which they were made
    :param memory: of contacts; None where the state comes from a person
    """

    settings: WorldSettings
    bodies: tuple[BodyState, ...] = ()
    joints: tuple[Joint, ...] = ()
    memory: ContactMemory | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ContactMemory:
    """
    What the engine remembers of contacts: its next step starts from these impulses.

    :param ids: (n,) int64: the engine's number of each body's first shape, in spawn order
    :param walls: the same of the first wall of `bounds`; 0 where there are none
    :param following: the number that the next shape gets
    :param pairs: (k, 2) int64: numbers of the two shapes of each contact point
    :param hashes: (k,) uint64: what the engine tells the points of a pair apart by
    :param impulses: (k, 2) float64: along and across the normal, in the last step [N s]
    """

    ids: Ints
    walls: int
    following: int
    pairs: Ints
    hashes: NDArray[np.uint64]
    impulses: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """
    Everything about a world that stays while it steps; one object until something changes.

    Compare scenes by identity: a frame with the same scene as the one before has the same bodies
    in the same order.

    :param bodies: in spawn order
    :param settings: of the world
    :param joints: in the order in which they were made
    """

    bodies: tuple[Body, ...]
    settings: WorldSettings
    joints: tuple[Joint, ...] = ()

    @cached_property
    def key(self) -> bytes:
        """Everything of it as bytes, for digests."""
        return repr((self.bodies, self.settings, self.joints)).encode()

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the bodies, in spawn order."""
        return tuple(body.name for body in self.bodies)

    @cached_property
    def inertia(self) -> Floats:
        """(n, 2) float64: mass [kg], moment [kg m²]; zero for bodies that forces do not move."""
        rows = [
            (0.0, 0.0) if body.fixed else (body.weight, body.weight * body.shape.form.gyration)
            for body in self.bodies
        ]
        return np.array(rows, dtype=np.float64).reshape(-1, 2)

    @cached_property
    def centroids(self) -> Floats:
        """(n, 2) float64: centre of mass in the body's frame [m]."""
        rows = [body.shape.form.centroid for body in self.bodies]
        return np.array(rows, dtype=np.float64).reshape(-1, 2)

    @cached_property
    def joint_rows(self) -> Ints:
        """(j, 2) int64: rows of the bodies a and b of each joint; -1 is the background."""
        rows = {name: row for row, name in enumerate(self.names)} | {WORLD: -1}
        pairs = [(rows[joint.a], rows[joint.b]) for joint in self.joints]
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)

    @cached_property
    def seats(self) -> Floats:
        """(j, 8) float64: the seat of each joint."""
        return np.array([joint.seat for joint in self.joints], dtype=np.float64).reshape(-1, 8)


class Springs(NamedTuple):
    """
    The springs of a world, as the engine has them.

    :ivar numbers: (k,) int64: of the joints that are springs and move a body
    :ivar stiffness: (k,) float64: as steps can follow it [N/m]
    :ivar rest: (k,) float64: length at which they are slack [m]
    :ivar reach: (k,) float64: from where on they pull no harder [m]
    """

    numbers: Ints
    stiffness: Floats
    rest: Floats
    reach: Floats

    def energy(self, length: Floats) -> tuple[Floats, Floats]:
        """
        Return (k,) float64: what is in each [J], and what it pulls or pushes with [N].

        :param length: (k,) float64: of each [m]
        """
        size = np.abs(length - self.rest)
        bent = np.minimum(size, self.reach)
        pull = self.stiffness * bent
        return pull * (bent / 2 + (size - bent)), pull


NO_SPRINGS = Springs(np.empty(0, np.int64), np.empty(0), np.empty(0), np.empty(0))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Keyframe:
    """
    All that a world goes on from at a step, after the requests of that step.

    :param step: number of steps since the world began
    :param scene: the bodies and the settings
    :param state: (n, 6) float64: pose and velocity of each engine body [m, rad, s]
    :param free: (n,) bool: in free flight, so that the engine's velocity leads
    :param wrenches: of the bodies that one acts on: row, wrench [N, N m], the step at which it
        ends or None
    :param memory: of contacts
    :param forces: (j,) float64: what each joint gave in the step before [N]
    """

    step: int
    scene: Scene
    state: Floats
    free: NDArray[np.bool_]
    wrenches: tuple[tuple[int, Pose, int | None], ...]
    memory: ContactMemory
    forces: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Contacts:
    """
    The pairs that touched during a frame, each pair once, in a stable order.

    :param pairs: (m, 2) int64: rows of the two bodies in the scene, the earlier spawned first;
        -1, always second, is the walls of `bounds`
    :param points: (m, 2) float64: mean of the latest contact points, world [m]
    :param normals: (m, 2) float64: unit vector from the first to the second body, world
    :param impulses: (m, 2) float64: what the first gave the second over the frame, world [N s]
    """

    pairs: Ints
    points: Floats
    normals: Floats
    impulses: Floats

    @property
    def nbytes(self) -> int:
        """Memory it takes [bytes]."""
        # Each pair has two rows, a point, a normal and an impulse of 16 bytes each.
        return 4 * self.pairs.nbytes


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """
    What became of one request, or what happened without one.

    :param topic: where the request came from, as '~/spawn'; or what happened, as 'divergence'
    :param subject: the body concerned, '' where there is none
    :param message: a sentence
    :param code: '' for success, else the stable code of the refusal
    :param field: the offending field of a refusal
    :param values: what else there is to tell, as pairs of key and value
    """

    topic: str
    subject: str = ''
    message: str = ''
    code: str = ''
    field: str = ''
    values: tuple[tuple[str, str], ...] = ()

    @classmethod
    def refused(
        cls, refusal: Refusal, *, topic: str, subject: str = '', field: str = ''
    ) -> Answer:
        """
        Make the answer that tells of a refusal.

        :param field: that the request was all made of; '' where it had several
        """
        return cls(
            topic=topic,
            subject=subject,
            message=str(refusal),
            code=refusal.code,
            field=refusal.field if refusal.field == _FRAME or not field else field,
            values=refusal.values,
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Snapshot:
    """
    Where everything is after a step.

    :param step: number of steps since the world began
    :param stamp: simulation time, step / physics_rate [ns]
    :param scene: what the rows are
    :param poses: (n, 3) float64: x, y [m], yaw [rad] of each body's origin
    :param twists: (n, 3) float64: vx, vy [m/s] of each centre of mass, spin [rad/s]; world axes
    :param forces: (j,) float64: what each joint gave in the last step [N]; where it turns, at an
        arm of 1 m; empty where it is not known
    :param springs: among the joints
    """

    step: int
    stamp: int
    scene: Scene
    poses: Floats
    twists: Floats
    forces: Floats = field(default_factory=lambda: np.empty(0))
    springs: Springs = NO_SPRINGS

    @property
    def nbytes(self) -> int:
        """Memory it takes [bytes]; what is worked out from it not counted."""
        return self.poses.nbytes + self.twists.nbytes

    @cached_property
    def centers(self) -> Floats:
        """(n, 2) float64: centres of mass, world [m]."""
        return self.poses[:, :2] + turned(self.scene.centroids, self.poses[:, 2])

    @cached_property
    def kinetic_energy(self) -> float:
        """Of all bodies that forces move [J]."""
        mass, moment = self.scene.inertia.T
        speed2 = (self.twists[:, :2] ** 2).sum(axis=1)
        return float((mass * speed2 + moment * self.twists[:, 2] ** 2).sum() / 2)

    @cached_property
    def potential_energy(self) -> float:
        """In the field of gravity, zero at the origin [J]."""
        return float(-(self.scene.inertia[:, 0] @ (self.centers @ self.scene.settings.gravity)))

    @cached_property
    def elastic_energy(self) -> float:
        """In the springs [J]."""
        ends = self.ends[self.springs.numbers]
        apart = ends[:, 0] - ends[:, 1]
        within, _ = self.springs.energy(np.hypot(apart[:, 0], apart[:, 1]))
        return float(within.sum())

    @cached_property
    def ends(self) -> Floats:
        """(j, 2, 2) float64: the points of each joint on its bodies a and b, world [m]."""
        seats, rows = self.scene.seats, self.scene.joint_rows
        # The background is the last row.
        poses = np.vstack((self.poses, np.zeros((1, 3))))[rows]
        return poses[..., :2] + turned(seats[:, :4].reshape(-1, 2, 2), poses[..., 2])

    @cached_property
    def momentum(self) -> tuple[float, float]:
        """Of all bodies that forces move [kg m/s]."""
        x, y = (self.scene.inertia[:, 0] @ self.twists[:, :2]).tolist()
        return x, y


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Frame:
    """
    All that leaves the simulation at once: state, contacts and answers.

    :param snapshot: where everything is
    :param contacts: what touched since the frame before; None where nobody asked
    :param answers: to the requests that were applied, in their order
    :param speed: at which time runs; 0 is paused
    :param moved: whether time went on since the frame before
    :param preview: what is half drawn over it
    """

    snapshot: Snapshot
    contacts: Contacts | None
    answers: tuple[Answer, ...] = field(default=())
    speed: float = 1.0
    moved: bool = True
    preview: Preview = NOTHING


def run_state(speed: float) -> str:
    """Return what a world does at a speed, in words."""
    if speed == 0.0:
        return 'paused'
    words = 'playing' if speed > 0.0 else 'rewinding'
    return words if abs(speed) == 1.0 else f'{words} at {abs(speed):g}'
