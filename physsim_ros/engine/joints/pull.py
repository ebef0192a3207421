# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Pull: the linear impulse of a joint as a vector.

Chipmunk keeps the impulse of a pivot as a vector, that of a rod, a rope, a spring or a limit as a
number along the line from one anchor to the other. Of a slider the anchors are put anew in each
step, so that its lines are taken from its axis instead.
"""

from __future__ import annotations

from physsim_ros.engine.joints.kind import EngineJoint
from physsim_ros.engine.memory import impulse_places, NUMBERS
from physsim_ros.model.joints import JointKind
import pymunk
from pymunk import Vec2d

_Axial = pymunk.PinJoint | pymunk.SlideJoint | pymunk.DampedSpring


def impulse_on_b(joint: EngineJoint) -> Vec2d:
    """Return the impulse of a joint on its second body in the last step, world axes [N s]."""
    total = Vec2d.zero()
    for constraint in joint.constraints:
        x, *y = NUMBERS[impulse_places(constraint)].tolist()
        if isinstance(constraint, pymunk.PivotJoint):
            total += Vec2d(x, *y)
        elif isinstance(constraint, _Axial):
            of_slider = joint.joint.kind is JointKind.SLIDER
            total += (_of_slider(joint, constraint) if of_slider else _between(constraint)) * x
    return total


def _between(constraint: _Axial) -> Vec2d:
    """Return the unit vector from the first anchor to the second."""
    start = constraint.a.local_to_world(constraint.anchor_a)
    return (constraint.b.local_to_world(constraint.anchor_b) - start).normalized()


def _of_slider(joint: EngineJoint, constraint: _Axial) -> Vec2d:
    """Return the unit vector along which a constraint of a slider acts on the second body."""
    ends, seat = joint.ends, joint.joint.seat
    u = Vec2d(seat.ux, seat.uy).rotated(ends.b.angle)
    # Both constraints have the bodies of the joint the other way round.
    if not isinstance(constraint, pymunk.SlideJoint):
        return -u.perpendicular()
    apart = ends.a.local_to_world(ends.at_a) - constraint.a.local_to_world(constraint.anchor_a)
    # Chipmunk turns its normal round at the lower limit.
    return u if 2.0 * apart.length < constraint.min + constraint.max else -u
