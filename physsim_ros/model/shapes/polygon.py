# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A solid polygon, convex or not."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar, Self

import numpy as np
from physsim_ros.model.checks import point_list
from physsim_ros.model.errors import BadOutline
from physsim_ros.model.shapes.convex_decomposition import convex_pieces, DEGENERATE
from physsim_ros.model.shapes.form import Convex, Form, form_of, share_forms
from physsim_ros.model.shapes.polygon_geometry import (
    crosses_itself,
    signed_area,
    unsigned_fan_area,
)
from physsim_ros.model.shapes.validation import as_tuples, checked_points, distinct_points
from physsim_ros.model.transform import Point


@dataclass(frozen=True, slots=True, kw_only=True)
class Polygon:
    """
    A solid with any simple outline.

    :param outline: the vertices in order, either way round, the first not repeated [m]
    :raises BadOutline: it crosses or touches itself, encloses no area or has too many vertices
    :raises BadSize: it is too large or too thin
    :raises Malformed: a coordinate is not finite
    """

    KEY: ClassVar = 'polygon'

    outline: tuple[Point, ...]
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        outline = distinct_points(checked_points(self.outline, 'outline'), closed=True)
        object.__setattr__(self, 'outline', as_tuples(outline))
        object.__setattr__(self, 'form', _form_of_outline(self.outline))

    @classmethod
    def from_entry(cls, entry: object) -> Self:
        """Return the polygon of a world file's entry."""
        return cls(outline=point_list(entry, cls.KEY))

    def entry(self) -> object:
        """Return the entry of a world file."""
        return [list(point) for point in self.outline]


@share_forms
def _form_of_outline(points: tuple[Point, ...]) -> Form:
    """
    Return the form of a polygon.

    :raises BadOutline: it crosses or touches itself, or encloses no area
    :raises BadSize: it is too thin
    """
    outline = np.array(points)
    if len(outline) < 3:
        raise BadOutline('an outline needs three different corners', field='points')
    area = signed_area(outline)
    if area < 0:
        outline = outline[::-1]
    least = float(np.ptp(outline, axis=0).max()) ** 2 * DEGENERATE
    if abs(area) <= least:
        # The areas of two loops of opposite orientation cancel.
        looped = unsigned_fan_area(outline) > least and crosses_itself(outline)
        reason = 'crosses or touches itself' if looped else 'encloses no area'
        raise BadOutline(f'the outline {reason}', field='points')
    pieces = convex_pieces(outline)
    # Mass and extent are those of the outline, slivers included.
    whole = Convex(as_tuples(outline))
    return form_of(pieces, (whole,))
