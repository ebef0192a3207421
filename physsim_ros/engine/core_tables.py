# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The tables of a space that the core steps, made anew when they are needed after a change.

Law: a body of a new table continues with the state that it had in the one before.
"""

from __future__ import annotations

from physsim_ros.engine.body_set import BodySet, wake_bodies
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.core_world import CoreWorld, Table
from physsim_ros.engine.grip_set import GripSet
from physsim_ros.engine.joints.joint_set import JointSet
from physsim_ros.engine.scene_columns import columns_of
from physsim_ros.model.scene import Scene


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
