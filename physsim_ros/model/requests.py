# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests: everything that can be asked of a world, as frozen values.

A constructor checks types and values of its request alone; the world checks them against its
bodies when it applies the request. Poses are (x, y, yaw) in metres and radians, in the world or,
where `frame` names a body, relative to that body as it is when the request is applied. Bodies come
first, then robots, joints, hands and the world. A new request is a class here, a member of
`Request`, and a line in the table of handlers in `simulation.world.world`.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
import math
import sys
from typing import Annotated, Any

import numpy as np
from physsim_ros.model.arrays import Floats, greatest
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.checks import (
    check_finite,
    check_point,
    check_pose,
    check_yaw,
    FARTHEST,
    FASTEST,
    HEAVIEST,
    LONGEST,
    OfClass,
    shown,
    text,
)
from physsim_ros.model.colors import check_color, Color
from physsim_ros.model.declarations import check_key, Checked
from physsim_ros.model.errors import BadProperty, BadSize, Malformed
from physsim_ros.model.joints import (
    JOINT_KEYS,
    JointKind,
    JointProperties,
    kind_from,
)
from physsim_ros.model.names import check_body_name, check_hand_name, check_name, WORLD
from physsim_ros.model.settings import check_setting
from physsim_ros.model.shapes import Shape
from physsim_ros.model.transform import ORIGIN, Point, Pose, Twist

_NO_ROWS: Floats = np.empty((0, 3))
_NO_ROWS.flags.writeable = False


def _no_rows() -> Floats:
    return _NO_ROWS


_UNSET = 'names of the properties that get their defaults again'


# Checks of fields that only requests have.


def _as_field(field: str, check: Callable[[Any, str], Any]) -> Callable[[object, str], Any]:
    """Return a check that names another field in its refusal: that of the message."""
    return lambda value, _: check(value, field)


def _texts(value: object, name: str) -> tuple[str, ...]:
    if not isinstance(value, list | tuple) or not all(isinstance(each, str) for each in value):
        raise Malformed(f'{name} must be a list of texts, not {shown(value)}', field=name)
    return tuple(value)


def _names(value: object, name: str) -> tuple[str, ...]:
    names = _each_once(value, name)
    if not names:
        raise Malformed('no body is named', field=name)
    return names


def _each_once(value: object, name: str) -> tuple[str, ...]:
    names = _texts(value, name)
    if len(set(names)) != len(names):
        raise Malformed('a body is named twice', field=name)
    return names


def _unset(value: object, name: str) -> tuple[str, ...]:
    names = _texts(value, name)
    for each in names:
        check_key(each, Properties.FIELDS)
    return names


def _points(value: object, name: str) -> tuple[Point, ...]:
    if not isinstance(value, Iterable):
        raise Malformed(f'{name} must be a list of points, not {shown(value)}', field=name)
    return tuple(check_point(point, name) for point in value)


def _lifetime(value: object, name: str) -> float:
    (seconds,) = check_finite((value,), 1, name)
    if not 0.0 <= seconds <= LONGEST:
        raise BadProperty(
            f'{name} is {seconds:g}; it must lie between 0 and {LONGEST:g} s', field=name
        )
    return seconds


def _driven(value: object, name: str) -> Twist:
    vx, vy, turn = check_finite(value, 3, name)
    if max(abs(vx), abs(vy), abs(turn)) > FASTEST:
        raise BadProperty(f'{name} is faster than {FASTEST:g} m/s or rad/s', field=name)
    return vx, vy, turn


def _changes(value: object, name: str) -> dict[str, Any]:
    if not isinstance(value, Mapping):
        raise Malformed(f'{name} must be a mapping, not {shown(value)}', field=name)
    for setting in value:
        check_setting(setting)
    return dict(value)


