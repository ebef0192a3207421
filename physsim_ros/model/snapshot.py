# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Snapshots and frames: the state after a step, and all that is published with it.

Law: all values of a world are immutable, arrays read-only; none is an object of the engine.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import NamedTuple

import numpy as np
from physsim_ros.model.answer import Answer
from physsim_ros.model.arrays import Flags, Floats, Ints
from physsim_ros.model.errors import no_body
from physsim_ros.model.names import WORLD
from physsim_ros.model.preview import NO_PREVIEW, Preview
from physsim_ros.model.scene import Joint, Scene
from physsim_ros.model.spelling import canonical
from physsim_ros.model.states import NO_ROBOTS, Records
from physsim_ros.model.transform import Point, rotated_each


class Grip(NamedTuple):
    """
    The grip of a hand on a body; Box2D's mouse joint.

    :ivar hand: name of the hand, unique in its world
    :ivar body: name of the body
    :ivar anchor: point of the body that is drawn to the hand, in the body's frame [m]
    :ivar target: position of the hand in the world [m]
    """

    hand: str
    body: str
    anchor: Point
    target: Point


class Springs(NamedTuple):
    """
    The springs of a world with the engine's constants.

    :ivar numbers: (k,) int64: rows of the joints that are springs on a dynamic body
    :ivar stiffness: (k,) float64: [N/m]
    :ivar rest: (k,) float64: length without force [m]
    :ivar reach: (k,) float64: extension from which the force is constant [m]
    """

    numbers: Ints
    stiffness: Floats
    rest: Floats
    reach: Floats

    def energy(self, length: Floats) -> tuple[Floats, Floats]:
        """
        Return (k,) float64 each: potential energy [J] and absolute force [N].

        :param length: (k,) float64: present length of each spring [m]
        """
        extension = np.abs(length - self.rest)
        elastic = np.minimum(extension, self.reach)
        force = self.stiffness * elastic
        return force * (elastic / 2 + (extension - elastic)), force


# (0, 2) float64: forces that are unknown.
NO_VECTORS = np.empty((0, 2))
NO_SPRINGS = Springs(np.empty(0, np.int64), np.empty(0), np.empty(0), np.empty(0))


@dataclass(frozen=True, kw_only=True, eq=False)
class Snapshot:
    """
    The state of a world after a step.

    :param step: number of steps since the world began
    :param stamp: simulation time, step / physics_rate [ns]
    :param scene: the bodies and joints of the rows
    :param poses: (n, 3) float64: x, y [m], yaw [rad] of each body's origin
    :param twists: (n, 3) float64: vx, vy [m/s] of each centre of mass, spin [rad/s]; world axes
    :param forces: (j,) float64: force of each joint in the last step [N]; of a torque, at an arm
        of 1 m; empty if unknown
    :param compressed: (j,) bool: whether that force pushes the bodies of a rod or spring apart;
        empty if unknown
    :param springs: those of the joints that are springs
    :param grips: of hands on bodies
    :param pulls: (j, 2) float64: force of each joint on its body b in the last step, world axes
        [N]; empty if contacts were not requested
    :param fields: (n, 2) float64: force of media and attraction on each body in the last sub-step,
        world axes [N]; empty if there are none, or contacts were not requested
    :param robots: (r,) `ROBOT_STATE`: states of the robots, in the order of `scene.robot_rows`
    """

    step: int
    stamp: int
    scene: Scene
    poses: Floats
    twists: Floats
    forces: Floats = field(default_factory=lambda: np.empty(0))
    compressed: Flags = field(default_factory=lambda: np.empty(0, dtype=bool))
    springs: Springs = NO_SPRINGS
    grips: tuple[Grip, ...] = ()
    pulls: Floats = field(default_factory=lambda: NO_VECTORS)
    fields: Floats = field(default_factory=lambda: NO_VECTORS)
    robots: Records = field(default_factory=lambda: NO_ROBOTS)

    def row(self, name: str) -> int:
        """
        Return the row of a body in `poses` and `twists`.

        :raises UnknownBody: no body has that name; the most similar name is told
        """
        row = self.scene.row_of.get(canonical(name), -1)
        if row < 0:
            raise no_body(name, self.scene.names, '')
        return row

    def copy(self) -> Snapshot:
        """Return a copy without cached properties, ten times as fast as `replace`."""
        copy, state = Snapshot.__new__(Snapshot), vars(self)
        if len(state) > len(_FIELDS):
            state = {name: state[name] for name in _FIELDS}
        vars(copy).update(state)
        return copy

    @property
    def nbytes(self) -> int:
        """Memory of its arrays [bytes], without cached properties."""
        size = self.poses.nbytes + self.twists.nbytes + self.robots.nbytes + self.fields.nbytes
        if len(self.forces):
            arrays = self.forces, self.compressed, self.pulls, *self.springs
            size += sum(array.nbytes for array in arrays)
        return size

    @cached_property
    def centers(self) -> Floats:
        """(n, 2) float64: centres of mass, world [m]."""
        return self.poses[:, :2] + rotated_each(self.scene.centroids, self.poses[:, 2])

    @cached_property
    def kinetic_energy(self) -> float:
        """Kinetic energy of all dynamic bodies [J]."""
        mass, moment = self.scene.inertia.T
        speed2 = (self.twists[:, :2] ** 2).sum(axis=1)
        return float((mass * speed2 + moment * self.twists[:, 2] ** 2).sum() / 2)

    @cached_property
    def potential_energy(self) -> float:
        """Potential energy of all dynamic bodies in the field of gravity, 0 at the origin [J]."""
        weights = self.scene.inertia[:, :1] * self.scene.settings.gravity
        # + 0.0 removes the sign of a negative zero, here and in the momentum.
        return float(-(weights * self.centers).sum()) + 0.0

    @cached_property
    def elastic_energy(self) -> float:
        """Potential energy of all springs, torsion springs among them [J]."""
        ends = self.ends[self.springs.numbers]
        offset = ends[:, 0] - ends[:, 1]
        energy, _ = self.springs.energy(np.hypot(offset[:, 0], offset[:, 1]))
        return float(energy.sum()) + sum(map(self._torsion_energy, self.scene.torsion_springs))

    def _torsion_energy(self, joint: Joint) -> float:
        rows, stiffness, most = self.scene.row_of, joint.stiffness, joint.properties.max_force
        yaws = [0.0 if name == WORLD else self.poses[rows[name], 2] for name in (joint.a, joint.b)]
        strain = abs(yaws[0] - yaws[1] + joint.seat.phase - joint.number('rest_angle'))
        # Beyond that angle its torque is constant.
        elastic = strain if most is None else min(strain, most / stiffness)
        return float(stiffness * elastic * (strain - elastic / 2.0))

    @cached_property
    def ends(self) -> Floats:
        """(j, 2, 2) float64: anchor points of each joint on its bodies a and b, world [m]."""
        seats, rows = self.scene.seats, self.scene.joint_rows
        # Row -1, the background, is the row of zeros appended here.
        poses = np.vstack((self.poses, np.zeros((1, 3))))[rows]
        return poses[..., :2] + rotated_each(seats[:, :4].reshape(-1, 2, 2), poses[..., 2])

    @cached_property
    def grip_lines(self) -> Floats:
        """(h, 2, 2) float64: of each grip its anchor on the body, and its hand, world [m]."""
        rows = {name: row for row, name in enumerate(self.scene.names)} if self.grips else {}
        poses = self.poses[[rows[grip.body] for grip in self.grips]].reshape(-1, 3)
        anchors = np.array([grip.anchor for grip in self.grips]).reshape(-1, 2)
        targets = np.array([grip.target for grip in self.grips]).reshape(-1, 2)
        return np.stack((poses[:, :2] + rotated_each(anchors, poses[:, 2]), targets), axis=1)

    @cached_property
    def momentum(self) -> tuple[float, float]:
        """Linear momentum of all dynamic bodies [kg m/s]."""
        x, y = ((self.scene.inertia[:, :1] * self.twists[:, :2]).sum(axis=0) + 0.0).tolist()
        return x, y


