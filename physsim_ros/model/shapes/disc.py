# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A disc (Box2D and Pymunk: a circle)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar, Self

from physsim_ros.model.checks import number
from physsim_ros.model.declarations import known_mapping
from physsim_ros.model.shapes.form import Circle, Form, form_of
from physsim_ros.model.shapes.validation import checked_length


@dataclass(frozen=True, slots=True, kw_only=True)
class Disc:
    """
    A full circle about the body's position.

    :param radius: [m]
    :raises BadSize: the radius is out of range
    :raises Malformed: the radius is not finite
    """

    KEY: ClassVar = 'circle'

    radius: float
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, 'radius', checked_length(self.radius, 'radius'))
        object.__setattr__(self, 'form', form_of((Circle((0.0, 0.0), self.radius),)))

    @classmethod
    def from_entry(cls, entry: object) -> Self:
        """Return the disc of a world file's entry."""
        known = known_mapping(entry, cls.KEY, ['radius'])
        return cls(radius=number(known.get('radius'), 'radius'))

    def entry(self) -> object:
        """Return the entry of a world file."""
        return {'radius': self.radius}
