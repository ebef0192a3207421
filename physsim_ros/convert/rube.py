# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Scenes of R.U.B.E., the editor of Box2D worlds, as JSON.

Restitution of a pair is the greater one in Box2D and the geometric mean here.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from pathlib import Path

from physsim_ros.convert.content import BadContent, Content
from physsim_ros.convert.conversion import (
    area_of,
    clamped,
    Conversion,
    GAP,
    Line,
    Piece,
    shape_of,
)
from physsim_ros.model.checks import ELASTICITY, FRICTION
from physsim_ros.model.shapes import Circle, Convex
from physsim_ros.model.transform import composed, local_to_world, Point, Pose, rotated

_STATIC, _KINEMATIC = 0, 1
# Keys of the solver of Box2D, and of bodies at rest: here every body may sleep, and none tunnels.
_OF_THE_SOLVER = (
    *('allowSleep', 'autoClearForces', 'continuousPhysics', 'subStepping', 'warmStarting'),
    *('positionIterations', 'velocityIterations', 'stepsPerSecond', 'awake', 'bullet'),
)


def convert(content: Content, _folder: Path) -> Conversion:
    """Return the world of a scene of R.U.B.E."""
    conversion = Conversion(settings={'gravity': [*_vector(content, 'gravity')]})
    content.skip(*_OF_THE_SOLVER)
    bodies = [_add_body(conversion, body) for body in content.entries('body')]
    for joint in content.entries('joint'):
        _Joint(conversion, joint, bodies).add()
    return conversion


class _Placed:
    """A body: its name, its pose, and its mass [kg], infinite where forces do not move it."""

    def __init__(self, name: str, pose: Pose, mass: float) -> None:
        self.name, self.pose, self.mass = name, pose, mass


def _add_body(conversion: Conversion, body: Content) -> _Placed:
    body.skip(*_OF_THE_SOLVER)
    fixtures = body.entries('fixture')
    solid = conversion.solid_parts(fixtures, lambda each: each.is_set('sensor'))
    used = solid or fixtures
    pose = *_vector(body, 'position'), body.number('angle', 0.0)
    if not used:
        conversion.leave_out(body, 'a body without fixtures; its joints are to the background')
        return _Placed('world', pose, math.inf)
    pieces = [_piece_of(each) for each in used]
    shape, origin = shape_of(pieces, conversion)
    densities = [max(each.number('density', 0.0), 0.0) for each in used]
    weight = sum(a * area_of(piece) for a, piece in zip(densities, pieces, strict=True))
    # The mass that was set by hand counts, and Box2D gives a dynamic body without mass 1 kg.
    mass = max(body.number('massData-mass', 0.0), 0.0) or weight or 1.0
    properties: dict[str, object] = {
        'mass': mass,
        'friction': clamped(conversion.of_first(used, 'friction'), FRICTION),
        'elasticity': clamped(conversion.of_first(used, 'restitution'), ELASTICITY),
        'velocity': [*_vector(body, 'linearVelocity')],
        'spin': body.number('angularVelocity', 0.0),
    }
    if not solid:
        properties['sensor'] = True
    if (group := conversion.of_first(used, 'filter-groupIndex')) > 0.0:
        conversion.tell('left out: a group whose bodies always collide')
    elif group:
        properties['group'] = -round(group)
    kind = body.whole('type', _STATIC)
    if kind == _STATIC:
        properties['anchored'] = True
        del properties['mass'], properties['velocity'], properties['spin']
    elif kind == _KINEMATIC:
        properties['kinematic'] = True
    else:
        # Mass is spread evenly over a shape.
        conversion.of_first(used, 'density')
    at = composed(pose, (*origin, 0.0))
    name = conversion.add_body(body.text('name', 'body'), shape, at, **properties)
    return _Placed(name, pose, math.inf if kind in {_STATIC, _KINEMATIC} else mass)


def _piece_of(fixture: Content) -> Piece:
    fixture.skip('name')
    if 'circle' in fixture:
        circle = fixture.entry('circle')
        return Circle(_vector(circle, 'center'), circle.number('radius'))
    vertices = fixture.entry('polygon' if 'polygon' in fixture else 'chain').entry('vertices')
    # Of two lists of different lengths, the rest of the longer one means nothing.
    points = tuple(zip(vertices.numbers('x'), vertices.numbers('y'), strict=False))
    if 'polygon' not in fixture:
        return Line(points)
    if len(points) < 3:
        raise BadContent(f'{fixture.place("polygon")} has less than three corners')
    return Convex(points)


def _vector(content: Content, key: str) -> Point:
    """Return a vector, for which R.U.B.E. writes 0, or nothing, where both of its numbers are."""
    if not content.get(key):
        return 0.0, 0.0
    vector = content.entry(key)
    return vector.number('x'), vector.number('y')


