# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The kinds of joints: the constraints of Chipmunk that each consists of, and their rows.

Chipmunk solves the constraints together with contacts, without their bias, a velocity that closes
gaps; the core then solves the rows (`core/joint_solver.c`). A constraint without rows is solved by
Chipmunk alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import chain, pairwise
import math
from typing import NamedTuple

from physsim_ros.engine.bodies import RigidBody
from physsim_ros.engine.core import lib
from physsim_ros.engine.pymunk_bodies import handles_of
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.rope_path import arc
from physsim_ros.model.scene import Guide, Joint
from physsim_ros.model.shapes import LARGEST, SMALLEST
from physsim_ros.model.transform import Point
import pymunk

# Share of the excess of an angle that Chipmunk leaves in a second: it closes 4e-7 in a step of
# 1/240 s. A limit of which it closes nothing counts for it as not reached.
_EXCESS_LEFT = 1.0 - 1e-4
# Greatest force of the drive of a slider [N], unless it is set: as the greatest torque of a motor.
_DRIVE = 1000.0


class EngineGuide(NamedTuple):
    """
    A guide of a joint, or an end, in the engine; fields as those of `Guide` in the scene.

    :ivar pm_body: Pymunk's
    :ivar anchor: in the frame of the body, its origin the centre of mass [m]
    """

    pm_body: pymunk.Body
    anchor: Point
    radius: float = 0.0
    yaw: float = 0.0
    heading_in: float = 0.0
    heading_out: float = 0.0
    span: float = 0.0


class Row(NamedTuple):
    """
    A constraint row: lower <= x <= upper, both the same for an equality.

    Fields but `guides` are those of `Row` of `engine/core/core.h`.

    :ivar kind: which number x is, one of `ROW_X` ...
    :ivar lower: least x [m, rad]
    :ivar upper: greatest x [m, rad]
    :ivar below: λ by the impulse that Chipmunk stores, where x is below its bounds
    :ivar above: the same where it is not
    :ivar law: one of `LAW_BOUNDS` ...
    :ivar rate: of x where it is driven, of the upper bound elsewhere [m/s, rad/s]
    :ivar most: its greatest force [N, N m]; None is that of the joint
    :ivar least: least upper bound that such a rate leads to [m]
    :ivar greatest: greatest one [m]
    :ivar offset: of a path, the length that is added to it [m]
    :ivar ratio: of an angle; of a rack, the radius of its pinion [m]
    :ivar stiffness: of a spring [N/m, N m/rad]
    :ivar guides: what it passes, its ends among them, or the carrier of a gear
    """

    kind: int
    lower: float = 0.0
    upper: float = 0.0
    below: float = 1.0
    above: float = 1.0
    law: int = lib.LAW_BOUNDS
    rate: float = 0.0
    most: float | None = None
    least: float = 0.0
    greatest: float = math.inf
    offset: float = 0.0
    ratio: float = 1.0
    stiffness: float = 0.0
    guides: tuple[EngineGuide, ...] = ()


class Part(NamedTuple):
    """
    A constraint of Chipmunk and its rows.

    :ivar kind: one of `PART_PIVOT` ... of `engine/core/core.h`
    :ivar constraint: Pymunk's
    :ivar rows: in the order of its impulses; none where Chipmunk alone solves it
    """

    kind: int
    constraint: pymunk.Constraint
    rows: tuple[Row, ...] = ()


