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
from typing import Any

from physsim_ros.convert.conversion import (
    area_of,
    Circle,
    composed,
    Conversion,
    Line,
    moved,
    Outline,
    Piece,
    shape_of,
)
from physsim_ros.model.transform import Point, Pose

Content = Mapping[str, Any]

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
    conversion = Conversion(settings={'gravity': [*_vector(content['gravity'])]})
    conversion.leave_out_keys(content, _WORLD_KEYS, 'the scene')
    bodies = [_add_body(conversion, body) for body in content['body'] or ()]
    for joint in content.get('joint') or ():
        _Joint(conversion, joint, bodies).add()
    return conversion


class _Placed:
    """A body: its name, its pose, and its mass [kg], infinite where forces do not move it."""

    def __init__(self, name: str, pose: Pose, mass: float) -> None:
        self.name, self.pose, self.mass = name, pose, mass


def _add_body(conversion: Conversion, body: Content) -> _Placed:
    conversion.leave_out_keys(body, _BODY_KEYS, 'a body')
    fixtures: Sequence[Content] = body.get('fixture') or ()
    solid = [each for each in fixtures if not each.get('sensor')]
    if solid and len(solid) < len(fixtures):
        conversion.leave_out('left out: a fixture that is a sensor of a solid body')
    used = solid or fixtures
    pose = *_vector(body.get('position', 0)), float(body.get('angle', 0.0))
    if not used:
        conversion.leave_out('left out: a body without fixtures; its joints are to the background')
        return _Placed('world', pose, math.inf)
    pieces = [_piece_of(each) for each in used]
    shape, origin = shape_of(pieces, conversion)
    properties: dict[str, object] = {
        'friction': min(float(used[0].get('friction', 0.0)), 10.0),
        'elasticity': min(max(float(used[0].get('restitution', 0.0)), 0.0), 1.0),
    }
    if not solid:
        properties['sensor'] = True
    if (group := int(used[0].get('filter-groupIndex', 0))) < 0:
        properties['group'] = -group
    kind, mass = int(body.get('type', _STATIC)), math.inf
    if kind == _STATIC:
        properties['anchored'] = True
    else:
        densities = [float(each.get('density', 0.0)) for each in used]
        pairs = zip(densities, pieces, strict=True)
        weight = sum(density * area_of(piece) for density, piece in pairs)
        # Box2D gives a dynamic body without mass 1 kg.
        properties['mass'] = weight or 1.0
        properties['velocity'] = [*_vector(body.get('linearVelocity', 0))]
        properties['spin'] = float(body.get('angularVelocity', 0.0))
        if kind == _KINEMATIC:
            properties['kinematic'] = True
        else:
            mass = weight or 1.0
    at = composed(pose, origin)
    name = conversion.add_body(str(body.get('name', 'body')), shape, at, **properties)
    return _Placed(name, pose, mass)


def _piece_of(fixture: Content) -> Piece:
    if 'circle' in fixture:
        circle = fixture['circle']
        return Circle(float(circle['radius']), _vector(circle.get('center', 0)))
    vertices = fixture['polygon' if 'polygon' in fixture else 'chain']['vertices']
    points = tuple(zip(map(float, vertices['x']), map(float, vertices['y']), strict=True))
    return Outline(points) if 'polygon' in fixture else Line(points)


def _vector(value: Any) -> Point:
    """Return a vector, for which R.U.B.E. writes 0 where both of its numbers are."""
    return (float(value['x']), float(value['y'])) if isinstance(value, Mapping) else (0.0, 0.0)


class _Joint:
    """
    A joint: its second body is `a` here, since angles and motors of Box2D are those of it.

    :param bodies: of the scene, in their order
    """

    def __init__(self, conversion: Conversion, joint: Content, bodies: Sequence[_Placed]) -> None:
        self.conversion, self.joint = conversion, joint
        self.first, self.second = bodies[joint['bodyA']], bodies[joint['bodyB']]
        self.at_first = moved(self.first.pose, _vector(joint.get('anchorA', 0)))
        self.at_second = moved(self.second.pose, _vector(joint.get('anchorB', 0)))

    def add(self) -> None:
        """Add the joint, if it has a like here."""
        if math.isinf(self.first.mass + self.second.mass) and self.first.mass == self.second.mass:
            self.conversion.leave_out('left out: a joint of two bodies that forces do not move')
            return
        match self.joint['type']:
            case 'revolute':
                self._add_revolute()
            case 'weld':
                self._add('pin', [self.at_first])
            case 'distance':
                self._add_distance()
            case 'rope':
                points = [self.at_second, self.at_first]
                self._add('rope', points, length=float(self.joint['maxLength']))
            case 'prismatic':
                self._add_prismatic()
            case other:
                self.conversion.leave_out(f'left out: a joint {other}')

    def _add(self, kind: str, points: Sequence[Point], **properties: object) -> None:
        name = str(self.joint.get('name', ''))
        bodies = {'a': self.second.name, 'b': self.first.name}
        collide = bool(self.joint.get('collideConnected', False))
        self.conversion.add_joint(name, kind, points, **bodies, collide=collide, **properties)

    def _limits(self, now: float, low: str, high: str) -> dict[str, object]:
        """Return the limits from where the joint is now."""
        if not self.joint.get('enableLimit'):
            return {}
        # A limit that the joint is beyond is moved to where the joint is.
        lower, upper = (float(self.joint.get(key, 0.0)) - now for key in (low, high))
        return {'lower': min(lower, 0.0), 'upper': max(upper, 0.0)}

    def _add_revolute(self) -> None:
        joint = self.joint
        now = self.second.pose[2] - self.first.pose[2] - float(joint.get('refAngle', 0.0))
        limits = self._limits(now, 'lowerLimit', 'upperLimit')
        if limits or not joint.get('enableMotor'):
            self._add('axle', [self.at_first], **limits)
        if joint.get('enableMotor'):
            torque = float(joint.get('maxMotorTorque', 0.0))
            rate = float(joint.get('motorSpeed', 0.0))
            self._add('motor', [self.at_first], rate=rate, max_torque=torque)

    def _add_distance(self) -> None:
        joint, points = self.joint, [self.at_second, self.at_first]
        length, frequency = float(joint['length']), float(joint.get('frequency', 0.0))
        if frequency == 0.0:
            if not math.isclose(length, math.dist(*points), abs_tol=0.01):
                self.conversion.leave_out('a rod has the length that is drawn')
            self._add('rod', points)
            return
        # Frequency and damping ratio are those of the reduced mass.
        inverse = 1.0 / self.first.mass + 1.0 / self.second.mass
        turning = math.tau * frequency
        damping = 2.0 * float(joint.get('dampingRatio', 0.0)) * turning / inverse
        stiffness = turning**2 / inverse
        self._add('spring', points, rest_length=length, stiffness=stiffness, damping=damping)

    def _add_prismatic(self) -> None:
        x, y = _vector(self.joint['localAxisA'])
        size, yaw = math.hypot(x, y), self.first.pose[2]
        axis = moved((0.0, 0.0, yaw), (x / size, y / size))
        (ax, ay), (bx, by) = self.at_first, self.at_second
        now = (bx - ax) * axis[0] + (by - ay) * axis[1]
        if self.joint.get('enableMotor'):
            self.conversion.leave_out('left out: the motor of a slider')
        limits = self._limits(now, 'lowerLimit', 'upperLimit')
        self._add('slider', [self.at_second, (bx + axis[0], by + axis[1])], **limits)
