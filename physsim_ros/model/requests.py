# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
Requests: everything that can be asked of a world, as frozen values.

The constructor of a request checks its values alone; the world checks them against its bodies when
the request is applied.
Poses are (x, y, yaw) in metres and radians, in the world or, where `frame` names a body, relative
to that body as it is when the request is applied.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
import math
from typing import Any

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.checks import check_finite, check_key, FASTEST, HEAVIEST, shown
from physsim_ros.model.colors import Color
from physsim_ros.model.errors import BadProperty, BadSize, Malformed
from physsim_ros.model.joints import (
    JOINT_KEYS,
    joint_properties_from,
    JointKind,
    JointProperties,
    kind_from,
)
from physsim_ros.model.names import check_body_name, check_hand_name, check_name, WORLD
from physsim_ros.model.settings import check_setting
from physsim_ros.model.shapes import Shape
from physsim_ros.model.transform import Point, Pose

# Greatest coordinate [m]: beyond 10 000 km float64 positions are coarser than a nanometre.
FARTHEST = 1e7
# Greatest lifetime [s]: 300 years, more than a message's Duration holds, and exact as a number of
# steps.
LONGEST = 1e10


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
    pose: Pose = (0.0, 0.0, 0.0)
    frame: str = ''
    color: Color | None = None
    lifetime: float = 0.0
    properties: Properties = field(default_factory=Properties)

    def __post_init__(self) -> None:
        check_body_name(self.name)
        check_pose(self.pose, 'pose')
        if self.color is not None:
            object.__setattr__(self, 'color', _checked_color(self.color))
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
            object.__setattr__(self, 'color', _checked_color(self.color))


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveBodies:
    """
    Move bodies by one vector, all of them, or none if one is refused; velocities are kept.

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
class Delete:
    """Remove the body of that name, and its joints."""

    name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class DeleteBodies:
    """
    Remove several bodies, and their joints; none if one is not there.

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Join:
    """
    Join two bodies, or a body and the background; or change the joint of that name in place.

    A change replaces the bodies, the points and the properties that are set. The other properties
    are kept if the kind is the same.

    :param name: of the joint
    :param kind: of joint
    :param points: anchor points, one or two as the kind requires [m]
    :param frame: of the points: '' for the world, or a body's name
    :param a: name of a body; '' is the topmost one at the first point
    :param b: name of a body, or 'world' for the background; '' is the next body at the point, or
        the topmost one at the second point, or the background if there is none
    :param properties: of the kind
    :raises Malformed: a number is not finite, the name has no id, or the number of points is wrong
    :raises BadProperty: a body would be joined to itself, or a point is too far away
    :raises BadSize: the points are closer than the kind allows
    :raises UnknownProperty: the kind of joint does not have a property
    """

    name: str
    kind: JointKind
    points: tuple[Point, ...]
    frame: str = ''
    a: str = ''
    b: str = ''
    properties: JointProperties = field(default_factory=JointProperties)

    def __post_init__(self) -> None:
        check_name(self.name)
        count = self.kind.points
        if len(self.points) != count:
            raise Malformed(
                f'a {self.kind} has {count} point{"s" * (count - 1)}, not {len(self.points)}',
                field='points',
            )
        for point in self.points:
            check_point(point, 'points')
        if self.a == WORLD:
            raise BadProperty('a is a body; the background can only be b', field='a')
        if self.a and self.a == self.b:
            raise BadProperty(f'{self.a} cannot be joined to itself', field='b')
        self.properties.check_kind(self.kind)
        least = self.kind.schema.least_distance
        if least and math.dist(*self.points) < least:
            raise BadSize(f'the points of a {self.kind} must be {least:g} m apart', field='points')


@dataclass(frozen=True, slots=True, kw_only=True)
class Unjoin:
    """Remove the joint of that name."""

    name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class UnjoinAll:
    """
    Remove all joints, or all of a namespace.

    :param namespace: of their names, the part before the last slash; None is every joint
    """

    namespace: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class AtPoint:
    """A request for the topmost bodies, or joints, at a point [m]."""

    point: Point
    frame: str = ''

    def __post_init__(self) -> None:
        check_point(self.point, 'point')