_FIELDS = tuple(each.name for each in fields(Snapshot))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Contacts:
    """
    The pairs of bodies that touched during a frame, each pair once, in a stable order.

    :param pairs: (m, 2) int64: rows of the two bodies in the scene, the earlier spawned first;
        -1, always second, is the walls of `bounds`
    :param points: (m, 2) float64: mean of the latest contact points, world [m]
    :param normals: (m, 2) float64: unit vector from the first to the second body, world
    :param impulses: (m, 2) float64: sum over the frame of the impulses on the second body by the
        first, world [N s]
    :param steps: number of steps over which the impulses are summed
    :param begun: (k, 2) int64: rows, as in `pairs`, of the pairs that began to touch during the
        frame, in the order of time; a pair that touched again is there again
    :param begun_at: (k,) float64: when each began, since the frame began [steps]
    """

    pairs: Ints
    points: Floats
    normals: Floats
    impulses: Floats
    steps: int = 0
    begun: Ints = field(default_factory=lambda: np.empty((0, 2), np.int64))
    begun_at: Floats = field(default_factory=lambda: np.empty(0))

    @property
    def nbytes(self) -> int:
        """Memory it takes [bytes]."""
        # Views of the engine's records, of nine and of three numbers of 8 bytes.
        return 72 * len(self.pairs) + 24 * len(self.begun)


NO_CONTACTS = Contacts(
    pairs=np.empty((0, 2), dtype=np.int64),
    points=np.empty((0, 2)),
    normals=np.empty((0, 2)),
    impulses=np.empty((0, 2)),
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Frame:
    """
    Everything that the simulation publishes at once: state, contacts and answers.

    :param snapshot: state after the last step
    :param contacts: since the frame before; None if they were not requested
    :param answers: to the requests applied since the frame before, in their order
    :param speed: simulation time by wall time; 0 is paused
    :param stepped: whether steps, forward or back, led to it; not a request or a jump alone
    :param preview: of the unfinished drawing
    :param past: whether something lies ahead of it, on its course
    :param course: number of the course of events in force
    """

    snapshot: Snapshot
    contacts: Contacts | None
    answers: tuple[Answer, ...] = field(default=())
    speed: float = 1.0
    stepped: bool = True
    preview: Preview = NO_PREVIEW
    past: bool = False
    course: int = 1

    @property
    def passing(self) -> bool:
        """Return whether time runs here, so that the next frame comes of itself."""
        return self.stepped and self.speed != 0.0

    def has_passed(self, seconds: float, *, since: Frame) -> bool:
        """
        Return whether a time has passed since another frame, or back to this one in a rewind.

        :param seconds: simulation time [s], times the speed where that is above 1
        """
        elapsed = abs(self.snapshot.stamp - since.snapshot.stamp) * 1e-9
        # Stamps are rounded.
        return elapsed > seconds * max(1.0, abs(self.speed)) - 1e-6