@dataclass(frozen=True, slots=True)
class Ends:
    """
    The two bodies of a joint in the engine, and its anchors.

    :param a: one body
    :param b: another one, or the background
    :param at_a: anchor in the frame of the first, its origin the centre of mass [m]
    :param at_b: the same in the frame of the second
    :param guides: of the joint
    """

    a: pymunk.Body
    b: pymunk.Body
    at_a: Point
    at_b: Point
    guides: tuple[EngineGuide, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class EngineJoint:
    """
    A joint in the engine.

    :param joint: its description
    :param ends: its bodies and anchors
    :param parts: its constraints; none where neither body is dynamic
    """

    joint: Joint
    ends: Ends
    parts: tuple[Part, ...]

    @property
    def constraints(self) -> tuple[pymunk.Constraint, ...]:
        """Return its constraints."""
        return tuple(part.constraint for part in self.parts)


def _pivot(ends: Ends) -> Part:
    """Return two anchors that coincide; Chipmunk's impulse pushes the second body."""
    constraint = pymunk.PivotJoint(ends.a, ends.b, ends.at_a, ends.at_b)
    rows = (Row(lib.ROW_X, below=-1.0, above=-1.0), Row(lib.ROW_Y, below=-1.0, above=-1.0))
    return Part(lib.PART_PIVOT, constraint, rows)


def _turn(joint: Joint, ends: Ends) -> Part:
    """Return ratio yaw_b - yaw_a = phase; the first body gets a share of Chipmunk's impulse."""
    phase, ratio = joint.seat.phase, joint.number('ratio')
    constraint = pymunk.GearJoint(ends.a, ends.b, phase, ratio)
    return Part(lib.PART_GEAR, constraint, (_angle_row(joint),))


def _angle_row(joint: Joint) -> Row:
    """Return the row of ratio yaw_b - yaw_a = phase."""
    phase, ratio = joint.seat.phase, joint.number('ratio')
    return Row(lib.ROW_ANGLE, phase, phase, 1.0 / ratio, 1.0 / ratio, ratio=ratio)


def _weld(joint: Joint, ends: Ends) -> tuple[Part, ...]:
    """Return two anchors that coincide, and bodies that do not turn against each other."""
    return _pivot(ends), _turn(joint, ends)


def _axle(joint: Joint, ends: Ends) -> tuple[Part, ...]:
    """
    Return two anchors that coincide; the turn of one body against the other may have limits.

    A ratchet has teeth of any fineness: an angle that is reached is not given back.

    `lower` and `upper` are turns of a against b from where they were, rows have the turn of b
    against a, from zero.
    """
    lower, upper, phase = joint.properties.lower, joint.properties.upper, joint.seat.phase
    ratchet = joint.properties.ratchet
    parts: tuple[Part, ...] = (
        _pivot(ends),
        *_commanded(joint, ends, lib.PART_OWN, lib.ROW_ANGLE),
        *_friction(joint, ends, lib.PART_OWN, lib.ROW_ANGLE),
    )
    if joint.is_elastic:
        neutral = phase - joint.number('rest_angle')
        spring = Row(
            lib.ROW_ANGLE, neutral, neutral, law=lib.LAW_SPRING, stiffness=joint.stiffness
        )
        parts = (*parts, _own(lib.PART_OWN, ends, spring))
    if ratchet is not None:
        law = lib.LAW_FALLS if ratchet > 0.0 else lib.LAW_RISES
        parts = (*parts, _own(lib.PART_OWN, ends, Row(lib.ROW_ANGLE, law=law)))
    if lower is None and upper is None:
        return parts
    least = -math.inf if upper is None else phase - upper
    most = math.inf if lower is None else phase - lower
    limit = pymunk.RotaryLimitJoint(ends.a, ends.b, least, most)
    row = Row(lib.ROW_ANGLE, least, most)
    return *parts, Part(lib.PART_ROTARY_LIMIT, limit, (row,))


def _commanded(joint: Joint, ends: Ends, part: int, row: int) -> tuple[Part, ...]:
    """
    Return the motor of an axle or slider, if it has one, whose rate and force the core sets.

    :param part: kind of its part
    :param row: kind of its row
    """
    if not joint.properties.effort:
        return ()
    return (_own(part, ends, Row(row, law=lib.LAW_DRIVE, most=joint.properties.effort)),)


def _friction(joint: Joint, ends: Ends, part: int, row: int) -> tuple[Part, ...]:
    """
    Return the friction of a bearing or a slide, if it has any: dry, the same at every load.

    :param part: kind of its part
    :param row: kind of its row
    """
    most = joint.number('friction')
    return (_own(part, ends, Row(row, law=lib.LAW_FRICTION, most=most)),) if most else ()


def _motor(joint: Joint, ends: Ends) -> tuple[Part, ...]:
    """Return an axle that turns one body against the other at a rate, with a greatest torque."""
    rate, most = joint.number('rate'), joint.number('max_torque')
    motor = pymunk.SimpleMotor(ends.a, ends.b, rate)
    motor.max_force = most
    row = Row(lib.ROW_ANGLE, law=lib.LAW_DRIVE, rate=-rate, most=most)
    return _pivot(ends), Part(lib.PART_MOTOR, motor, (row,))


def _spring(joint: Joint, ends: Ends) -> tuple[Part, ...]:
    """Return a pull or push in proportion to its strain, which is damped."""
    rest, stiffness = joint.rest_length, joint.stiffness
    anchors = ends.at_a, ends.at_b
    spring = pymunk.DampedSpring(ends.a, ends.b, *anchors, rest, stiffness, damping=0.0)
    row = Row(lib.ROW_DISTANCE, rest, rest, law=lib.LAW_SPRING, stiffness=stiffness)
    return (Part(lib.PART_SPRING, spring, (row,)),)


def _rod(joint: Joint, ends: Ends) -> tuple[Part, ...]:
    """Return two anchors that keep their distance."""
    rod = pymunk.PinJoint(ends.a, ends.b, ends.at_a, ends.at_b)
    rod.distance = joint.seat.length
    return (Part(lib.PART_PIN, rod, (Row(lib.ROW_DISTANCE, rod.distance, rod.distance),)),)


def _own(kind: int, ends: Ends, row: Row) -> Part:
    """Return a row that no constraint of Chipmunk has: a motor without torque has its impulse."""
    bodies = chain((ends.a, ends.b), (guide.pm_body for guide in ends.guides))
    moved = next(body for body in bodies if body.body_type == pymunk.Body.DYNAMIC)
    other = ends.b if ends.b is not moved else ends.a
    motor = pymunk.SimpleMotor(moved, other, 0.0)
    motor.max_force = 0.0
    return Part(kind, motor, (row,))


def _path(joint: Joint, ends: Ends) -> tuple[Part, ...]:
    """
    Return a rope past its guides, from wheel to wheel: it does not slip on those that can turn.

    The row of its last piece has what a winch winds in, and what it is longer than drawn.
    """
    passed = sum(
        each.span + arc(each.radius, each.heading_in, each.heading_out) for each in ends.guides
    )
    end = EngineGuide(ends.b, ends.at_b, span=joint.seat.length - passed)
    stops = [EngineGuide(ends.a, ends.at_a), *ends.guides, end]
    wheels = [
        number
        for number, stop in enumerate(stops)
        if stop.radius and stop.pm_body.body_type == pymunk.Body.DYNAMIC
    ]
    spans = [
        (*stops[first:last], stops[last]) for first, last in pairwise((0, *wheels, len(stops) - 1))
    ]
    # A piece with both ends on one wheel lies on the rim, and neither moves nor stretches.
    pieces = [span for span in spans if len({stop.pm_body for stop in span}) > 1]
    rows = [
        Row(lib.ROW_PATH, 0.0, sum(stop.span for stop in piece[1:]), guides=piece)
        for piece in pieces
    ]
    last = rows[-1]._replace(upper=joint.rest_length, offset=joint.seat.length - rows[-1].upper)
    return (
        *(_own(lib.PART_OWN, ends, row) for row in rows[:-1]),
        _own(lib.PART_ROPE, ends, _winch(joint, last)),
    )


def _winch(joint: Joint, row: Row) -> Row:
    """Return the row of a rope whose upper bound has a rate."""
    lower, upper = joint.properties.lower, joint.properties.upper
    # A rope without a length has no direction in which it could pull.
    least, greatest = max(lower or 0.0, SMALLEST), LARGEST if upper is None else upper
    return row._replace(rate=joint.properties.rate or 0.0, least=least, greatest=greatest)


def _rope(joint: Joint, ends: Ends) -> tuple[Part, ...]:
    """Return two anchors that are no further from each other than its length."""
    if ends.guides:
        return _path(joint, ends)
    longest = joint.rest_length
    rope = pymunk.SlideJoint(ends.a, ends.b, ends.at_a, ends.at_b, 0.0, longest)
    # It only holds back, from its least length on too.
    row = Row(lib.ROW_DISTANCE, 0.0, longest, below=-1.0)
    return (Part(lib.PART_SLIDE, rope, (_winch(joint, row),)),)


def _drives(joint: Joint, ends: Ends) -> tuple[Part, ...]:
    """Return the drive of a slider, if it has one."""
    if not joint.is_driven:
        return ()
    force, rate = joint.properties.max_force, joint.number('rate')
    most = _DRIVE if force is None else force
    row = Row(lib.ROW_ALONG, law=lib.LAW_DRIVE, rate=rate, most=most)
    return (_own(lib.PART_DRIVE, ends, row),)


def _slider(joint: Joint, ends: Ends) -> tuple[Part, ...]:
    """
    Return an anchor on a line of another body, and bodies that do not turn against each other.

    The travel along the line may have limits. Chipmunk's `GrooveJoint` solves both directions and
    then drops what is along the line, which is not the velocity constraint of a line where masses
    and arms make the two directions unequal (7.0.3, as in Pymunk 7.3.1): sliders that are loaded
    off centre would gain energy. In its place a `PinJoint` pulls across the line, from a point of
    the second body that the core puts beside the anchor in each step.
    """
    pin = pymunk.PinJoint(ends.b, ends.a, ends.at_b, ends.at_a)
    parts = (Part(lib.PART_PIN, pin, (Row(lib.ROW_ACROSS),)), _turn(joint, ends))
    drive = _drives(joint, ends)
    lower, upper = joint.properties.lower, joint.properties.upper
    motor = _commanded(joint, ends, lib.PART_DRIVE, lib.ROW_ALONG)
    along = (*(motor or drive), *_friction(joint, ends, lib.PART_DRIVE, lib.ROW_ALONG))
    if lower is None and upper is None:
        return *parts, *along
    least, most = -math.inf if lower is None else lower, math.inf if upper is None else upper
    return *parts, _travel(joint, ends, least, most), *along


def _travel(joint: Joint, ends: Ends, least: float, most: float) -> Part:
    """
    Return the limits of a slider, of which one may be infinite.

    Chipmunk measures a distance, which has no sign: that from a point of the line 1 m beyond a
    limit, to which the slider never comes.
    """
    stop, back = (most, -1.0 - most) if least == -math.inf else (least, 1.0 - least)
    farthest = math.inf if least == -math.inf else back + most
    (x, y), (ux, uy) = ends.at_b, (joint.seat.ux, joint.seat.uy)
    origin = (x - ux * back, y - uy * back)
    limit = pymunk.SlideJoint(ends.b, ends.a, origin, ends.at_a, abs(back + stop), farthest)
    return Part(lib.PART_SLIDE, limit, (Row(lib.ROW_ALONG, least, most, below=-1.0),))


def _gear(joint: Joint, ends: Ends) -> tuple[Part, ...]:
    """Return a body whose turn about a carrier is that of the other times a ratio, and a phase."""
    if not ends.guides:
        return (_turn(joint, ends),)
    # Chipmunk's gear would not load the carrier, which may be the only dynamic body.
    return (_own(lib.PART_OWN, ends, _angle_row(joint)._replace(guides=ends.guides)),)


def _rack(joint: Joint, ends: Ends) -> tuple[Part, ...]:
    """Return a displacement along a rack, and the same along the rim of its pinion."""
    met = -joint.seat.length * joint.seat.phase
    return (_own(lib.PART_DRIVE, ends, Row(lib.ROW_ROLL, met, met, ratio=joint.seat.length)),)


KINDS: Mapping[JointKind, Callable[[Joint, Ends], tuple[Part, ...]]] = {
    JointKind.PIN: _weld,
    JointKind.AXLE: _axle,
    JointKind.MOTOR: _motor,
    JointKind.SPRING: _spring,
    JointKind.ROD: _rod,
    JointKind.ROPE: _rope,
    JointKind.SLIDER: _slider,
    JointKind.GEAR: _gear,
    JointKind.RACK: _rack,
}


def build_joint(
    joint: Joint, bodies: Mapping[str, RigidBody], background: pymunk.Body
) -> EngineJoint:
    """
    Make the constraints of a joint, outside any space.

    Pymunk divides by the sum of inverse masses, so that of two bodies neither of which is dynamic
    there are none; such a joint waits until one of them is. A slider whose limits are one point is
    welded there.

    :param bodies: of the space by name
    :param background: the engine's own
    """
    a, b = bodies[joint.a], bodies.get(joint.b)
    seat, make = joint.seat, KINDS[joint.kind]
    at_b = (seat.bx, seat.by) if b is None else (seat.bx - b.offset[0], seat.by - b.offset[1])
    stop = _stop_of(joint)
    if stop is not None:
        at_b, make = (at_b[0] + seat.ux * stop, at_b[1] + seat.uy * stop), _weld
    ends = Ends(
        a=a.pm_body,
        b=background if b is None else b.pm_body,
        at_a=(seat.ax - a.offset[0], seat.ay - a.offset[1]),
        at_b=at_b,
        guides=tuple(_engine_guide(guide, bodies, background) for guide in joint.guides),
    )
    if not any(name != WORLD and bodies[name].body.dynamic for name in joint.bodies):
        return EngineJoint(joint, ends, ())
    built = EngineJoint(joint, ends, make(joint, ends))
    for part in built.parts:
        # No callback of the engine asks for a constraint.
        handles_of(part.constraint)
        # The core closes gaps.
        is_turn_limit = isinstance(part.constraint, pymunk.RotaryLimitJoint)
        part.constraint.error_bias = _EXCESS_LEFT if is_turn_limit else 1.0
        # With the background, which is the walls of `bounds` too, a body always collides.
        part.constraint.collide_bodies = joint.collide or b is None
        # Motors have their own.
        is_motor = isinstance(part.constraint, pymunk.SimpleMotor)
        if joint.holding_force is not None and not is_motor:
            part.constraint.max_force = joint.holding_force
    return built


def _engine_guide(
    guide: Guide, bodies: Mapping[str, RigidBody], background: pymunk.Body
) -> EngineGuide:
    body, anchor = background, (guide.x, guide.y)
    if guide.body != WORLD:
        rigid = bodies[guide.body]
        body, anchor = rigid.pm_body, (guide.x - rigid.offset[0], guide.y - rigid.offset[1])
    return EngineGuide(body, anchor, *guide[3:])


def _stop_of(joint: Joint) -> float | None:
    """Return where on its line a slider without any travel stays [m]; None if it has travel."""
    lower, upper = joint.properties.lower, joint.properties.upper
    if joint.kind is not JointKind.SLIDER or lower is None or upper is None:
        return None
    return (lower + upper) / 2.0 if upper - lower < SMALLEST else None
