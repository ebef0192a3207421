# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The context of one step: what stages need from each other, by name."""

from __future__ import annotations

from typing import NamedTuple

from physsim_ros.engine.body_table import BodyTable
from physsim_ros.model.arrays import Floats
from physsim_ros.model.settings import WorldSettings


class StepContext(NamedTuple):
    """
    One step of the pipeline.

    :param table: the bodies
    :param dt: length of the step [s]
    :param step: number of steps that the world has made
    :param age: count of steps since the space was built; stages that act every n steps count by
        it, so that a space restored from a checkpoint goes on alike
    :param reports_contacts: whether contacts are reported
    :param poses: (n, 3) float64: poses of Pymunk's bodies as the step begins [m, rad]
    :param twists: (n, 3) float64: velocities [m/s] and spins [rad/s] that the engine begins the
        step with; a stage that changes one in the engine changes it here too
    """

    table: BodyTable
    dt: float
    step: int
    age: int
    reports_contacts: bool
    poses: Floats
    twists: Floats

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world."""
        return self.table.scene.settings
