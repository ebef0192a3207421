# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The layout of Chipmunk's structs: what Pymunk tells is found where `chipmunk.h` looks for it.

No wheel of Pymunk has Chipmunk's headers, so that `engine/core/chipmunk.h` has the structs once
more. Some of these Pymunk declares itself. For the others this module builds a small scene, whose
properties all have different values, and steps it once; each value is then read through those
structs. Every other field lies before one of these, so that a field that is added or removed
anywhere is noticed.
Cost: 5 ms, when the engine is imported.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
from physsim_ros.engine.core import ffi
import pymunk
from pymunk._chipmunk_cffi import ffi as pymunk_ffi

# Fields of a struct by the attributes of Pymunk's object that have the same value.
_SPACE = {
    'iterations': 'iterations',
    'gravity': 'gravity',
    'damping': 'damping',
    'idleSpeedThreshold': 'idle_speed_threshold',
    'sleepTimeThreshold': 'sleep_time_threshold',
    'collisionSlop': 'collision_slop',
    'collisionBias': 'collision_bias',
    'collisionPersistence': 'collision_persistence',
    'curr_dt': 'current_time_step',
}
_BODY = {'m': 'mass', 'i': 'moment', 'p': 'position', 'v': 'velocity', 'a': 'angle'} | {
    'w': 'angular_velocity',
    'f': 'force',
    't': 'torque',
}
_SHAPE = {
    'shape.sensor': 'sensor',
    'shape.e': 'elasticity',
    'shape.u': 'friction',
    'shape.surface_velocity': 'surface_velocity',
    'shape.type': 'collision_type',
    'shape.body.m': 'body.mass',
    'shape.group': 'filter.group',
    'shape.categories': 'filter.categories',
    'shape.mask': 'filter.mask',
}
_CONSTRAINT = {
    'constraint.maxForce': 'max_force',
    'constraint.errorBias': 'error_bias',
    'constraint.maxBias': 'max_bias',
    'constraint.collideBodies': 'collide_bodies',
    'constraint.a.m': 'a.mass',
    'constraint.b.m': 'b.mass',
}
_ANCHORS = {'anchorA': 'anchor_a', 'anchorB': 'anchor_b'}
# Kinds that the core reads: their structs, and what they have beside the above.
KINDS: dict[type, tuple[str, dict[str, str]]] = {
    pymunk.Space: ('cpSpace', _SPACE),
    pymunk.Body: ('cpBody', _BODY),
    pymunk.Circle: ('cpCircleShape', _SHAPE | {'c': 'offset', 'r': 'radius'}),
    pymunk.Segment: ('cpSegmentShape', _SHAPE | {'a': 'a', 'b': 'b', 'r': 'radius'}),
    pymunk.Poly: ('cpPolyShape', _SHAPE | {'r': 'radius'}),
    pymunk.PivotJoint: ('cpPivotJoint', _CONSTRAINT | _ANCHORS),
    pymunk.PinJoint: ('cpPinJoint', _CONSTRAINT | _ANCHORS | {'dist': 'distance'}),
    pymunk.SlideJoint: ('cpSlideJoint', _CONSTRAINT | _ANCHORS | {'min': 'min', 'max': 'max'}),
    pymunk.GearJoint: ('cpGearJoint', _CONSTRAINT | {'phase': 'phase', 'ratio': 'ratio'}),
    pymunk.RotaryLimitJoint: ('cpRotaryLimitJoint', _CONSTRAINT | {'min': 'min', 'max': 'max'}),
    pymunk.SimpleMotor: ('cpSimpleMotor', _CONSTRAINT | {'rate': 'rate'}),
    pymunk.DampedSpring: (
        'cpDampedSpring',
        _CONSTRAINT
        | _ANCHORS
        | {'restLength': 'rest_length', 'stiffness': 'stiffness', 'damping': 'damping'},
    ),
}

# Structs that Pymunk declares itself, for its pickling.
_DECLARED = 'cpArray', 'cpArbiterThread', 'cpArbiter', 'cpContact'
# The step of the scene [s].
_DT = 1.0 / 64.0


