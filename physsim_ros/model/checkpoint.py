# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Saved states of a world: for files, and checkpoints for rewind.

Law: two worlds that continue from the same checkpoint have the same bits ever after.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats, Ints, no_rows
from physsim_ros.model.lesson import Lesson
from physsim_ros.model.motor_command import TimedCommand
from physsim_ros.model.scene import Body, Joint, Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Grip
from physsim_ros.model.states import (
    ActorState,
    DriveCommand,
    NEVER,
    NO_ACTORS,
    NO_ROBOTS,
    Records,
    RobotState,
)
from physsim_ros.model.transform import NO_WRENCH, Pose, REST, Twist, Wrench


class Motion(NamedTuple):
    """
    The engine's state of a body, from which it continues to the bit.

    x, y [m], yaw [rad] of its centre of mass; vx, vy [m/s], spin [rad/s]; whether it is in free
    flight, in which the engine's velocity leads the reported one by half a sub-step.
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
    A body and its state.

    :param body: without pose and velocity; `expires` counts from the step of the state
    :param pose: of its origin in the world [m, rad]
    :param twist: velocity of the centre of mass [m/s] and spin [rad/s]
    :param motion: the engine's numbers for these two; None in a file written by hand
    :param field_lead: lead of that velocity by fields [m/s, rad/s]; None is to be found
    :param wrench: force [N] and torque [N m] that act on it
    :param wrench_steps: number of further steps in which the wrench acts; None is for ever
    :param driven: of a robot, the state of its drive and odometry, whose `until` counts from now
    :param coming: of a robot, the commands that its drive does not obey yet, counted from now
    :param acting: of an actor, its state, whose `begun` counts from now
    """

    body: Body
    pose: Pose
    twist: Twist = REST
    motion: Motion | None = None
    field_lead: Twist | None = None
    wrench: Wrench = NO_WRENCH
    wrench_steps: int | None = None
    driven: RobotState | None = None
    coming: tuple[DriveCommand, ...] = ()
    acting: ActorState | None = None

    def with_steps(self, ratio: float) -> BodyState:
        """Return it with times in other steps, as many in a second as before times a ratio."""
        body, driven, acting = self.body, self.driven, self.acting
        if body.expires is not None:
            body = replace(body, expires=max(1, round(body.expires * ratio)))
        steps = self.wrench_steps
        return replace(
            self,
            body=body,
            # Those of the engine are of its own steps.
            motion=None,
            field_lead=None,
            wrench_steps=None if steps is None else round(steps * ratio),
            driven=driven and driven._replace(until=_scaled(driven.until, ratio)),
            coming=tuple(
                DriveCommand(_scaled(begun, ratio), aim, _scaled(until, ratio))
                for begun, aim, until in self.coming
            ),
            acting=acting and acting._replace(begun=_scaled(acting.begun, ratio)),
        )


def _scaled(step: int, ratio: float) -> int:
    return step if step == NEVER else round(step * ratio)


