# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Applied forces: constant forces that act at points of a body for as long as it has them.

A force along the axes of the world keeps its direction, as wind or a rope over a pulley; one along
the axes of the body turns with it, as a thruster. The core applies them in each sub-step
(`engine/core/applied_forces.c`).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from physsim_ros.model.checks import AT_WORDS, check_point, HEAVIEST, ListOf, OneOf, Vector
from physsim_ros.model.declarations import Checked
from physsim_ros.model.transform import NO_WRENCH, Point, rotated, Wrench

# Greatest number of applied forces of a body.
MOST_FORCES = 16
# Along the axes of the world, or of the body.
AXES = ('world', 'body')


@dataclass(frozen=True, slots=True, kw_only=True)
class AppliedForce(Checked):
    """
    A constant force on a body.

    :raises Malformed: a number is not finite, or an array has the wrong length
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    force: Annotated[Point, Vector(HEAVIEST, 'N', 'greater'), 'x and y along its `axes`']
    at: Annotated[
        Point | None,
        check_point,
        'x, y [m] in the frame of the body, where it acts; by default the centre of mass',
        AT_WORDS,
    ] = None
    axes: Annotated[
        str,
        OneOf(AXES),
        '`world` for a fixed direction, as wind; `body` for one that turns with the body, as that '
        'of a thruster',
    ] = 'world'

    def arm(self, centroid: Point) -> Point:
        """Return where it acts, as seen from the centre of mass, in the axes of the body [m]."""
        x, y = centroid if self.at is None else self.at
        return x - centroid[0], y - centroid[1]

    def in_world(self, yaw: float) -> Point:
        """Return the force in world axes [N], on a body with a yaw [rad]."""
        return rotated(self.force, yaw) if self.axes == 'body' else self.force


# The check of the applied forces of a body.
forces_from = ListOf(AppliedForce.from_value, 'forces', MOST_FORCES)


def wrench_of(forces: Sequence[AppliedForce], centroid: Point, yaw: float) -> Wrench:
    """
    Return the sum of applied forces [N], and their torque about the centre of mass [N m].

    :param centroid: centre of mass in the frame of the body [m]
    :param yaw: of the body [rad]
    """
    fx, fy, torque = NO_WRENCH
    for each in forces:
        (x, y), (arm_x, arm_y) = each.in_world(yaw), rotated(each.arm(centroid), yaw)
        fx, fy, torque = fx + x, fy + y, torque + arm_x * y - arm_y * x
    return fx, fy, torque
