# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
Joints in the engine: one table from the kind of a joint to the Pymunk constraints that play it.

Laws: a joint between two bodies that forces do not move has no constraints, since the engine
divides by the sum of their inverse masses; it waits until one of them is free. A spring is never
stiffer than steps can follow.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.engine.body import RigidBody
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Joint
from physsim_ros.model.shapes import SMALLEST
from physsim_ros.model.snapshot import Springs
from physsim_ros.model.transform import Point
import pymunk

# How far a slider without limits goes to each side [m].
_ENDLESS = 1e4
# The share of an error in place that the engine takes out at each step, where `linkage` does not:
# more would make what the engine cannot solve in time explode.
_CORRECTION = 0.1
# The fastest that an error in place is taken out at [m/s, rad/s]: a body that is put elsewhere
# comes back like a thrown one, not like a shot.
FASTEST_CORRECTION = 20.0
# The same of a joint that gives way, which pulls with all its force meanwhile: it creeps back.
_CREEP = 1.0


@dataclass(frozen=True, slots=True)
class Ends:
    """
    The two sides of a joint in the engine.

    :param a: one body
    :param b: another one, or the background
    :param at_a: the joint's point in the frame of the first, its origin the centre of mass [m]
    :param at_b: the same in the frame of the second
    """

    a: pymunk.Body
    b: pymunk.Body
    at_a: Point
    at_b: Point


@dataclass(frozen=True, slots=True, eq=False)
class EngineJoint:
    """
    A joint and its engine objects; made by `build`.

    :param joint: what it is
    :param ends: its two sides
    :param constraints: the engine's, none where forces move neither body
    """

    joint: Joint
    ends: Ends
    constraints: tuple[pymunk.Constraint, ...]

    @property
    def exact(self) -> bool:
        """Whether it is held exactly: no spring, and nothing that gives way to too much force."""
        return bool(self.constraints) and is_exact(self.joint)

    @property
    def impulse(self) -> float:
        """Return what it gave in the last step [N s]; where it turns, at an arm of 1 m."""
        # A spring's is negative where it pulls.
        return max((abs(each.impulse) for each in self.constraints), default=0.0)


def build(
    joint: Joint, a: RigidBody, b: RigidBody | None, background: pymunk.Body, dt: float
) -> EngineJoint:
    """
    Make the engine objects of a joint, outside any space.

    :param a: the first body
    :param b: the second one; None is the background
    :param background: the engine's own
    :param dt: of a step [s]
    """
    seat = joint.seat
    ends = Ends(
        a=a.engine,
        b=background if b is None else b.engine,
        at_a=(seat.ax - a.offset[0], seat.ay - a.offset[1]),
        at_b=(seat.bx, seat.by) if b is None else (seat.bx - b.offset[0], seat.by - b.offset[1]),
    )
    if a.body.fixed and (b is None or b.body.fixed):
        return EngineJoint(joint, ends, ())
    constraints = tuple(_MAKE[joint.kind](joint, ends))
    most = joint.properties.max_force
    # The engine leaves this share of an error after a second.
    left = 0.5 ** (1.0 / dt) if is_exact(joint) else (1.0 - _CORRECTION) ** (1.0 / dt)
    for constraint in constraints:
        if most is not None and not isinstance(constraint, pymunk.SimpleMotor):
            constraint.max_force = most
        constraint.error_bias = left
        constraint.max_bias = FASTEST_CORRECTION if is_exact(joint) else _CREEP
        # With the background, which is the walls of `bounds` too, a body always collides.
        constraint.collide_bodies = joint.collide or b is None
    return EngineJoint(joint, ends, constraints)


def is_exact(joint: Joint) -> bool:
    """Tell whether a joint is no spring, and gives way to no force."""
    return joint.kind is not JointKind.SPRING and joint.properties.max_force is None


