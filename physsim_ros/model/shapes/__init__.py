# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Shapes of bodies: validated values, their convex pieces, their mass properties.

Lengths are in metres, in the body's frame (origin at the body's position, x right, y up). Markers
of shapes are in `ros`, drawn geometry is in `view`. Start with `kinds`, then `form` and
`polygons`. A new shape is a class in `kinds`, and a member of `Shape`.
"""

from physsim_ros.model.shapes.containment import (
    contain_each,
    contains,
    contains_each,
    distances_from_outlines,
)
from physsim_ros.model.shapes.form import (
    Capsule,
    Circle,
    Convex,
    extent_of,
    Form,
    hull_of,
    lever_of,
    Piece,
    piece_box,
)
from physsim_ros.model.shapes.kinds import (
    Box,
    Chain,
    Compound,
    Disc,
    Polygon,
    Shape,
    shape_in,
    SHAPE_WORDS,
    SHAPES,
    Triangles,
)
from physsim_ros.model.shapes.polygons import crosses_itself, is_convex, signed_area
from physsim_ros.model.shapes.validation import (
    as_tuples,
    checked_length,
    LARGEST,
    MOST_POINTS,
    SMALLEST,
)

__all__ = [
    'LARGEST',
    'MOST_POINTS',
    'SHAPES',
    'SHAPE_WORDS',
    'SMALLEST',
    'Box',
    'Capsule',
    'Chain',
    'Circle',
    'Compound',
    'Convex',
    'Disc',
    'Form',
    'Piece',
    'Polygon',
    'Shape',
    'Triangles',
    'as_tuples',
    'checked_length',
    'contain_each',
    'contains',
    'contains_each',
    'crosses_itself',
    'distances_from_outlines',
    'extent_of',
    'hull_of',
    'is_convex',
    'lever_of',
    'piece_box',
    'shape_in',
    'signed_area',
]