class _Joint:
    """
    A joint.

    Angles and motors of Box2D turn the second body (`bodyB`), and those of a world file turn `a`:
    the second body becomes `a`, the first one `b`.

    :param bodies: of the scene, in their order
    """

    def __init__(self, conversion: Conversion, joint: Content, bodies: Sequence[_Placed]) -> None:
        self.conversion, self.joint = conversion, joint
        self.first, self.second = (self._body(key, bodies) for key in ('bodyA', 'bodyB'))
        self.at_first = local_to_world(_vector(joint, 'anchorA'), self.first.pose)
        self.at_second = local_to_world(_vector(joint, 'anchorB'), self.second.pose)

    def _body(self, key: str, bodies: Sequence[_Placed]) -> _Placed:
        number = self.joint.whole(key)
        if not 0 <= number < len(bodies):
            raise BadContent(f'{self.joint.place(key)} is {number}; there is no such body')
        return bodies[number]

    def add(self) -> None:
        """Add the joint, if it has a like here."""
        if math.isinf(self.first.mass + self.second.mass) and self.first.mass == self.second.mass:
            sentence = 'a joint of two bodies that forces do not move'
            self.conversion.leave_out(self.joint, sentence)
            return
        match self.joint.text('type'):
            case 'revolute':
                self._add_revolute()
            case 'weld':
                self._add('pin', [self.conversion.common_anchor(self.at_first, self.at_second)])
            case 'distance':
                self._add_distance()
            case 'rope':
                points = [self.at_second, self.at_first]
                self._add('rope', points, length=self.joint.number('maxLength'))
            case 'prismatic':
                self._add_prismatic()
            case other:
                self.conversion.leave_out(self.joint, f'a joint {other}')

    def _add(self, kind: str, points: Sequence[Point], **properties: object) -> None:
        name = self.joint.text('name', '')
        bodies = {'a': self.second.name, 'b': self.first.name}
        collide = self.joint.is_set('collideConnected')
        self.conversion.add_joint(name, kind, points, **bodies, collide=collide, **properties)

    def _limits(self, now: float, low: str, high: str) -> dict[str, object]:
        """Return the limits from where the joint is now."""
        # A limit that the joint is beyond is moved to where the joint is.
        lower, upper = (self.joint.number(key, 0.0) - now for key in (low, high))
        if not self.joint.is_set('enableLimit'):
            return {}
        return {'lower': min(lower, 0.0), 'upper': max(upper, 0.0)}

    def _add_revolute(self) -> None:
        joint = self.joint
        now = self.second.pose[2] - self.first.pose[2] - joint.number('refAngle', 0.0)
        limits = self._limits(now, 'lowerLimit', 'upperLimit')
        at = self.conversion.common_anchor(self.at_first, self.at_second)
        torque, rate = joint.number('maxMotorTorque', 0.0), joint.number('motorSpeed', 0.0)
        if limits or not joint.is_set('enableMotor'):
            self._add('axle', [at], **limits)
        if joint.is_set('enableMotor'):
            self._add('motor', [at], rate=rate, max_torque=torque)

    def _add_distance(self) -> None:
        joint, points = self.joint, [self.at_second, self.at_first]
        length, frequency = joint.number('length'), joint.number('frequency', 0.0)
        ratio = joint.number('dampingRatio', 0.0)
        if frequency == 0.0:
            if not math.isclose(length, math.dist(*points), abs_tol=GAP):
                self.conversion.tell('a rod has the length that is drawn')
            self._add('rod', points)
            return
        # Frequency and damping ratio are those of the reduced mass.
        inverse = 1.0 / self.first.mass + 1.0 / self.second.mass
        turning = math.tau * frequency
        damping = 2.0 * ratio * turning / inverse
        stiffness = turning**2 / inverse
        self._add('spring', points, rest_length=length, stiffness=stiffness, damping=damping)

    def _add_prismatic(self) -> None:
        x, y = _vector(self.joint, 'localAxisA')
        size = math.hypot(x, y)
        if size == 0.0:
            raise BadContent(f'{self.joint.place("localAxisA")} has no direction')
        axis = rotated((x / size, y / size), self.first.pose[2])
        (ax, ay), (bx, by) = self.at_first, self.at_second
        now = (bx - ax) * axis[0] + (by - ay) * axis[1]
        on_line = ax + now * axis[0], ay + now * axis[1]
        self.conversion.common_anchor(self.at_second, on_line)
        force, rate = self.joint.number('maxMotorForce', 0.0), self.joint.number('motorSpeed', 0.0)
        is_driven = self.joint.is_set('enableMotor')
        drive = {'rate': rate, 'max_force': force} if is_driven else {}
        limits = self._limits(now, 'lowerLimit', 'upperLimit')
        self._add('slider', [self.at_second, (bx + axis[0], by + axis[1])], **limits, **drive)