def _pin(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    turn = pymunk.GearJoint(ends.a, ends.b, joint.seat.phase, 1.0)
    return [_pivot(ends), turn]


def _axle(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    lower, upper = joint.properties.lower, joint.properties.upper
    if lower is None and upper is None:
        return [_pivot(ends)]
    # The engine measures the turn of the second against the first.
    phase = joint.seat.phase
    least = -math.inf if upper is None else phase - upper
    most = math.inf if lower is None else phase - lower
    return [_pivot(ends), pymunk.RotaryLimitJoint(ends.a, ends.b, least, most)]


def _motor(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    motor = pymunk.SimpleMotor(ends.a, ends.b, joint.number('rate'))
    motor.max_force = joint.number('max_torque')
    return [_pivot(ends), motor]


def _spring(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    spring = pymunk.DampedSpring(
        ends.a,
        ends.b,
        ends.at_a,
        ends.at_b,
        joint.rest_length,
        joint.stiffness,
        joint.number('damping'),
    )
    most = joint.properties.max_force
    if most is not None:
        # The engine limits a spring's damping, but not its pull.
        def pull(spring: pymunk.DampedSpring, distance: float) -> float:
            force = (spring.rest_length - distance) * spring.stiffness
            return max(-most, min(most, force))

        spring.force_func = pull
    return [spring]


def _rod(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    rod = pymunk.PinJoint(ends.a, ends.b, ends.at_a, ends.at_b)
    rod.distance = joint.seat.length
    return [rod]


def _rope(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    return [
        pymunk.SlideJoint(ends.a, ends.b, ends.at_a, ends.at_b, 0.0, joint.rest_length),
    ]


def _slider(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    (x, y), (ux, uy) = ends.at_b, (joint.seat.ux, joint.seat.uy)
    least, most = joint.properties.lower, joint.properties.upper
    if least is None:
        least = -_ENDLESS if most is None else min(-_ENDLESS, most - _ENDLESS)
    if most is None:
        most = max(_ENDLESS, least + _ENDLESS)
    if most - least < SMALLEST:
        # The engine divides by the length of a groove.
        middle = (least + most) / 2
        least, most = middle - SMALLEST / 2, middle + SMALLEST / 2
    groove = pymunk.GrooveJoint(
        ends.b,
        ends.a,
        (x + ux * least, y + uy * least),
        (x + ux * most, y + uy * most),
        ends.at_a,
    )
    return [groove, pymunk.GearJoint(ends.a, ends.b, joint.seat.phase, 1.0)]


def _gear(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    return [pymunk.GearJoint(ends.a, ends.b, joint.seat.phase, joint.number('ratio'))]


def _pivot(ends: Ends) -> pymunk.PivotJoint:
    return pymunk.PivotJoint(ends.a, ends.b, ends.at_a, ends.at_b)


_MAKE: dict[JointKind, Callable[[Joint, Ends], list[pymunk.Constraint]]] = {
    JointKind.PIN: _pin,
    JointKind.AXLE: _axle,
    JointKind.MOTOR: _motor,
    JointKind.SPRING: _spring,
    JointKind.ROD: _rod,
    JointKind.ROPE: _rope,
    JointKind.SLIDER: _slider,
    JointKind.GEAR: _gear,
}


def stiffest(ends: Ends, springs: dict[pymunk.Body, int], dt: float) -> float:
    """
    Return how stiff a spring may be for steps to follow it [N/m].

    The engine moves first and pulls then, which is stable while no body swings by more than two
    radians a step; all springs on a body together keep it below one.

    :param springs: how many there are on each body
    :param dt: of a step [s]
    """
    softness = 0.0
    for body, (x, y) in ((ends.a, ends.at_a), (ends.b, ends.at_b)):
        if body.body_type == pymunk.Body.DYNAMIC:
            softness += springs[body] * (1.0 / body.mass + (x * x + y * y) / body.moment)
    return 1.0 / (softness * dt * dt)


def springs_of(joints: Sequence[EngineJoint]) -> Springs:
    """Return the springs among joints, as the engine has them."""
    numbers = [
        number
        for number, each in enumerate(joints)
        if each.joint.kind is JointKind.SPRING and each.constraints
    ]
    springs = [joints[number].constraints[0] for number in numbers]
    stiffness = np.array([spring.stiffness for spring in springs], np.float64)
    limits = (joints[number].joint.properties.max_force for number in numbers)
    most = np.array([math.inf if limit is None else limit for limit in limits])
    with np.errstate(over='ignore'):
        # What is too far to be a number is as good as endless.
        reach = most / np.maximum(stiffness, 1e-300)
    rest = np.array([spring.rest_length for spring in springs], np.float64)
    return Springs(np.array(numbers, np.int64), stiffness, rest, reach)


def islands(joints: Sequence[EngineJoint], held: Sequence[int] | None = None) -> list[list[int]]:
    """
    Part joints into groups that have no body in common which forces move.

    :param held: numbers of the joints that count; None is all
    """
    # Of each body another one of its island, and in the end one that is its own.
    above: dict[pymunk.Body, pymunk.Body] = {}

    def top(body: pymunk.Body) -> pymunk.Body:
        while (over := above.setdefault(body, body)) is not body:
            above[body] = body = above[over]
        return body

    moving: dict[int, pymunk.Body] = {}
    for number in range(len(joints)) if held is None else held:
        ends = joints[number].ends
        for body in (ends.a, ends.b):
            if body.body_type == pymunk.Body.DYNAMIC:
                above[top(body)] = top(moving.setdefault(number, body))
    groups: dict[pymunk.Body, list[int]] = {}
    for number, body in moving.items():
        groups.setdefault(top(body), []).append(number)
    return list(groups.values())