# The last command of each motor, and those on their way to it in their order.
TimedCommands = tuple[TimedCommand, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class WorldState:
    """
    The state of a world for a file: bodies, joints, settings; no time.

    :param settings: of the world
    :param bodies: in spawn order
    :param joints: in the order in which they were made
    :param commands: of motors, also those on their way, whose steps count from now
    :param memory: impulse cache; None in a file written by hand
    :param lesson: the task that belongs to the world; None is none
    :param physics_rate: steps in a second, by which its times count [Hz]; None where it has no
        times
    :param world: the same for states that `replace` makes of one another, as a reset with another
        seed does
    """

    settings: WorldSettings
    bodies: tuple[BodyState, ...] = ()
    joints: tuple[Joint, ...] = ()
    commands: TimedCommands = ()
    lesson: Lesson | None = None
    memory: ImpulseCache | None = field(default=None, compare=False)
    physics_rate: float | None = field(default=None, compare=False, repr=False)
    world: object = field(default_factory=object, compare=False, repr=False)

    def at_rate(self, physics_rate: float) -> WorldState:
        """
        Return the state for a world that makes other steps, with times to the nearest one.

        Of a world with as many steps a second it is the state itself, which continues to the bit.

        :param physics_rate: of that world [Hz]
        """
        if self.physics_rate is None or self.physics_rate == physics_rate:
            return self
        ratio = physics_rate / self.physics_rate
        return replace(
            self,
            bodies=tuple(each.with_steps(ratio) for each in self.bodies),
            commands=tuple(
                each._replace(begun=round(each.begun * ratio)) for each in self.commands
            ),
            memory=None,
            physics_rate=physics_rate,
        )


# In memory once.
_NO_TOTALS: Floats = np.empty((0, 2))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ImpulseCache:
    """
    The impulse cache: accumulated impulses of contacts, with which the engine warm starts a step.

    :param ids: (n,) int64: the engine's number of each body's first shape, in spawn order
    :param walls: the same of the first wall of `bounds`; 0 if there are none
    :param following: number of the next shape that the engine makes
    :param pairs: (k, 2) int64: numbers of the two shapes of each contact point
    :param hashes: (k,) uint64: feature ids of the contact points (Chipmunk: cpContact.hash)
    :param impulses: (k, 2) float64: normal and tangential, of the last step [N s]
    :param joints: (c, 2) float64: of the engine's constraints, joint by joint [N s, N m s]
    :param totals: (c, 2) float64: impulses of the same in the last step, world axes; none if
        unknown
    :param pushes: (k, 3) float64: changes of velocity [m/s] and spin [rad/s] by contacts and
        joints, of the bodies that a floor acts on
    """

    ids: Ints
    walls: int
    following: int
    pairs: Ints
    hashes: NDArray[np.uint64]
    impulses: Floats
    joints: Floats
    totals: Floats = field(default_factory=lambda: _NO_TOTALS)
    pushes: Floats = field(default_factory=no_rows)

    @property
    def nbytes(self) -> int:
        """Memory of its arrays [bytes]."""
        contacts = self.ids, self.pairs, self.hashes, self.impulses
        return sum(array.nbytes for array in (*contacts, self.joints, self.totals, self.pushes))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Checkpoint:
    """
    The whole state of a world at a step, after the requests of that step.

    :param step: number of steps since the world began
    :param scene: the bodies and the settings
    :param state: (n, 6) float64: pose and velocity of each engine body [m, rad, s]
    :param free: (n,) bool: in free flight, so that the engine's velocity leads
    :param thrown: (n,) bool: the velocity was set since the last step
    :param field_leads: (n, 3) float64: leads of velocities [m/s] and spins [rad/s] by fields, NaN
        where one is to be found; none where there are no fields
    :param wrenches: row of the body, wrench [N, N m], and the step at which it ends or None
    :param memory: impulse cache
    :param grips: of hands on bodies
    :param unstepped: names of the joints whose first step is to come
    :param commands: of motors, also those on their way
    :param bounds: `lower` and `upper` of the rows of joints of which one moves, by name
    :param robots: (r,) `ROBOT_STATE`: states of the robots, in the order of the scene
    :param coming: row of the body of a robot, and the commands that its drive does not obey yet
    :param actors: (a,) `ACTOR_STATE`: states of the actors, in the order of the scene
    """

    step: int
    scene: Scene
    state: Floats
    free: NDArray[np.bool_]
    thrown: NDArray[np.bool_]
    wrenches: tuple[tuple[int, Wrench, int | None], ...]
    memory: ImpulseCache
    field_leads: Floats = field(default_factory=no_rows)
    grips: tuple[Grip, ...] = ()
    unstepped: frozenset[str] = frozenset()
    commands: TimedCommands = ()
    bounds: Mapping[str, NDArray[np.void]] = field(default_factory=dict)
    robots: Records = field(default_factory=lambda: NO_ROBOTS)
    coming: tuple[tuple[int, tuple[DriveCommand, ...]], ...] = ()
    actors: Records = field(default_factory=lambda: NO_ACTORS)

    @property
    def nbytes(self) -> int:
        """Memory of its arrays [bytes]."""
        arrays = self.state, self.free, self.thrown, self.robots, self.actors
        return sum(array.nbytes for array in arrays) + self.field_leads.nbytes + self.memory.nbytes
