# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Memory of Chipmunk: numbers of many of its structs at once, as arrays.

Problem: Pymunk 7.3.1 reads and writes a contact, a shape or an impulse by a Python call each, and
has no functions for some of their numbers at all. One array of NumPy spans the address space,
without memory of its own. A struct is a *place* in it, the index of its first word of 8 bytes; an
offset within a struct is counted in words too. A place holds for as long as the engine keeps the
struct: those of contacts, until the step ends.

The structs are those of `include/chipmunk/chipmunk_structs.h` of Munk2D as in Pymunk 7.3.1.
`_check_layout` compares them with what Pymunk itself returns, once as this is imported;
`test_memory` does so for the rest. It can go when `pymunk.batch` reads and writes contacts, shapes
and impulses.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from physsim_ros.model.arrays import Flags, Floats, Ints
import pymunk
from pymunk._chipmunk_cffi import ffi, lib

# ruff: noqa: SLF001

_WORD = 8
# The first word is the null pointer, which no buffer may begin with.
NUMBERS: Floats = np.frombuffer(ffi.buffer(ffi.cast('char *', _WORD), 2**47 - _WORD), np.float64)
_WORDS: Ints = NUMBERS.view(np.int64)
_HALVES = _WORDS.view(np.int32)

# Words of a `cpVect`.
VECTOR = np.arange(2)
# `cpSpace.arbiters`, a `cpArray` of `cpArbiter *`; words of its `arr`, behind `num` and `max`.
_SPACE_ARBITERS, _ARRAY = 20, 1
# `cpArbiter`; the engine and Pymunk leave its user data alone.
ARBITER_WORDS = np.arange(17)
ARBITER_ELASTICITY, ARBITER_FRICTION, ARBITER_SURFACE = 0, 1, slice(2, 4)
ARBITER_SHAPES, ARBITER_BODIES, ARBITER_NEXT = slice(5, 7), slice(7, 9), np.array((9, 11))
ARBITER_CONTACTS, ARBITER_NORMAL = 14, slice(15, 17)
_ARBITER_DATA, _ARBITER_COUNT, _ARBITER_STATE = 4, 13, 22
# `cpContact`: arms; `nMass`, `tMass`, `bounce`, `jBias` and `bias`; `jnAcc` and `jtAcc`.
CONTACT_SIZE = 12
CONTACT_ARMS = np.arange(4)
CONTACT_PREPARED = np.array((4, 5, 6, 9, 10))
CONTACT_BOUNCE, CONTACT_IMPULSES, CONTACT_BIAS = 6, np.array((7, 8)), 9
# `cpBody`: `m_inv`, `i_inv`, `p`, `v`, `f`, `a`, `w`, `t`, its user data, `v_bias` and `w_bias`,
# `arbiterList`, `sleeping.idleTime`.
BODY_WORDS = np.arange(24)
BODY_INVERSE_MASS, BODY_INVERSE_MOMENT = 3, 5
BODY_POSITION, BODY_VELOCITY, BODY_FORCE = slice(8, 10), slice(10, 12), slice(12, 14)
BODY_YAW, BODY_SPIN, BODY_TORQUE, BODY_ID = 14, 15, 16, 23
BODY_POSE, BODY_TWIST, BODY_BIAS = (
    np.array(each) for each in ((8, 9, 14), (10, 11, 15), (24, 25, 26))
)
BODY_ARBITERS, BODY_IDLE_TIME = 29, 33
# Force and torque; inverse mass, twice, and inverse moment of inertia.
BODY_FORCES, BODY_INVERSES = np.array((12, 13, 16)), np.array((3, 3, 5))
# Position, velocity, spin, and the translation of its transform.
BODY_MOTION = np.array((8, 9, 10, 11, 15, 21, 22))
# `cpShape`, and what those of `cpCircleShape`, `cpSegmentShape` and `cpPolyShape` have behind it;
# by `hashid` the engine numbers the shapes of a space.
CIRCLE, SEGMENT, POLYGON = 0, 1, 2
SHAPE_WORDS = np.arange(26)
SHAPE_BOX, SHAPE_NUMBER, CIRCLE_OFFSET, SEGMENT_NORMAL = slice(8, 12), 23, slice(24, 26), 34
_RADIUS = np.array((28, 36, 24))
_POLYGON_COUNT, _POLYGON_PLANES, _CIRCLE_CENTER, _SEGMENT_ENDS = 25, 26, 26, 30
# Words from a corner to the next one: of a segment, and of a polygon, whose corner is followed by
# the normal of the edge that ends there.
_CORNER_SIZE = np.array((0, 2, 4))
# Offsets of the accumulated impulses in constraints, and their count.
_ACCUMULATED: dict[type[pymunk.Constraint], tuple[int, int]] = {
    pymunk.PivotJoint: (25, 2),
    pymunk.PinJoint: (25, 1),
    pymunk.SlideJoint: (26, 1),
    pymunk.GearJoint: (18, 1),
    pymunk.RotaryLimitJoint: (17, 1),
    pymunk.SimpleMotor: (15, 1),
    pymunk.DampedSpring: (30, 1),
}


