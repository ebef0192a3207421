# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests that add, change and remove bodies, by their names or at a point."""

from __future__ import annotations

from dataclasses import dataclass, field

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checks import check_finite, check_point, check_pose, LONGEST
from physsim_ros.model.colors import check_color, Color
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.names import check_body_name
from physsim_ros.model.shapes import Shape
from physsim_ros.model.transform import ORIGIN, Point, Pose


@dataclass(frozen=True, slots=True, kw_only=True)
class Spawn:
    """
    Add a body, or change the body of that name in place.

    A change replaces the shape, the pose, the colour unless it is None, the lifetime unless it is
    0, and the properties that are set. Everything else is kept, velocity included.

    :param name: of the body
    :param shape: geometry in the body's frame
    :param pose: of the body's origin
    :param frame: '' for the world, or a body's name
    :param color: red, green, blue, alpha, each 0 .. 1; None is the default of the
        name
    :param lifetime: simulation time after which the body is removed [s]; 0 is for ever
    :param properties: material, velocity and role
    :raises Malformed: a number is not finite, or the name is empty or too long
    :raises BadProperty: a pose, colour or lifetime is out of range
    """

    name: str
    shape: Shape
    pose: Pose = ORIGIN
    frame: str = ''
    color: Color | None = None
    lifetime: float = 0.0
    properties: Properties = field(default_factory=Properties)

    def __post_init__(self) -> None:
        check_body_name(self.name)
        check_pose(self.pose, 'pose')
        if self.color is not None:
            object.__setattr__(self, 'color', check_color(self.color))
        check_finite((self.lifetime,), 1, 'lifetime')
        if not 0.0 <= self.lifetime <= LONGEST:
            raise BadProperty(
                f'lifetime is {self.lifetime:g}; it must lie between 0 and {LONGEST:g} s',
                field='lifetime',
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class ChangeBody:
    """
    Change the properties of a body that are named here; everything else is kept.

    :param name: of the body
    :param properties: that are set
    :param color: red, green, blue, alpha, each 0 .. 1; None keeps it
    :param pose: of the body's origin; None keeps it
    :param frame: of the pose: '' for the world, or a body's name
    :raises Malformed: a number is not finite, or an array has the wrong length
    :raises BadProperty: a pose or colour is out of range
    """

    name: str
    properties: Properties = field(default_factory=Properties)
    color: Color | None = None
    pose: Pose | None = None
    frame: str = ''

    def __post_init__(self) -> None:
        if self.pose is not None:
            check_pose(self.pose, 'pose')
        if self.color is not None:
            object.__setattr__(self, 'color', check_color(self.color))


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveBodies:
    """
    Move bodies by one vector; velocities are kept. If one is refused, none is moved.

    :param names: the bodies, each once
    :param by: vector of the world [m]
    :raises Malformed: no body is named, one is named twice, or a number is not finite
    :raises BadProperty: the vector is too long
    """

    names: tuple[str, ...]
    by: Point

    def __post_init__(self) -> None:
        _check_names(self.names)
        check_point(self.by, 'by')


@dataclass(frozen=True, slots=True, kw_only=True)
class AtPoint:
    """A request for the topmost bodies, or joints, at a point [m]."""

    point: Point
    frame: str = ''

    def __post_init__(self) -> None:
        check_point(self.point, 'point')


@dataclass(frozen=True, slots=True, kw_only=True)
class Anchor(AtPoint):
    """Fix the topmost body at a point to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Release(AtPoint):
    """Undo the anchoring of the topmost body at a point, and remove pins and axles there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Delete:
    """Remove the body of that name, and its joints."""

    name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class DeleteBodies:
    """
    Remove several bodies, and their joints. If one does not exist, none is removed.

    :param names: the bodies, each once
    :raises Malformed: no body is named, or one is named twice
    """

    names: tuple[str, ...]

    def __post_init__(self) -> None:
        _check_names(self.names)


@dataclass(frozen=True, slots=True, kw_only=True)
class DeleteAll:
    """
    Remove all bodies, or all of a namespace, and their joints.

    :param namespace: of their names, the part before the last slash; None is every body
    """

    namespace: str | None = None


def _check_names(names: tuple[str, ...]) -> None:
    if not names:
        raise Malformed('no body is named', field='names')
    if len(set(names)) != len(names):
        raise Malformed('a body is named twice', field='names')
