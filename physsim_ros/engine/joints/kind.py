# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A joint in the engine, and a kind of joint: the functions that one file a kind provides.

A constraint row is a number x of the poses of two bodies with lower <= x <= upper; of an equality
both bounds are the same. C is how far x lies outside its bounds [m, rad], J = dx/dq its Jacobian.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from physsim_ros.engine.graph_search import Rows
from physsim_ros.engine.memory import impulse_places, NUMBERS
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Joint
from physsim_ros.model.transform import Point
import pymunk


@dataclass(frozen=True, slots=True)
class Ends:
    """
    The two bodies of a joint in the engine, and its anchors.

    :param a: one body
    :param b: another one, or the background
    :param at_a: anchor in the frame of the first, its origin the centre of mass [m]
    :param at_b: the same in the frame of the second
    """

    a: pymunk.Body
    b: pymunk.Body
    at_a: Point
    at_b: Point


@dataclass(frozen=True, slots=True, eq=False)
class EngineJoint:
    """
    A joint and its constraints.

    :param joint: its description
    :param ends: its bodies and anchors
    :param constraints: those of Pymunk; none where neither body is dynamic
    """

    joint: Joint
    ends: Ends
    constraints: tuple[pymunk.Constraint, ...]

    @property
    def impulse(self) -> float:
        """Return the greatest impulse of a constraint in the last step [N s, N m s]."""
        # That of a spring is negative where it pulls.
        return max((abs(each.impulse) for each in self.constraints), default=0.0)

    @property
    def limited(self) -> tuple[pymunk.Constraint, ...]:
        """Return the constraints that `max_force` limits: a motor has a greatest torque."""
        return tuple(each for each in self.constraints if not isinstance(each, pymunk.SimpleMotor))

    @property
    def is_compressed(self) -> bool:
        """Return whether a rod or spring pushed its bodies apart in the last step."""
        if self.joint.kind not in {JointKind.ROD, JointKind.SPRING} or not self.constraints:
            return False
        # Pymunk gives the impulse of a rod without its sign.
        return bool(NUMBERS[impulse_places(self.constraints[0])[0]] > 0.0)


class Batch(NamedTuple):
    """
    Joints of one kind, by column.

    :ivar numbers: (k,) of the joints in their set
    :ivar a: (k,) row of the first body in the states
    :ivar b: (k,) row of the second body
    :ivar at_a: (k, 2) float64: anchor in the frame of the first body [m]
    :ivar at_b: (k, 2) float64: anchor in the frame of the second body [m]
    :ivar axis: (k, 2) float64: unit vector of a slider in the frame of the second body
    :ivar ratio: (k,) float64: of a gear
    :ivar lower: (k, r) float64: least value of each row [m, rad]
    :ivar upper: (k, r) float64: greatest value of each row [m, rad]
    :ivar constraints: (k,) the engine's pointer to the first constraint of each
    """

    numbers: Rows
    a: Rows
    b: Rows
    at_a: Floats
    at_b: Floats
    axis: Floats
    ratio: Floats
    lower: Floats
    upper: Floats
    constraints: list[Any]


class Kind(NamedTuple):
    """
    The functions of one kind of joint.

    :ivar constraints: makes the Pymunk constraints; their impulses, but those of motors and
        springs, are those of the rows in the same order
    :ivar bounds: returns (lower, upper) of each constraint row of a joint [m, rad]
    :ivar rows: returns the (k, r) values x and the (k, r, 6) Jacobian J at the (k, 3) poses of the
        first and the second bodies; None where the engine alone solves the joint
    :ivar prepare: changes constraints before a step, at the poses that it will have; None where
        they do not depend on poses
    """

    constraints: Callable[[Joint, Ends], list[pymunk.Constraint]]
    bounds: Callable[[Joint], Sequence[tuple[float, float]]] = lambda _: ()
    rows: Callable[[Batch, Floats, Floats], tuple[Floats, Floats]] | None = None
    prepare: Callable[[Batch, Floats, Floats], None] | None = None


EQUAL = (0.0, 0.0)
