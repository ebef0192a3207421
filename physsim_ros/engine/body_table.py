# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""One table of all bodies: a row each, in spawn order, and last a row for the background."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from physsim_ros.engine.body import BODY_STATE, RigidBody
from physsim_ros.engine.layout import address_of
from physsim_ros.engine.scene_columns import columns_of
from physsim_ros.model.arrays import Floats
from physsim_ros.model.checkpoint import NO_FIELDS
from physsim_ros.model.noise import normals
from physsim_ros.model.scene import Scene
from physsim_ros.model.states import ACTOR_STATE, NO_ACTORS, NO_ROBOTS, Records, ROBOT_STATE
from physsim_ros.model.transform import NO_WRENCH
import pymunk

# A body beyond this position or speed is removed [m, m/s, rad, rad/s]; `step.c` has it too.
LOST = 1e12
# Steps whose noise is made at once: a call of `normals` takes as long as 300 of its numbers.
_BLOCK = 64


class BodyTable:
    """
    The bodies of a space as the tables of the core.

    :param scene: of these bodies
    :param bodies: in spawn order
    :param background: Pymunk's static body, which has the walls
    :param dt: length of a sub-step [s]

    :ivar columns: what follows from the scene alone
    :ivar records: (n + 1,) `Body`; the last one is the background
    :ivar robots: (r,) `Robot`, in the order of their bodies
    :ivar actors: (a,) `Actor`, the same
    """

    def __init__(
        self, scene: Scene, bodies: Sequence[RigidBody], background: pymunk.Body, dt: float
    ) -> None:
        self.scene = scene
        self.bodies = tuple(bodies)
        self.columns = columns_of(scene, dt)
        self.records = self.columns.bodies.copy()
        self.robots = self.columns.robots.copy()
        self.actors = self.columns.actors.copy()
        # Blocks of noise by robot and number, until they are used up.
        self._blocks: dict[tuple[int, int], Floats] = {}
        self.records['engine'] = [*(rigid.address for rigid in bodies), address_of(background)]
        for row, rigid in enumerate(bodies):
            if rigid.wrench != NO_WRENCH:
                self.records['wrench'][row] = rigid.wrench
        self._take_over_states()

    def _take_over_states(self) -> None:
        """Continue with the states of the bodies, which are in this table from now on."""
        states = self.records['state'][:-1]
        states[:] = np.frombuffer(
            b''.join(rigid.state.tobytes() for rigid in self.bodies), BODY_STATE
        )
        for rigid, state in zip(self.bodies, states, strict=True):
            rigid.state = state
        for table, kind in ((self.robots, 'driven'), (self.actors, 'acting')):
            for row, record in zip(table['body'].tolist(), table, strict=True):
                record['state'] = getattr(self.bodies[row], kind)
                setattr(self.bodies[row], kind, record['state'])

    # Fields

    @property
    def has_fields(self) -> bool:
        """Return whether fields act on the bodies, or velocities lead by them."""
        sources = len(self.columns.regions) + len(self.columns.attractors)
        return sources > 0 or bool(self.records['state']['field'].any())

    @property
    def field_leads(self) -> Floats:
        """
        Return the leads of velocities by fields.

        :return: (n, 3) float64, NaN where a lead is to be found; none where there are no fields
        """
        if not self.has_fields:
            return NO_FIELDS
        own = self.records['state'][:-1]
        return np.where(own['fresh'][:, None], np.nan, own['field'])

    def field_forces(self, dt: float) -> Floats:
        """
        Return the forces of fields in the last sub-step.

        :param dt: length of a sub-step [s]
        :return: (n, 2) float64: [N]; none where there are no fields
        """
        if not self.has_fields:
            return np.empty((0, 2))
        leads: Floats = self.records['state']['field'][:-1, :2]
        return leads * (2.0 / dt) * self.scene.inertia[:, :1]

    def lost(self) -> list[str]:
        """Return the names of the bodies whose state is not finite, or too large."""
        names = []
        for rigid in self.bodies:
            pm_body = rigid.pm_body
            state = *pm_body.position, pm_body.angle, *pm_body.velocity, pm_body.angular_velocity
            # NaN compares false, so that it is lost too.
            if not all(abs(each) < LOST for each in state):
                names.append(rigid.body.name)
        return names

    # Floor and robots

    @property
    def pushes(self) -> Floats:
        """
        Return what contacts and joints have changed in the last steps.

        :return: (k, 3) float64: changes of velocity [m/s] and spin [rad/s] of the bodies that the
            floor acts on, in spawn order
        """
        return self.records['state']['push'][self.records['floor_friction'] > 0.0]

    @property
    def robot_states(self) -> Records:
        """Return (r,) `ROBOT_STATE`: drives and odometry of the robots."""
        return self.robots['state'].astype(ROBOT_STATE) if len(self.robots) else NO_ROBOTS

    @property
    def actor_states(self) -> Records:
        """Return (a,) `ACTOR_STATE`: the states of the actors."""
        return self.actors['state'].astype(ACTOR_STATE) if len(self.actors) else NO_ACTORS

    def make_noise(self, step: int, count: int) -> None:
        """Make the noise of odometry for some steps: it depends on seed, name and step alone."""
        robots = self.scene.robots
        noisy = [number for number, robot in enumerate(robots) if any(robot.odometry.slip)]
        if not noisy:
            return
        first, last = step // _BLOCK, (step + count - 1) // _BLOCK
        wanted = [(number, block) for number in noisy for block in range(first, last + 1)]
        kept = self._blocks
        self._blocks = {key: kept[key] if key in kept else self._noise_of(*key) for key in wanted}
        rows = np.stack([self._blocks[key] for key in wanted]).reshape(len(noisy), -1)
        # Kept while the core reads it.
        begin = 2 * (step - first * _BLOCK)
        self._noise = rows[:, begin:]
        for row, number in enumerate(noisy):
            self.robots[number]['noise'] = self._noise[row].ctypes.data

    def _noise_of(self, number: int, block: int) -> Floats:
        """Return (2 _BLOCK,) float64: a block of the noise of a robot, two numbers a step."""
        name = f'odometry of {self.scene.names[self.robots["body"][number]]}'
        return normals(self.scene.settings.seed, name, block, 2 * _BLOCK)
