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
What is seen: where everything is after a step, what touched, and what became of requests.

Law: what crosses the border is an immutable value or a fresh array, never an engine object.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.errors import Refusal
from physsim_ros.model.preview import NOTHING, Preview
from physsim_ros.model.scene import Scene
from physsim_ros.model.transform import turned

# What every message has, beside what it is made of.
_FRAME = 'header.frame_id'


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
        return self.poses.nbytes + self.twists.nbytes + self.forces.nbytes

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
