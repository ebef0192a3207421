# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""How a body is made in Pymunk: the body, and a shape for each convex piece."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
import math

from physsim_ros.engine.bodies import offset_of, RigidBody
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import Capsule, Circle, Convex, Piece
from physsim_ros.model.transform import Point
import pymunk

# Discs are made smaller by this [m]. Otherwise discs side by side overlap by rounding, and an
# impact on a row acts on all discs at once. Ten times the rounding of a position within a
# kilometre of the origin (1.1e-13 m).
GRAZE = 1e-12
# Polygons are rounded by this [m] (Box2D: polygon skin). Otherwise rounding tells whether what
# lies on their faces touches them. A hundred times the same rounding.
SKIN = 1e-11
# The filter of shapes that touch nothing.
NOTHING = pymunk.ShapeFilter(categories=0, mask=0)
# Pieces of a body that enter the engine's tree in their order [1]: of 1,000 segments in a row,
# blocks of 16 or 32 make the fastest steps; all in their order take three times as long to enter.
_BLOCK = 32


def build_body(body: Body) -> RigidBody:
    """Make the engine objects of a body, outside any space, at the origin and at rest."""
    if body.anchored:
        pm_body = pymunk.Body(body_type=pymunk.Body.STATIC)
    elif body.kinematic:
        pm_body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    else:
        pm_body = pymunk.Body(body.total_mass, body.total_mass * body.shape.form.gyration)
    offset = offset_of(body)
    shapes = [_shape(piece, pm_body, offset) for piece in _in_blocks(body.shape.form.pieces)]
    rigid = RigidBody(body, pm_body, handles_of(pm_body, *shapes))
    _set_neighbors([shape for shape in shapes if isinstance(shape, pymunk.Segment)])
    for shape in shapes:
        set_surface(shape, body.friction, body.elasticity)
        shape.sensor = body.sensor
        # Groups of the engine are unsigned.
        shape.filter = pymunk.ShapeFilter(group=body.group % 2**32)
        if body.medium is not None:
            # A region has no contacts with the bodies in it.
            shape.filter = NOTHING
    return rigid


def set_surface(shape: pymunk.Shape, friction: float, elasticity: float) -> None:
    """
    Set the surface of a shape, so that a pair has the geometric mean of both values.

    Pymunk multiplies what it is told of two shapes.
    """
    shape.friction, shape.elasticity = math.sqrt(friction), math.sqrt(elasticity)


def handles_of(*objects: pymunk.Body | pymunk.Shape | pymunk.Constraint) -> tuple[object, ...]:
    """
    Remove the handles from objects of Pymunk, and return them.

    By its handle, which it holds itself, an object of Pymunk (7.3.1) is a cycle of references:
    only a collection of garbage would free it, and one of a thousand bodies stops all threads for
    some 20 ms. Callbacks of the engine find the object by the handle, which must live as long.
    """
    return tuple(
        vars(each).pop('_h' if isinstance(each, pymunk.Shape) else '_data_handle')
        for each in objects
    )


def scattered(number: int) -> int:
    """
    Return the place of a number in an order in which shapes enter the engine's tree.

    The tree of shapes in a row that enter from left to right is as deep as there are shapes: with
    20,000 bodies it took 10 s. Numbers are scattered by the golden ratio (Fibonacci hashing:
    Knuth, "The Art of Computer Programming" 3, section 6.4).
    """
    return number * 2654435761 % 2**32


def _in_blocks(pieces: Sequence[Piece]) -> Iterator[Piece]:
    """Yield the pieces of a body as they enter the engine's tree: in scattered blocks."""
    for block in sorted(range(-(-len(pieces) // _BLOCK)), key=scattered):
        yield from islice(pieces, block * _BLOCK, (block + 1) * _BLOCK)


def _shape(piece: Piece, pm_body: pymunk.Body, offset: Point) -> pymunk.Shape:
    def local(point: Point) -> Point:
        return point[0] - offset[0], point[1] - offset[1]

    match piece:
        case Circle(center, radius):
            return pymunk.Circle(pm_body, radius - GRAZE, local(center))
        case Capsule(start, end, radius):
            return pymunk.Segment(pm_body, local(start), local(end), radius)
        case Convex(vertices):
            return pymunk.Poly(pm_body, [local(vertex) for vertex in vertices], radius=SKIN)


def _set_neighbors(segments: list[pymunk.Segment]) -> None:
    """
    Set the neighbours of the segments of a chain.

    Without them a ball that rolls through a bend hits the round end of the next segment before its
    face, and is thrown off.
    """
    before = {segment.b: segment.a for segment in segments}
    after = {segment.a: segment.b for segment in segments}
    for segment in segments:
        a, b = segment.a, segment.b
        segment.set_neighbors(before.get(a, a), after.get(b, b))