@dataclass(frozen=True, slots=True, kw_only=True)
class Pin(AtPoint):
    """Weld the two topmost bodies at a point, or the only one to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Axle(AtPoint):
    """Join the two topmost bodies at a point by an axle, or the only one to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Anchor(AtPoint):
    """Fix the topmost body at a point to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Release(AtPoint):
    """Undo the anchoring of the topmost body at a point, and remove pins and axles there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HandRequest:
    """
    A request of a hand.

    :param hand: name of the hand, unique in its world
    :raises Malformed: the name is empty, too long or unprintable
    """

    hand: str

    def __post_init__(self) -> None:
        check_hand_name(self.hand)


@dataclass(frozen=True, slots=True, kw_only=True)
class Grab(HandRequest):
    """
    Have a hand grab the topmost movable body under a point; it lets go of any other body.

    :param point: where the hand is [m]
    :param frame: of the point: '' for the world, or a body's name
    """

    point: Point
    frame: str = ''

    def __post_init__(self) -> None:
        HandRequest.__post_init__(self)
        check_point(self.point, 'mouse_point')


@dataclass(frozen=True, slots=True, kw_only=True)
class GrabToPlace(Grab):
    """`Grab` in a paused world: where no movable body is under the point, any body is grabbed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveHand(HandRequest):
    """
    Move a hand, and draw the body to it that it has grabbed.

    :param point: where the hand is now [m]
    :param yaw: of the body [rad], where it is placed; None keeps it
    :param frame: of the point and yaw: '' for the world, or a body's name
    """

    point: Point
    yaw: float | None = None
    frame: str = ''

    def __post_init__(self) -> None:
        HandRequest.__post_init__(self)
        check_pose((*self.point, self.yaw or 0.0), 'mouse_point')


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaceHand(MoveHand):
    """`MoveHand` in a paused world: the body is put where its grip is at the hand."""


@dataclass(frozen=True, slots=True, kw_only=True)
class KeepHand(HandRequest):
    """Say that a hand is still there, though it does not move."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LetGo(HandRequest):
    """Have a hand let go of its body, which flies on."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """
    Set poses, twists or wrenches of named bodies: all of them, or none if one is refused.

    :param names: the bodies, each once
    :param poses: (x, y, yaw) for each, or empty
    :param twists: (vx, vy, spin) for each, world axes [m/s, rad/s], or empty
    :param wrenches: (fx, fy, torque) for each, world axes [N, N m], or empty; they act at
        the centre of mass until the next one, at most for the world's `command_timeout`
    :param frame: of the poses: '' for the world, or a body's name
    :raises Malformed: lengths do not fit, a name comes twice, a number is not finite
    :raises BadProperty: a value is out of range
    """

    names: tuple[str, ...]
    poses: tuple[Pose, ...] = ()
    twists: tuple[Pose, ...] = ()
    wrenches: tuple[Pose, ...] = ()
    frame: str = ''

    def __post_init__(self) -> None:
        if not self.names:
            raise Malformed('the command names no body', field='joint_names')
        if len(set(self.names)) != len(self.names):
            raise Malformed('the command names a body twice', field='joint_names')
        for name, rows in (
            ('transforms', self.poses),
            ('twist', self.twists),
            ('wrench', self.wrenches),
        ):
            if rows and len(rows) != len(self.names):
                raise Malformed(
                    f'{name} has {len(rows)} entries for {len(self.names)} bodies', field=name
                )
        for pose in self.poses:
            check_pose(pose, 'transforms')
        for twist in self.twists:
            check_finite(twist, 3, 'twist')
            if math.hypot(*twist[:2]) > FASTEST or abs(twist[2]) > FASTEST:
                raise BadProperty(f'twist is faster than {FASTEST:g} m/s or rad/s', field='twist')
        for wrench in self.wrenches:
            check_finite(wrench, 3, 'wrench')
            if max(map(abs, wrench)) > HEAVIEST:
                raise BadProperty(f'wrench exceeds {HEAVIEST:g} N or N m', field='wrench')


@dataclass(frozen=True, slots=True, kw_only=True)
class Configure:
    """
    Change settings of the world.

    :param changes: new values by the field of WorldSettings
    """

    changes: Mapping[str, Any]

    def __post_init__(self) -> None:
        object.__setattr__(self, 'changes', dict(self.changes))
        for name in self.changes:
            check_setting(name)


@dataclass(frozen=True, slots=True, kw_only=True)
class Restore:
    """Replace all bodies, joints and settings by those of a saved state."""

    state: WorldState


def join_from(
    mapping: Mapping[Any, Any], *, name: str, points: tuple[Point, ...], frame: str = ''
) -> Join:
    """
    Return the request for a joint of a YAML mapping: `kind`, `a`, `b` and properties.

    Without `b`, a mapping with `a` means the background; without both it means the bodies at the
    points.

    :param name: of the joint
    :param points: in the frame [m]
    :param frame: '' for the world, or a body's name
    :raises Refusal: a key is unknown, or a value is out of range
    """
    kind, a, b, properties = joined_from(mapping)
    return Join(name=name, kind=kind, points=points, frame=frame, a=a, b=b, properties=properties)


def joined_from(mapping: Mapping[Any, Any]) -> tuple[JointKind, str, str, JointProperties]:
    """
    Return kind, names of the bodies a and b, and properties of a YAML mapping.

    :raises Refusal: a key is unknown, or a value is out of range
    """
    for key in mapping:
        check_key(key, JOINT_KEYS)
    properties = {key: mapping[key] for key in mapping if key not in {'kind', 'a', 'b'}}
    a, b = _body_name(mapping, 'a'), _body_name(mapping, 'b')
    kind = kind_from(mapping.get('kind'))
    return kind, a, WORLD if a and not b else b, joint_properties_from(properties)


def _body_name(mapping: Mapping[Any, Any], key: str) -> str:
    name = mapping.get(key, '')
    if not isinstance(name, str):
        raise BadProperty(f'{key} must be the name of a body, not {shown(name)}', field=key)
    return name


Joining = Join | Unjoin | UnjoinAll | Pin | Axle
Dragging = Grab | MoveHand | KeepHand | LetGo
OfBodies = (
    Spawn
    | ChangeBody
    | MoveBodies
    | Command
    | Anchor
    | Release
    | Delete
    | DeleteBodies
    | DeleteAll
)
Request = OfBodies | Joining | Dragging | Configure | Restore


def _checked_color(color: Color) -> Color:
    check_finite(color, 4, 'color')
    if not all(0.0 <= channel <= 1.0 for channel in color):
        raise BadProperty('each channel of color must lie in 0 .. 1', field='color')
    red, green, blue, alpha = map(float, color)
    return red, green, blue, alpha


def _check_names(names: tuple[str, ...]) -> None:
    if not names:
        raise Malformed('no body is named', field='names')
    if len(set(names)) != len(names):
        raise Malformed('a body is named twice', field='names')


def check_point(point: Point, name: str) -> None:
    """
    Refuse a point that is not finite or too far away.

    :raises Malformed: it is not finite
    :raises BadProperty: it is too far away
    """
    check_finite(point, 2, name)
    if max(map(abs, point)) > FARTHEST:
        raise BadProperty(f'{name} is further away than {FARTHEST:g} m', field=name)


def check_pose(pose: Pose, name: str) -> None:
    """
    Refuse a pose that is not finite or too far away.

    :raises Malformed: it is not finite
    :raises BadProperty: it is too far away
    """
    check_finite(pose, 3, name)
    check_point(pose[:2], name)
    if abs(pose[2]) > FARTHEST:
        raise BadProperty(f'the yaw of {name} is too large', field=name)
