# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Scenes of R.U.B.E., the editor of Box2D worlds, as JSON.

Restitution of a pair is the greater one in Box2D and the geometric mean here.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import math
from pathlib import Path

from physsim_ros.convert.content import BadContent, Content
from physsim_ros.convert.conversion import (
    area_of,
    clamped,
    Conversion,
    Line,
    Piece,
    shape_of,
)
from physsim_ros.model.checks import ELASTICITY, FRICTION
from physsim_ros.model.shapes import Circle, Convex
from physsim_ros.model.transform import composed, local_to_world, Point, Pose, rotated

_STATIC, _KINEMATIC = 0, 1
_BODY_KEYS = (
    *('name', 'type', 'position', 'angle', 'linearVelocity', 'angularVelocity', 'fixture'),
    *('awake', 'bullet', 'allowSleep', 'massData-mass', 'massData-I', 'massData-center'),
)
_WORLD_KEYS = (
    *('gravity', 'body', 'joint', 'allowSleep', 'autoClearForces', 'continuousPhysics'),
    *('positionIterations', 'velocityIterations', 'stepsPerSecond', 'subStepping', 'warmStarting'),
)


def convert(content: Content, _folder: Path) -> Conversion:
    """Return the world of a scene of R.U.B.E."""
    conversion = Conversion(settings={'gravity': [*_vector(content, 'gravity')]})
    conversion.leave_out_keys(content, _WORLD_KEYS, 'the scene')
    bodies = [_add_body(conversion, body) for body in content.entries('body')]
    for joint in content.entries('joint'):
        _Joint(conversion, joint, bodies).add()
    return conversion


class _Placed:
    """A body: its name, its pose, and its mass [kg], infinite where forces do not move it."""

    def __init__(self, name: str, pose: Pose, mass: float) -> None:
        self.name, self.pose, self.mass = name, pose, mass


def _add_body(conversion: Conversion, body: Content) -> _Placed:
    conversion.leave_out_keys(body, _BODY_KEYS, 'a body')
    fixtures = body.entries('fixture')
    solid = [each for each in fixtures if not each.is_set('sensor')]
    if solid and len(solid) < len(fixtures):
        conversion.leave_out('left out: a fixture that is a sensor of a solid body')
    used = solid or fixtures
    pose = *_vector(body, 'position'), body.number('angle', 0.0)
    if not used:
        conversion.leave_out('left out: a body without fixtures; its joints are to the background')
        return _Placed('world', pose, math.inf)
    pieces = [_piece_of(each) for each in used]
    shape, origin = shape_of(pieces, conversion)
    properties: dict[str, object] = {
        'friction': clamped(used[0].number('friction', 0.0), FRICTION),
        'elasticity': clamped(used[0].number('restitution', 0.0), ELASTICITY),
    }
    if not solid:
        properties['sensor'] = True
    if (group := used[0].whole('filter-groupIndex', 0)) < 0:
        properties['group'] = -group
    kind, mass = body.whole('type', _STATIC), math.inf
    if kind == _STATIC:
        properties['anchored'] = True
    else:
        densities = [max(each.number('density', 0.0), 0.0) for each in used]
        pairs = zip(densities, pieces, strict=True)
        weight = sum(density * area_of(piece) for density, piece in pairs)
        # Box2D gives a dynamic body without mass 1 kg.
        properties['mass'] = weight or 1.0
        properties['velocity'] = [*_vector(body, 'linearVelocity')]
        properties['spin'] = body.number('angularVelocity', 0.0)
        if kind == _KINEMATIC:
            properties['kinematic'] = True
        else:
            mass = weight or 1.0
    at = composed(pose, (*origin, 0.0))
    name = conversion.add_body(body.text('name', 'body'), shape, at, **properties)
    return _Placed(name, pose, mass)


def _piece_of(fixture: Content) -> Piece:
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
    if not isinstance(content.get(key), Mapping):
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
            self.conversion.leave_out('left out: a joint of two bodies that forces do not move')
            return
        match self.joint.text('type'):
            case 'revolute':
                self._add_revolute()
            case 'weld':
                self._add('pin', [self.at_first])
            case 'distance':
                self._add_distance()
            case 'rope':
                points = [self.at_second, self.at_first]
                self._add('rope', points, length=self.joint.number('maxLength'))
            case 'prismatic':
                self._add_prismatic()
            case other:
                self.conversion.leave_out(f'left out: a joint {other}')

    def _add(self, kind: str, points: Sequence[Point], **properties: object) -> None:
        name = self.joint.text('name', '')
        bodies = {'a': self.second.name, 'b': self.first.name}
        collide = self.joint.is_set('collideConnected')
        self.conversion.add_joint(name, kind, points, **bodies, collide=collide, **properties)

    def _limits(self, now: float, low: str, high: str) -> dict[str, object]:
        """Return the limits from where the joint is now."""
        if not self.joint.is_set('enableLimit'):
            return {}
        # A limit that the joint is beyond is moved to where the joint is.
        lower, upper = (self.joint.number(key, 0.0) - now for key in (low, high))
        return {'lower': min(lower, 0.0), 'upper': max(upper, 0.0)}

    def _add_revolute(self) -> None:
        joint = self.joint
        now = self.second.pose[2] - self.first.pose[2] - joint.number('refAngle', 0.0)
        limits = self._limits(now, 'lowerLimit', 'upperLimit')
        if limits or not joint.is_set('enableMotor'):
            self._add('axle', [self.at_first], **limits)
        if joint.is_set('enableMotor'):
            torque = joint.number('maxMotorTorque', 0.0)
            rate = joint.number('motorSpeed', 0.0)
            self._add('motor', [self.at_first], rate=rate, max_torque=torque)

    def _add_distance(self) -> None:
        joint, points = self.joint, [self.at_second, self.at_first]
        length, frequency = joint.number('length'), joint.number('frequency', 0.0)
        if frequency == 0.0:
            if not math.isclose(length, math.dist(*points), abs_tol=0.01):
                self.conversion.leave_out('a rod has the length that is drawn')
            self._add('rod', points)
            return
        # Frequency and damping ratio are those of the reduced mass.
        inverse = 1.0 / self.first.mass + 1.0 / self.second.mass
        turning = math.tau * frequency
        damping = 2.0 * joint.number('dampingRatio', 0.0) * turning / inverse
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
        if self.joint.is_set('enableMotor'):
            self.conversion.leave_out('left out: the motor of a slider')
        limits = self._limits(now, 'lowerLimit', 'upperLimit')
        self._add('slider', [self.at_second, (bx + axis[0], by + axis[1])], **limits)
