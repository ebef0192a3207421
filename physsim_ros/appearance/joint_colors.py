# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The colours of joints by their forces.

A joint without force is slate. With a growing force it becomes red where the force pulls, blue
where it pushes, and amber where the joint has no line along which to pull or push. The colour is
full at `break_force`, or at twice the weight of the heaviest body.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot

# Colours at no force, and at the full-scale force: red, green, blue.
SLATE, PULL, PUSH = (0.25, 0.3, 0.38), (0.84, 0.1, 0.12), (0.1, 0.35, 0.9)
_AMBER = (0.93, 0.6, 0.13)
# Full-scale force of a joint without `break_force`: in weights of the heaviest body; and the least
# one [N].
_FULL_SCALE, _LEAST = 2.0, 1e-3


class JointColors:
    """
    The colours of all joints of a scene.

    :param scene: with the joints
    """

    def __init__(self, scene: Scene) -> None:
        full = full_scale_force(scene)
        self._full_scale = np.array(
            [joint.properties.break_force or full for joint in scene.joints]
        )
        self._along_line = np.array(
            [joint.kind.schema.along_line for joint in scene.joints], dtype=bool
        )

    def at(self, snapshot: Snapshot) -> NDArray[np.float32]:
        """
        Return red, green, blue and alpha of each joint, (j, 4) float32.

        :param snapshot: with the forces; where they are unknown, they count as 0
        """
        count = len(self._full_scale)
        forces, compressed = snapshot.forces, snapshot.compressed
        if len(forces) != count:
            forces = np.zeros(count)
        if len(compressed) != count:
            compressed = np.zeros(count, dtype=bool)
        share = np.clip(forces / self._full_scale, 0.0, 1.0)[:, None]
        full = np.where(
            self._along_line[:, None], np.where(compressed[:, None], PUSH, PULL), _AMBER
        )
        colors = np.ones((count, 4), dtype=np.float32)
        colors[:, :3] = (1.0 - share) * np.array(SLATE) + share * full
        return colors


def full_scale_force(scene: Scene) -> float:
    """
    Return the force at the end of the colour scale, of joints without `break_force` [N].

    It is a round number, at least twice the weight of the heaviest body.
    """
    heaviest = float(scene.inertia[:, 0].max(initial=0.0))
    greatest = _FULL_SCALE * scene.settings.reference_gravity * heaviest
    return nice_number(max(greatest, _LEAST))


def nice_number(value: float) -> float:
    """Return the least of 1, 2 and 5 times a power of ten that is at least a value > 0."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(
        step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= value * (1 - 1e-9)
    )