def place_of(struct: Any) -> int:
    """Return the place of a struct, by its pointer."""
    return int(ffi.cast('uintptr_t', struct)) // _WORD - 1


def places_of(bodies: Iterable[pymunk.Body]) -> Ints:
    """Return (k,) the places of bodies."""
    return np.array([place_of(body._body) for body in bodies], np.int64)


def impulse_places(constraint: pymunk.Constraint) -> range:
    """Return the places of the accumulated impulses of a constraint [N s, N m s]."""
    offset, count = _ACCUMULATED[type(constraint)]
    first = place_of(constraint._constraint) + offset
    return range(first, first + count)


def pointer_to(kind: str, place: int) -> Any:
    """Return the pointer to a struct, of a kind as `cpArbiter *`."""
    return ffi.cast(kind, (place + 1) * _WORD)


def places_in(words: Ints) -> Ints:
    """Return the places that pointers in words lead to; -1 is the null pointer."""
    return words // _WORD - 1


def read_words(places: Ints, offsets: Ints | int) -> Ints:
    """Return a word of each struct, or (..., w) words at w offsets."""
    words: Ints = _WORDS[words_at(places, offsets)]
    return words


def read_numbers(places: Ints, offsets: Ints | int) -> Floats:
    """Return a number of each struct, or (..., w) numbers at w offsets."""
    numbers: Floats = NUMBERS[words_at(places, offsets)]
    return numbers


def words_at(places: Ints, offsets: Ints | int) -> Ints:
    """Return the word at an offset in each struct, or (..., w) words at w offsets."""
    return places + offsets if isinstance(offsets, int) else places[..., None] + offsets


def write_numbers(places: Ints, offsets: Ints | int, numbers: Floats | float) -> None:
    """Set a number of each struct, or (k, w) numbers at w offsets."""
    NUMBERS[words_at(places, offsets)] = numbers


def contacts_of_step(pm_space: pymunk.Space) -> Ints:
    """Return (n,) places of the `cpArbiter` that this step solves, in the engine's order."""
    listed = ffi.cast('intptr_t *', pm_space._space)[_SPACE_ARBITERS]
    first = ffi.cast('intptr_t *', listed)[_ARRAY] // _WORD - 1
    last = first + ffi.cast('int *', listed)[0]
    return places_in(_WORDS[first:last])


def bodies_of(arbiters: Ints) -> Ints:
    """Return (n, 2) places of the bodies of contacts."""
    return places_in(_WORDS[arbiters[:, None] + ARBITER_WORDS[ARBITER_BODIES]])


def begins(arbiters: Ints) -> Flags:
    """Return which contacts begin in this step, or were ignored in the step before."""
    states = _HALVES[2 * (arbiters + _ARBITER_STATE)]
    first: Flags = states == lib.CP_ARBITER_STATE_FIRST_COLLISION
    first |= _WORDS[arbiters + _ARBITER_DATA] != 0
    return first


def begin(arbiters: Ints) -> None:
    """Have contacts count as first ones."""
    _WORDS[arbiters + _ARBITER_DATA] = 0
    _HALVES[2 * (arbiters + _ARBITER_STATE)] = lib.CP_ARBITER_STATE_FIRST_COLLISION