@dataclass(frozen=True, slots=True, kw_only=True)
class Spawn(Checked):
    """
    Add a body, or change the body of that name in place.

    A change replaces the shape, the pose, the colour unless it is None, the lifetime unless it is
    0, and the properties that are set or unset. Everything else is kept, velocity included.

    :raises Malformed: a number is not finite, or the name is empty or too long
    :raises BadProperty: a pose, colour or lifetime is out of range
    """

    name: Annotated[str, check_body_name, 'of the body']
    shape: Annotated[Shape, OfClass(Shape), "geometry in the body's frame"]
    pose: Annotated[Pose, check_pose, "of the body's origin"] = ORIGIN
    frame: Annotated[str, text, "'' for the world, or a body's name"] = ''
    color: Annotated[
        Color | None,
        check_color,
        'red, green, blue, alpha, each 0 .. 1; None is the default of the name',
    ] = None
    lifetime: Annotated[
        float, _lifetime, 'simulation time after which the body is removed [s]; 0 is for ever'
    ] = 0.0
    properties: Annotated[Properties, OfClass(Properties), 'material, velocity and role'] = field(
        default_factory=Properties
    )
    unset: Annotated[tuple[str, ...], _unset, _UNSET] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ChangeBody(Checked):
    """
    Change what is set or unset here of a body that is there; everything else is kept.

    :raises Malformed: a number is not finite, or an array has the wrong length
    :raises BadProperty: a pose or colour is out of range
    """

    name: Annotated[str, text, 'of the body']
    shape: Annotated[
        Shape | None, OfClass(Shape), 'geometry in the frame of the body; None keeps it'
    ] = None
    properties: Annotated[Properties, OfClass(Properties), 'that are set'] = field(
        default_factory=Properties
    )
    unset: Annotated[tuple[str, ...], _unset, _UNSET] = ()
    color: Annotated[
        Color | None, check_color, 'red, green, blue, alpha, each 0 .. 1; None keeps it'
    ] = None
    pose: Annotated[Pose | None, check_pose, "of the body's origin; None keeps it"] = None
    frame: Annotated[str, text, "of the pose: '' for the world, or a body's name"] = ''


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveBodies(Checked):
    """
    Move bodies by one vector; velocities are kept. If one is refused, none is moved.

    :raises Malformed: no body is named, one is named twice, or a number is not finite
    :raises BadProperty: the vector is too long
    """

    names: Annotated[tuple[str, ...], _names, 'the bodies, each once']
    by: Annotated[Point, check_point, 'vector of the world [m]']


@dataclass(frozen=True, slots=True, kw_only=True)
class AtPoint(Checked):
    """A request for the topmost bodies, or joints, at a point [m]."""

    point: Annotated[Point, check_point, 'where they are [m]']
    frame: Annotated[str, text, "of the point: '' for the world, or a body's name"] = ''


@dataclass(frozen=True, slots=True, kw_only=True)
class Anchor(AtPoint):
    """Fix the topmost body at a point to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Release(AtPoint):
    """Undo the anchoring of the topmost body at a point, and remove pins and axles there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Delete(Checked):
    """Remove the body of that name, and its joints."""

    name: Annotated[str, text, 'of the body']


@dataclass(frozen=True, slots=True, kw_only=True)
class DeleteBodies(Checked):
    """
    Remove bodies with their joints, and other joints; if one is not there, none is removed.

    :raises Malformed: nothing is named, or something twice
    """

    names: Annotated[tuple[str, ...], _each_once, 'the bodies']
    joints: Annotated[tuple[str, ...], _each_once, 'the joints'] = ()

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if not self.names and not self.joints:
            raise Malformed('no body is named', field='names')


