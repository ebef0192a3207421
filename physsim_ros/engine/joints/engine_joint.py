# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A joint in the engine: its description, its constraints, and the impulses that these gave."""

from __future__ import annotations

from dataclasses import dataclass

from physsim_ros.engine.memory import impulse_places, NUMBERS
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Joint
from physsim_ros.model.transform import Point
import pymunk
from pymunk import Vec2d

_Axial = pymunk.PinJoint | pymunk.SlideJoint | pymunk.DampedSpring


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

    @property
    def pull(self) -> Vec2d:
        """
        Return the linear impulse on the second body in the last step, world axes [N s].

        Chipmunk keeps the impulse of a pivot as a vector, that of a rod, a rope, a spring or a
        limit as a number along the line from one anchor to the other. Of a joint with an axis the
        anchors are put anew in each step, so that its lines are taken from its axis instead.
        """
        total = Vec2d.zero()
        for constraint in self.constraints:
            x, *y = NUMBERS[impulse_places(constraint)].tolist()
            if isinstance(constraint, pymunk.PivotJoint):
                total += Vec2d(x, *y)
            elif isinstance(constraint, _Axial):
                has_axis = self.joint.kind.schema.has_axis
                total += (_by_axis(self, constraint) if has_axis else _between(constraint)) * x
        return total


def _between(constraint: _Axial) -> Vec2d:
    """Return the unit vector from the first anchor to the second."""
    start = constraint.a.local_to_world(constraint.anchor_a)
    return (constraint.b.local_to_world(constraint.anchor_b) - start).normalized()


def _by_axis(joint: EngineJoint, constraint: _Axial) -> Vec2d:
    """Return the unit vector along which a constraint about an axis acts on the second body."""
    ends, seat = joint.ends, joint.joint.seat
    u = Vec2d(seat.ux, seat.uy).rotated(ends.b.angle)
    # Both constraints have the bodies of the joint the other way round.
    if not isinstance(constraint, pymunk.SlideJoint):
        return -u.perpendicular()
    apart = ends.a.local_to_world(ends.at_a) - constraint.a.local_to_world(constraint.anchor_a)
    # Chipmunk turns its normal round at the lower limit.
    return u if 2.0 * apart.length < constraint.min + constraint.max else -u
