# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The tables of bodies that the core steps: a row each in spawn order, the background last.

Who writes a field of `Body` in `core/core.h`: `scene_columns` what follows from the scene,
`BodyTable` the address of the engine's body, wrench and state, and the core all others.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from physsim_ros.engine.bodies import BODY_STATE, RigidBody
from physsim_ros.engine.core_world import copy_of
from physsim_ros.engine.layout import address_of
from physsim_ros.engine.odometry_noise import OdometryNoise
from physsim_ros.engine.scene_columns import columns_of
from physsim_ros.model.arrays import Flags, Floats, no_rows
from physsim_ros.model.scene import Scene
from physsim_ros.model.states import ACTOR_STATE, NO_ACTORS, NO_ROBOTS, Records, ROBOT_STATE
from physsim_ros.model.transform import NO_WRENCH, Wrench
import pymunk


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
    :ivar noise: of the odometry of these robots
    """

    def __init__(
        self, scene: Scene, bodies: Sequence[RigidBody], background: pymunk.Body, dt: float
    ) -> None:
        self.scene = scene
        self.bodies = tuple(bodies)
        self.columns = columns_of(scene, dt)
        self.records = copy_of(self.columns.bodies)
        self.robots = copy_of(self.columns.robots)
        self.actors = copy_of(self.columns.actors)
        self.noise = OdometryNoise(self.robots, scene)
        self.records['engine'] = [*(rigid.address for rigid in bodies), address_of(background)]
        for row, rigid in enumerate(bodies):
            if rigid.wrench != NO_WRENCH:
                self.records['wrench'][row] = rigid.wrench
        self._take_over_states()
        # Without sources, fields are only where velocities have led by them before.
        self._has_led = bool(self.records['state']['field'].any())

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

    def set_wrench(self, row: int, wrench: Wrench) -> None:
        """Set the wrench on the body of a row."""
        self.records['wrench'][row] = wrench

    @property
    def thrown(self) -> Flags:
        """Return (n,) bool: the velocity was set since the last step."""
        return self.records['state']['thrown'][:-1].astype(np.bool_)

    # Fields

    @property
    def has_fields(self) -> bool:
        """Return whether fields act on the bodies, or velocities lead by them."""
        sources = len(self.columns.regions) + len(self.columns.attractors)
        return sources > 0 or (self._has_led and bool(self.records['state']['field'].any()))

    @property
    def field_leads(self) -> Floats:
        """
        Return the leads of velocities by fields.

        :return: (n, 3) float64, NaN where a lead is to be found; none where there are no fields
        """
        if not self.has_fields:
            return no_rows()
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
        """Return the names of the bodies that have left the range of numbers in the last step."""
        rows = np.flatnonzero(self.records['lost'][:-1])
        return [self.scene.names[row] for row in rows.tolist()]

    # Floor and robots

    @property
    def pushes(self) -> Floats:
        """
        Return what contacts and joints have changed in the last steps.

        :return: (k, 3) float64: changes of velocity [m/s] and spin [rad/s] of the bodies that the
            floor acts on, in spawn order
        """
        return self.records['state']['push'][self.records['braking'] > 0.0]

    @property
    def robot_states(self) -> Records:
        """Return (r,) `ROBOT_STATE`: drives and odometry of the robots."""
        return self.robots['state'].astype(ROBOT_STATE) if len(self.robots) else NO_ROBOTS

    @property
    def actor_states(self) -> Records:
        """Return (a,) `ACTOR_STATE`: the states of the actors."""
        return self.actors['state'].astype(ACTOR_STATE) if len(self.actors) else NO_ACTORS