@dataclass(frozen=True, slots=True, kw_only=True)
class DeleteAll(Checked):
    """Remove all bodies, or all of a namespace, and their joints."""

    namespace: Annotated[
        str | None,
        text,
        'of their names, the part before the last slash; None is every body',
    ] = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Command(Checked):
    """
    Set poses, twists or wrenches of named bodies; if one is refused, nothing is set.

    Each array is copied and is read-only afterwards; n is the number of names.

    :raises Malformed: lengths do not fit, a name comes twice, a number is not finite
    :raises BadProperty: a value is out of range
    """

    names: Annotated[tuple[str, ...], _as_field('joint_names', _names), 'the bodies, each once']
    poses: Annotated[Floats, '(n, 3) float64: x, y [m], yaw [rad] of each, or empty'] = field(
        default_factory=_no_rows
    )
    twists: Annotated[
        Floats, '(n, 3) float64: vx, vy [m/s], spin [rad/s], world axes, or empty'
    ] = field(default_factory=_no_rows)
    wrenches: Annotated[
        Floats,
        '(n, 3) float64: fx, fy [N], torque [N m], world axes, or empty; they act at the centre '
        "of mass until the next one, at most for the world's `command_timeout`",
    ] = field(default_factory=_no_rows)
    frame: Annotated[str, text, "of the poses: '' for the world, or a body's name"] = ''

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        # In memory once for all commands of a publisher.
        object.__setattr__(self, 'names', tuple(sys.intern(str(name)) for name in self.names))
        for array, name in (('poses', 'transforms'), ('twists', 'twist'), ('wrenches', 'wrench')):
            rows = _checked_rows(getattr(self, array), len(self.names), name)
            object.__setattr__(self, array, rows)
        if greatest(self.poses[:, :2]) > FARTHEST:
            raise BadProperty(
                f'transforms is further away than {FARTHEST:g} m', field='transforms'
            )
        if greatest(self.poses[:, 2]) > FARTHEST:
            raise BadProperty('the yaw of transforms is too large', field='transforms')
        # The coordinates first, so that their squares do not overflow.
        if greatest(self.twists) > FASTEST or greatest(np.hypot(*self.twists.T[:2])) > FASTEST:
            raise BadProperty(f'twist is faster than {FASTEST:g} m/s or rad/s', field='twist')
        if greatest(self.wrenches) > HEAVIEST:
            raise BadProperty(f'wrench exceeds {HEAVIEST:g} N or N m', field='wrench')

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Command):
            return NotImplemented
        return (self.names, self.frame) == (other.names, other.frame) and all(
            np.array_equal(one, two) for one, two in zip(self._arrays, other._arrays, strict=True)
        )

    def __hash__(self) -> int:
        return hash((self.names, self.frame))

    @property
    def nbytes(self) -> int:
        """Memory of its arrays [bytes]."""
        return sum(array.nbytes for array in self._arrays)

    @property
    def _arrays(self) -> tuple[Floats, ...]:
        return self.poses, self.twists, self.wrenches


def _checked_rows(values: Any, count: int, name: str) -> Floats:
    """
    Return a read-only copy of as many rows of three finite numbers, or none.

    :param name: of the field, for the refusal
    :raises Malformed: they are something else
    """
    try:
        given = np.asarray(values)
    except ValueError as error:
        # Rows of different lengths.
        raise Malformed(f'each {name} needs 3 numbers', field=name) from error
    if given.ndim and not len(given):
        return _NO_ROWS
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in 'fiu':
        raise Malformed(f'each {name} needs 3 numbers', field=name)
    if len(given) != count:
        raise Malformed(f'{name} has {len(given)} entries for {count} bodies', field=name)
    rows = np.array(given, dtype=np.float64)
    if not np.isfinite(rows).all():
        raise Malformed(f'{name} is not finite', field=name)
    rows.flags.writeable = False
    return rows


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveRobot(Checked):
    """
    Drive at a velocity, until the next command or the timeout of the drive.

    The drive does what it can of it: a velocity beyond its limits is cut off.

    :raises Malformed: a number is not finite, or there are not three
    :raises BadProperty: it is faster than anything may be
    """

    name: Annotated[str, text, 'of the body of the robot']
    velocity: Annotated[
        Twist,
        _driven,
        'vx forward, vy to the left [m/s], turn counter-clockwise [rad/s]',
    ]


