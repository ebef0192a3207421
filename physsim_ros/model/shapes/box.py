# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A rectangle, centred on the body's position."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar, Self

from physsim_ros.model.checks import number
from physsim_ros.model.declarations import known_mapping
from physsim_ros.model.shapes.form import Convex, Form, form_of
from physsim_ros.model.shapes.validation import checked_length
from physsim_ros.model.transform import Point


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """
    A rectangle about the body's position, its sides along the body's axes.

    :param width: along x [m]
    :param height: along y [m]
    :raises BadSize: a side is out of range
    :raises Malformed: a side is not finite
    """

    KEY: ClassVar = 'box'

    width: float
    height: float
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, 'width', checked_length(self.width, 'width'))
        object.__setattr__(self, 'height', checked_length(self.height, 'height'))
        object.__setattr__(self, 'form', form_of((Convex(self.corners()),)))

    def corners(self, center: Point = (0.0, 0.0)) -> tuple[Point, ...]:
        """Return the four corners about a centre [m], counter-clockwise from lower left."""
        x, y = center
        half_width, half_height = self.width / 2, self.height / 2
        return (
            (x - half_width, y - half_height),
            (x + half_width, y - half_height),
            (x + half_width, y + half_height),
            (x - half_width, y + half_height),
        )

    @classmethod
    def from_entry(cls, entry: object) -> Self:
        """Return the box of a world file's entry."""
        known = known_mapping(entry, cls.KEY, ['width', 'height'])
        width, height = (number(known.get(side), side) for side in ('width', 'height'))
        return cls(width=width, height=height)

    def entry(self) -> object:
        """Return the entry of a world file."""
        return {'width': self.width, 'height': self.height}
