# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The tables that the core steps, made anew when they are needed after a change.

Bodies have a row each in spawn order, the background last.
Law: a body of a new table continues with the state that it had in the one before.

Who writes a field of `Body` in `core/core.h`: `scene_columns` what follows from the scene,
`BodyTable` the address of the engine's body, wrench and state, and the core all others.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from physsim_ros.engine.bodies import BODY_STATE, RigidBody
from physsim_ros.engine.body_set import BodySet, wake_bodies
from physsim_ros.engine.core_world import copy_of, CoreWorld, Table
from physsim_ros.engine.grip_set import GripSet
from physsim_ros.engine.joints.joint_set import JointSet
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


class CoreTables:
    """
    The tables of the core.

    :param bodies: of the space
    :param joints: of the space
    :param grips: of hands on the bodies
    :param core: of the space
    :param dt: length of a sub-step [s]

    :ivar latest: the table of the bodies; None after a change, until it is made anew
    """

    def __init__(
        self, bodies: BodySet, joints: JointSet, grips: GripSet, core: CoreWorld, dt: float
    ) -> None:
        self.latest: BodyTable | None = None
        self._bodies = bodies
        self._joints = joints
        self._grips = grips
        self._core = core
        self._dt = dt
        # Row of the background in the last table; -1 if there was none.
        self._background = -1
        # Fields of the last table; None if there was none.
        self._fields: tuple[object, ...] | None = None

    def drop(self) -> None:
        """Drop the tables, before a body or joint is added, removed or changed."""
        self._core.drop_joints()
        self.latest = None

    def lay_out(self, scene: Scene) -> BodyTable:
        """Return a new table of the bodies, which the core steps from now on."""
        rigids = tuple(self._bodies.by_name.values())
        self._note_fields(scene)
        self.latest = table = BodyTable(scene, rigids, self._bodies.background, self._dt)
        self._core.use_bodies(table.records, [*(rigid.row for rigid in rigids), self._background])
        self._core.use(
            forces=table.columns.forces,
            regions=table.columns.regions,
            attractors=table.columns.attractors,
            robots=table.robots,
            actors=table.actors,
        )
        self._core.use_settings(scene.settings, has_fields=table.has_fields)
        self._background = len(rigids)
        self._grips.note_rows()
        for row, rigid in enumerate(rigids):
            rigid.row = row
        self.lay_out_joints()
        return table

    def lay_out_joints(self) -> None:
        """Have the core step the joints that there are."""
        if self._joints.by_name:
            rigids = self._bodies.by_name.values()
            bodies = (*(rigid.pm_body for rigid in rigids), self._bodies.background)
            self._joints.use_places({body: place for place, body in enumerate(bodies)})

    def _note_fields(self, scene: Scene) -> None:
        """Have bodies wake, and begin with the fields of now, where these are others."""
        columns, settings = columns_of(scene, self._dt), scene.settings
        fields = (
            _values(columns.regions),
            _values(columns.attractors),
            (settings.gravitation, settings.coulomb),
            (settings.attraction_power, settings.softening),
        )
        if self._fields not in (None, fields):
            wake_bodies(rigid.pm_body for rigid in self._bodies.by_name.values())
            for rigid in self._bodies.by_name.values():
                rigid.begin_fields()
        self._fields = fields


def _values(records: Table) -> tuple[bytes, ...]:
    """Return the numbers of records, without the bytes between the fields, which are any."""
    return tuple(records[name].tobytes() for name in records.dtype.names or ())