def address_of(it: pymunk.Space | pymunk.Body | pymunk.Shape | pymunk.Constraint) -> int:
    """Return the address of Chipmunk's struct of an object of Pymunk."""
    match it:
        case pymunk.Body():
            struct = it._body  # noqa: SLF001 - Pymunk has no public way to its structs
        case pymunk.Constraint():
            struct = it._constraint  # noqa: SLF001
        case pymunk.Shape():
            struct = it._shape  # noqa: SLF001
        case _:
            struct = it._space  # noqa: SLF001
    return int(pymunk_ffi.cast('uintptr_t', struct))


def check_layout() -> None:
    """
    Compare the structs of the core with what Pymunk tells of its objects.

    :raises ImportError: they differ; the sentence names the field and the version of Pymunk
    """
    for struct in _DECLARED:
        _compare_declared(struct)
    space = _scene()
    objects: list[Any] = [space, *space.bodies, *space.shapes, *space.constraints]
    for it in objects:
        _compare(_struct_of(it), it, KINDS[type(it)][1])
    pm_space = _struct_of(space)
    known = SimpleNamespace(count=len(space._get_arbiters()))  # noqa: SLF001 - nothing public
    _compare(pm_space, known, {'arbiters.num': 'count', 'cachedArbiters.entries': 'count'})
    _compare_lists(space)
    for joint in space.constraints:
        struct = _struct_of(joint)
        _compare(struct, joint, {'jnAcc' if hasattr(struct, 'jnAcc') else 'jAcc': 'impulse'})
    _compare_sleep(space)


def _compare_declared(struct: str) -> None:
    """Compare the fields of a struct, but for padding, with those that Pymunk declares."""
    ours, theirs = ffi.typeof(struct), pymunk_ffi.typeof(f'struct {struct}')
    known = {name: field.offset for name, field in theirs.fields}
    for name, field in ours.fields:
        if not name.endswith('_'):
            _expect(struct, name, field.offset, known.get(name, math.nan))
    _expect(struct, 'size', ffi.sizeof(ours), pymunk_ffi.sizeof(theirs))


def _struct_of(it: Any) -> Any:
    """Return the core's view of the struct of an object of Pymunk."""
    return ffi.cast(f'{KINDS[type(it)][0]} *', address_of(it))


def _compare_lists(space: pymunk.Space) -> None:
    """Compare where bodies have their lists, whose newest member is the first, and corners."""
    for body in space.bodies:
        *_, shape = (each for each in space.shapes if each.body is body)
        known = SimpleNamespace(space=address_of(space), shape=address_of(shape))
        _compare(_struct_of(body), known, {'space': 'space', 'shapeList': 'shape'})
        if isinstance(shape, pymunk.Poly):
            corners = shape.get_vertices()
            struct = _struct_of(shape)
            # Few corners are in the struct itself.
            end = address_of(shape) + ffi.sizeof(struct[0])
            known = SimpleNamespace(count=len(corners), planes=end)
            _compare(struct, known, {'count': 'count', 'planes': 'planes'})
            for number, corner in enumerate(corners):
                known = SimpleNamespace(at=body.local_to_world(corner))
                _compare(struct.planes + number, known, {'v0': 'at'})
    (one, *_, disc, _), (*_, joint) = space.bodies, space.constraints
    known = SimpleNamespace(joint=address_of(joint))
    _compare(_struct_of(one), known, {'constraintList': 'joint'})
    (arbiter,) = space._get_arbiters()  # noqa: SLF001 - nothing public
    known = SimpleNamespace(arbiter=int(pymunk_ffi.cast('uintptr_t', arbiter)))
    _compare(_struct_of(disc), known, {'arbiterList': 'arbiter'})


def _compare_sleep(space: pymunk.Space) -> None:
    """Compare how long a body has been at rest; then have it sleep."""
    *_, body = space.bodies
    known = SimpleNamespace(rest=_DT, root=address_of(body))
    _compare(_struct_of(body), known, {'idle_time': 'rest'})
    body.sleep()
    _compare(_struct_of(body), known, {'sleeping_root': 'root'})


