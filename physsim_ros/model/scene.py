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
What there is: bodies, joints, and the scene of all of them; not where they are.

Law: everything here is immutable, and stays while the world steps.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.joint_properties import DEFAULTS, JointKind, JointProperties
from physsim_ros.model.names import WORLD
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Color, Shape


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