def ignore(arbiters: Ints) -> None:
    """Have the engine ignore contacts in this step; in the next one they begin."""
    _WORDS[arbiters + _ARBITER_DATA] = 1
    _HALVES[2 * (arbiters + _ARBITER_COUNT)] = 0


def point_counts(arbiters: Ints) -> Ints:
    """Return (n,) the counts of points."""
    return _HALVES[2 * (arbiters + _ARBITER_COUNT)].astype(np.int64)


def shape_kinds(shapes: Ints) -> Ints:
    """Return CIRCLE, SEGMENT or POLYGON for each shape."""
    return _HALVES[2 * places_in(_WORDS[shapes])].astype(np.int64)


def shape_radii(shapes: Ints, kinds: Ints) -> Floats:
    """Return the radius of each disc, and that of the rounding of each other shape [m]."""
    radii: Floats = NUMBERS[shapes + _RADIUS[kinds]]
    return radii


def corner_places(shapes: Ints, kinds: Ints) -> tuple[Ints, Ints, Ints]:
    """Return of each shape the place of its first corner, the words to the next, their count."""
    polygon = kinds == POLYGON
    inline = shapes + np.array((_CIRCLE_CENTER, _SEGMENT_ENDS, 0))[kinds]
    first = np.where(polygon, places_in(_WORDS[shapes + _POLYGON_PLANES]), inline)
    count = np.where(polygon, _HALVES[2 * (shapes + _POLYGON_COUNT)], kinds + 1)
    return first, _CORNER_SIZE[kinds], count


def _check_layout() -> None:
    """
    Compare numbers of a small space with those that Pymunk returns.

    :raises ImportError: this version of Pymunk has different structs
    """
    pm_space = pymunk.Space()
    body = pymunk.Body(2.0, 4.0)
    body.position, body.angle, body.velocity, body.force = (0.3, 0.1), 0.5, (0.5, -1.0), (3.0, 2.0)
    disc, box = pymunk.Circle(body, 0.25, (0.1, 0.0)), pymunk.Poly.create_box(body, (0.5, 0.75))
    ground = pymunk.Body(body_type=pymunk.Body.STATIC)
    ground.position = (0.25, 0.0)
    bar = pymunk.Segment(ground, (-1.0, -0.25), (1.0, -0.25), 0.0625)
    pm_space.add(body, ground, disc, box, bar)
    pm_space.step(1e-3)
    # The step has cleared them.
    body.force, body.torque = (3.0, 2.0), 1.5
    shapes = np.array([place_of(each._shape) for each in (disc, bar, box)])
    kinds = shape_kinds(shapes)
    first, size, count = corner_places(shapes, kinds)
    ends = [(1.25, -0.25), *map(body.local_to_world, (disc.offset, box.get_vertices()[-1]))]
    (numbers,) = read_numbers(np.array([place_of(body._body)]), BODY_WORDS)
    twist = (*body.velocity, body.angular_velocity)
    found = (
        set(contacts_of_step(pm_space).tolist())
        ^ {place_of(it) for it in pm_space._get_arbiters()},
        kinds - (CIRCLE, SEGMENT, POLYGON),
        shape_radii(shapes, kinds) - (0.25, 0.0625, 0.0),
        read_numbers(first + size * (count - 1), VECTOR)[[1, 0, 2]] - ends,
        read_numbers(shapes, SHAPE_WORDS)[:, SHAPE_BOX] - [each.bb for each in (disc, bar, box)],
        numbers[BODY_POSE] - (*body.position, body.angle),
        numbers[BODY_TWIST] - twist,
        numbers[BODY_FORCE] - body.force,
        numbers[BODY_FORCES] - (*body.force, body.torque),
        numbers[BODY_INVERSES] - (0.5, 0.5, 0.25),
        numbers[[BODY_INVERSE_MASS, BODY_INVERSE_MOMENT]] - (0.5, 0.25),
    )
    if any(np.abs([*each]).max(initial=0.0) > 1e-12 for each in found):
        raise ImportError(f'Pymunk {pymunk.version} has different structs')


_check_layout()
