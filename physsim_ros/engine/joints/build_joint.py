# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The table of the kinds of joints, and a joint made of its kind."""

from __future__ import annotations

from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.joints import axle, gear, motor, rod, rope, slider, spring, weld
from physsim_ros.engine.joints.constraint_rows import Kind
from physsim_ros.engine.joints.engine_joint import Ends, EngineJoint
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Joint
import pymunk

KINDS: dict[JointKind, Kind] = {
    JointKind.PIN: weld.KIND,
    JointKind.AXLE: axle.KIND,
    JointKind.MOTOR: motor.KIND,
    JointKind.SPRING: spring.KIND,
    JointKind.ROD: rod.KIND,
    JointKind.ROPE: rope.KIND,
    JointKind.SLIDER: slider.KIND,
    JointKind.GEAR: gear.KIND,
}


def kind_of(joint: Joint) -> Kind:
    """Return the kind of a joint; a slider whose limits are one point is welded there."""
    if joint.kind is JointKind.SLIDER and slider.is_locked(joint):
        return weld.KIND
    return KINDS[joint.kind]


def build_joint(
    joint: Joint, a: RigidBody, b: RigidBody | None, background: pymunk.Body
) -> EngineJoint:
    """
    Make the constraints of a joint, outside any space.

    Pymunk divides by the sum of inverse masses, so that of two bodies neither of which is dynamic
    there are none; such a joint waits until one of them is.

    :param a: the first body
    :param b: the second one; None is the background
    :param background: the engine's own
    """
    seat = joint.seat
    at_b = (seat.bx, seat.by) if b is None else (seat.bx - b.offset[0], seat.by - b.offset[1])
    if joint.kind is JointKind.SLIDER and slider.is_locked(joint):
        at_b = slider.stop(joint, at_b)
    ends = Ends(
        a=a.pm_body,
        b=background if b is None else b.pm_body,
        at_a=(seat.ax - a.offset[0], seat.ay - a.offset[1]),
        at_b=at_b,
    )
    if not (a.body.dynamic or (b is not None and b.body.dynamic)):
        return EngineJoint(joint, ends, ())
    built = EngineJoint(joint, ends, tuple(kind_of(joint).constraints(joint, ends)))
    for constraint in built.constraints:
        # With the background, which is the walls of `bounds` too, a body always collides.
        constraint.collide_bodies = joint.collide or b is None
    if joint.properties.max_force is not None:
        for constraint in built.limited:
            constraint.max_force = joint.properties.max_force
    return built
