# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Shapes of bodies, one file a shape: validated values, their convex pieces, their mass properties.

Lengths are in metres, in the body's frame (origin at the body's position, x right, y up). Markers
of shapes are in `ros`, drawn geometry is in `view`. Start with `disc`, then `polygon` and
`convex_decomposition`. A new shape is a file here and a member of `Shape`.
"""

from typing import get_args

from physsim_ros.model.shapes.box import Box
from physsim_ros.model.shapes.chain import Chain
from physsim_ros.model.shapes.compound import Compound
from physsim_ros.model.shapes.containment import contain_each, contains, contains_each
from physsim_ros.model.shapes.disc import Disc
from physsim_ros.model.shapes.form import (
    Capsule,
    Circle,
    Convex,
    extent_of,
    Form,
    Piece,
    piece_box,
)
from physsim_ros.model.shapes.lever import lever_of
from physsim_ros.model.shapes.polygon import Polygon
from physsim_ros.model.shapes.polygon_geometry import crosses_itself, is_convex, signed_area
from physsim_ros.model.shapes.triangles import Triangles
from physsim_ros.model.shapes.validation import LARGEST, MOST_POINTS, SMALLEST

Shape = Disc | Box | Polygon | Chain | Triangles | Compound
# By the key of world files.
SHAPES: dict[str, type[Shape]] = {each.KEY: each for each in get_args(Shape)}

__all__ = [
    'LARGEST',
    'MOST_POINTS',
    'SHAPES',
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
    'contain_each',
    'contains',
    'contains_each',
    'crosses_itself',
    'extent_of',
    'is_convex',
    'lever_of',
    'piece_box',
    'signed_area',
]
