# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A chain of capsules, for walls and terrain (Box2D: a chain shape)."""

from __future__ import annotations

from dataclasses import dataclass, field
import itertools
from typing import ClassVar, Self

from physsim_ros.model.checks import number, point_list
from physsim_ros.model.declarations import known_mapping
from physsim_ros.model.errors import BadOutline
from physsim_ros.model.shapes.form import Capsule, Form, form_of
from physsim_ros.model.shapes.validation import (
    as_tuples,
    checked_length,
    checked_points,
    distinct_points,
)
from physsim_ros.model.transform import Point


@dataclass(frozen=True, slots=True, kw_only=True)
class Chain:
    """
    Segments with round ends, each beginning at the end of the one before.

    :param points: at least two, in order [m]
    :param thickness: of the segments [m]
    :raises BadOutline: fewer than two different points, or too many
    :raises BadSize: the thickness is out of range
    :raises Malformed: a number is not finite
    """

    KEY: ClassVar = 'chain'

    points: tuple[Point, ...]
    thickness: float
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, 'thickness', checked_length(self.thickness, 'thickness'))
        distinct = distinct_points(checked_points(self.points, 'points'), closed=False)
        if len(distinct) < 2:
            raise BadOutline('a chain needs two different points', field='points')
        object.__setattr__(self, 'points', as_tuples(distinct))
        pieces = tuple(
            Capsule(start, end, self.thickness / 2)
            for start, end in itertools.pairwise(self.points)
        )
        object.__setattr__(self, 'form', form_of(pieces))

    @classmethod
    def from_entry(cls, entry: object) -> Self:
        """Return the chain of a world file's entry."""
        known = known_mapping(entry, cls.KEY, ['points', 'thickness'])
        thickness = number(known.get('thickness'), 'thickness')
        return cls(points=point_list(known.get('points'), 'points'), thickness=thickness)

    def entry(self) -> object:
        """Return the entry of a world file."""
        return {'points': [list(point) for point in self.points], 'thickness': self.thickness}