@dataclass(frozen=True, slots=True, kw_only=True)
class Join(Checked):
    """
    Join two bodies, or a body and the background; or change the joint of that name in place.

    A change replaces the bodies, the points and the properties that are set or unset. The other
    properties are kept if the kind is the same.

    :raises Malformed: a number is not finite, the name has no id, or the number of points is wrong
    :raises BadProperty: there is no such kind, a body would be joined to itself, or a point is too
        far away
    :raises BadSize: the points are closer than the kind allows
    :raises UnknownProperty: the kind of joint does not have a property
    """

    name: Annotated[str, check_name, 'of the joint']
    kind: Annotated[JointKind, lambda value, name: kind_from(text(value, name)), 'of joint']
    points: Annotated[
        tuple[Point, ...], _points, 'anchor points, one or two as the kind requires [m]'
    ]
    frame: Annotated[str, text, "of the points: '' for the world, or a body's name"] = ''
    a: Annotated[str, text, "name of a body; '' is the topmost one at the first point"] = ''
    b: Annotated[
        str,
        text,
        "name of a body, or 'world' for the background; '' is the next body at the point, or the "
        'topmost one at the second point, or the background if there is none',
    ] = ''
    properties: Annotated[JointProperties, OfClass(JointProperties), 'of the kind'] = field(
        default_factory=JointProperties
    )
    unset: Annotated[tuple[str, ...], _texts, _UNSET] = ()

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        count = self.kind.points
        if len(self.points) != count:
            raise Malformed(
                f'{self.kind.phrase} has {count} point{"s" * (count - 1)}, not {len(self.points)}',
                field='points',
            )
        if self.a == WORLD:
            raise BadProperty('a is a body; the background can only be b', field='a')
        if self.a and self.a == self.b:
            raise BadProperty(f'{self.a} cannot be joined to itself', field='b')
        self.properties.check_kind(self.kind, self.unset)
        least = self.kind.schema.least_distance
        if least and math.dist(*self.points) < least:
            raise BadSize(f'the points of a {self.kind} must be {least:g} m apart', field='points')


@dataclass(frozen=True, slots=True, kw_only=True)
class Pin(AtPoint):
    """Weld the two topmost bodies at a point, or the only one to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Axle(AtPoint):
    """Join the two topmost bodies at a point by an axle, or the only one to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Unjoin(Checked):
    """Remove the joint of that name."""

    name: Annotated[str, text, 'of the joint']


def _parts(*kinds: type) -> Callable[[object, str], tuple[Any, ...]]:
    """Return a check of a tuple of requests of some kinds."""

    def check(value: object, name: str) -> tuple[Any, ...]:
        if not isinstance(value, tuple) or not all(isinstance(each, kinds) for each in value):
            raise Malformed(f'{name} must be a tuple of requests, not {shown(value)}', field=name)
        return value

    return check


@dataclass(frozen=True, slots=True, kw_only=True)
class Cut(Checked):
    """Cut bodies into pieces, and joints through; if a part of it is refused, nothing is cut."""

    pieces: Annotated[
        tuple[ChangeBody | Spawn, ...],
        _parts(ChangeBody, Spawn),
        'a change of each body into its largest piece, and the other pieces',
    ]
    joints: Annotated[tuple[Join, ...], _parts(Join), 'joints that are then on another piece'] = ()
    severed: Annotated[
        tuple[Unjoin, ...], _parts(Unjoin), 'ropes, rods and springs that are cut through'
    ] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class UnjoinAll(Checked):
    """Remove all joints, or all of a namespace."""

    namespace: Annotated[
        str | None,
        text,
        'of their names, the part before the last slash; None is every joint',
    ] = None


