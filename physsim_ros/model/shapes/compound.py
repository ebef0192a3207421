# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A compound: copies of one disc or box, as one rigid body."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar, Self

from physsim_ros.model.checks import OfClass, point_list
from physsim_ros.model.declarations import known_mapping
from physsim_ros.model.errors import BadOutline, BadProperty
from physsim_ros.model.shapes.box import Box
from physsim_ros.model.shapes.disc import Disc
from physsim_ros.model.shapes.form import Circle, Convex, Form, form_of, Piece
from physsim_ros.model.shapes.validation import as_tuples, checked_points
from physsim_ros.model.transform import Point


@dataclass(frozen=True, slots=True, kw_only=True)
class Compound:
    """
    The same disc or box at several positions, not rotated.

    :param element: the disc or box
    :param centers: its positions [m]
    :raises BadOutline: no centre, or too many
    :raises Malformed: a coordinate is not finite, or the element is something else
    """

    KEY: ClassVar = 'compound'

    element: Disc | Box
    centers: tuple[Point, ...]
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        OfClass(Disc | Box)(self.element, 'element')
        centers = as_tuples(checked_points(self.centers, 'centers'))
        if not centers:
            raise BadOutline('a compound needs at least one element', field='centers')
        object.__setattr__(self, 'centers', centers)
        pieces: tuple[Piece, ...]
        if isinstance(self.element, Disc):
            pieces = tuple(Circle(center, self.element.radius) for center in centers)
        else:
            pieces = tuple(Convex(self.element.corners(center)) for center in centers)
        object.__setattr__(self, 'form', form_of(pieces))

    @classmethod
    def from_entry(cls, entry: object) -> Self:
        """Return the compound of a world file's entry."""
        known = known_mapping(entry, cls.KEY, [Disc.KEY, Box.KEY, 'centers'])
        named = [each for each in (Disc, Box) if each.KEY in known]
        if len(named) != 1:
            raise BadProperty(f'a compound has one of {Disc.KEY}, {Box.KEY}', field='shape')
        element = named[0].from_entry(known[named[0].KEY])
        return cls(element=element, centers=point_list(known.get('centers'), 'centers'))

    def entry(self) -> object:
        """Return the entry of a world file."""
        centers = [list(center) for center in self.centers]
        return {self.element.KEY: self.element.entry(), 'centers': centers}