def _compare(struct: Any, it: object, fields: Mapping[str, str]) -> None:
    for field, attribute in fields.items():
        found, expected = _value(struct, field), _value(it, attribute)
        if isinstance(found, ffi.CData):
            is_vector = ffi.typeof(found).kind == 'struct'
            found = (found.x, found.y) if is_vector else int(ffi.cast('uintptr_t', found))
        if attribute == 'impulse':
            # Pymunk tells the size of that of a pivot, and turns that of a spring round.
            found, expected = math.hypot(*np.atleast_1d(found)), abs(expected)
        _expect(ffi.typeof(struct).item.cname, field, found, expected)


def _expect(struct: str, field: str, found: Any, expected: Any) -> None:
    is_whole = isinstance(found, int)
    if not (found == expected if is_whole else np.allclose(found, expected, rtol=1e-12, atol=0.0)):
        raise ImportError(
            f'Pymunk {pymunk.version} has other structs than the core of the engine expects: '
            f'{struct}.{field} is {found}, not {expected}'
        )


def _value(it: Any, names: str) -> Any:
    for name in names.split('.'):
        it = getattr(it, name)
    return it


def _scene() -> pymunk.Space:
    """Return a space with one of each kind, whose properties all have different values."""
    space = pymunk.Space()
    space.iterations, space.gravity, space.damping = 7, (0.125, -9.5), 0.75
    space.idle_speed_threshold, space.sleep_time_threshold = 0.375, 2.5
    space.collision_slop, space.collision_bias, space.collision_persistence = 0.25, 0.625, 5
    one, other = bodies = pymunk.Body(1.5, 4.5), pymunk.Body(2.5, 6.5)
    for number, body in enumerate(bodies, 1):
        body.position, body.velocity = (3.0 * number, 5.0), (0.5, -0.25 * number)
        body.angle, body.angular_velocity = 0.125 * number, 0.375 * number
    shapes = (
        pymunk.Circle(one, 0.5, (0.25, 0.125)),
        pymunk.Segment(other, (-0.5, 0.25), (0.75, 0.5), 0.0625),
        pymunk.Poly(other, [(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 1.0)], radius=0.03125),
    )
    for number, shape in enumerate(shapes, 2):
        shape.elasticity, shape.friction = number / 16.0, number / 8.0
        shape.surface_velocity, shape.sensor = (number, number / 2.0), number == 3
        shape.collision_type = 40 + number
        shape.filter = pymunk.ShapeFilter(10 + number, 20 + number, 30 + number)
    constraints = (
        pymunk.PivotJoint(one, other, (0.5, 0.25), (-0.5, 0.125)),
        pymunk.PinJoint(one, other, (0.5, 0.75), (-0.5, 0.25)),
        pymunk.SlideJoint(one, other, (0.25, 0.5), (-0.125, 0.5), 5.0, 9.0),
        pymunk.GearJoint(one, other, 0.25, 3.0),
        pymunk.RotaryLimitJoint(one, other, 0.5, 2.5),
        pymunk.SimpleMotor(one, other, 0.875),
        pymunk.DampedSpring(one, other, (0.25, 0.0), (0.0, 0.25), 1.5, 20.0, 0.75),
    )
    for number, constraint in enumerate(constraints, 1):
        constraint.max_force, constraint.error_bias = 1e3 * number, number / 32.0
        constraint.max_bias, constraint.collide_bodies = 2e3 * number, number % 2 == 0
    space.add(*bodies, *shapes, *constraints, *_discs_that_meet())
    # A step of gravity is slow enough for rest.
    sleeper = pymunk.Body(3.5, 7.5)
    sleeper.position = -100.0, 0.0
    space.add(sleeper, pymunk.Circle(sleeper, 0.5))
    space.step(_DT)
    one.force, one.torque = (11.0, 12.0), 13.0
    return space


def _discs_that_meet() -> Iterator[pymunk.Body | pymunk.Shape]:
    for number in (1, 2):
        body = pymunk.Body(float(number), 0.5 * number)
        body.position, body.velocity = (100.0 + 0.9 * number, 0.1 * number), (-2.0 * number, 0.5)
        shape = pymunk.Circle(body, 0.5)
        shape.elasticity, shape.friction = 0.25 * number, 0.4 * number
        yield from (body, shape)