def join_from(
    mapping: Mapping[Any, Any], *, name: str, points: tuple[Point, ...], frame: str = ''
) -> Join:
    """
    Return the request for a joint of a YAML mapping: `kind`, `a`, `b` and properties.

    Without `b`, a mapping with `a` means the background; without both it means the bodies at the
    points. A property that is null is unset.

    :param name: of the joint
    :param points: in the frame [m]
    :param frame: '' for the world, or a body's name
    :raises Refusal: a key is unknown, or a value is out of range
    """
    given, unset = without_unset(mapping, JointProperties)
    kind, a, b, properties = joined_from(given)
    return Join(
        name=name,
        kind=kind,
        points=points,
        frame=frame,
        a=a,
        b=b,
        properties=properties,
        unset=unset,
    )


def without_unset(
    mapping: Mapping[Any, Any], kind: type[Checked]
) -> tuple[dict[Any, Any], tuple[str, ...]]:
    """
    Return a YAML mapping without the properties that are null, and their names.

    :param kind: of the properties
    """
    unset = tuple(name for name in kind.FIELDS if mapping.get(name, name) is None)
    return {key: mapping[key] for key in mapping if key not in unset}, unset


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
    return kind, a, WORLD if a and not b else b, JointProperties.from_mapping(properties)


def _body_name(mapping: Mapping[Any, Any], key: str) -> str:
    name = mapping.get(key, '')
    if not isinstance(name, str):
        raise BadProperty(f'{key} must be the name of a body, not {shown(name)}', field=key)
    return name


@dataclass(frozen=True, slots=True, kw_only=True)
class OfHand(Checked):
    """
    A request of a hand.

    :raises Malformed: the name is empty, too long or unprintable
    """

    hand: Annotated[
        str, _as_field('client_id', check_hand_name), 'name of the hand, unique in its world'
    ]


@dataclass(frozen=True, slots=True, kw_only=True)
class Grab(OfHand):
    """Have a hand grab the topmost dynamic body under a point; it lets go of any other body."""

    point: Annotated[Point, _as_field('mouse_point', check_point), 'position of the hand [m]']
    frame: Annotated[str, text, "of the point: '' for the world, or a body's name"] = ''


@dataclass(frozen=True, slots=True, kw_only=True)
class GrabToPlace(Grab):
    """`Grab` in a paused world: where no dynamic body is under the point, any body is grabbed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveHand(OfHand):
    """Move a hand, and draw the body to it that it has grabbed."""

    point: Annotated[Point, _as_field('mouse_point', check_point), 'new position of the hand [m]']
    yaw: Annotated[
        float | None,
        _as_field('mouse_point', check_yaw),
        'of the body [rad], where it is placed; None keeps it',
    ] = None
    frame: Annotated[str, text, "of the point and yaw: '' for the world, or a body's name"] = ''


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaceHand(MoveHand):
    """`MoveHand` in a paused world: the body is put where its grip is at the hand."""


@dataclass(frozen=True, slots=True, kw_only=True)
class KeepHand(OfHand):
    """Keep a hand that does not move from counting as gone."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LetGo(OfHand):
    """Have a hand let go of its body, which flies on."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Configure(Checked):
    """Change settings of the world."""

    changes: Annotated[Mapping[str, Any], _changes, 'new values by the field of WorldSettings']


@dataclass(frozen=True, slots=True, kw_only=True)
class Restore(Checked):
    """Replace all bodies, joints and settings by those of a saved state."""

    state: Annotated[WorldState, OfClass(WorldState), 'that is restored']


HandRequest = Grab | GrabToPlace | MoveHand | PlaceHand | KeepHand | LetGo
Request = (
    Spawn
    | ChangeBody
    | MoveBodies
    | Command
    | Anchor
    | Release
    | Delete
    | DeleteBodies
    | DeleteAll
    | Join
    | Cut
    | Unjoin
    | UnjoinAll
    | Pin
    | Axle
    | HandRequest
    | DriveRobot
    | Configure
    | Restore
)
