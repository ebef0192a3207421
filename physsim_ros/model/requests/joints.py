# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests for joints: made, changed, removed; and a cut, which moves them with its pieces."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
import math
from typing import Annotated, Any

from physsim_ros.model.checks import check_point, must_be, OfClass, text, texts
from physsim_ros.model.declarations import Checked, without_unset
from physsim_ros.model.errors import BadProperty, BadSize, Malformed
from physsim_ros.model.joints import (
    joined_from,
    JointKind,
    JointProperties,
    kind_from,
    MOST_STOPS,
)
from physsim_ros.model.motor_command import MotorCommand
from physsim_ros.model.names import ADDED, BODY, check_name, JOINT, WORLD
from physsim_ros.model.requests.bodies import ChangeBody, Spawn
from physsim_ros.model.requests.request import AtPoint, OfNamespace, Query, Request, several, UNSET
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import counted, Text


def _check_ends(a: str, b: str) -> None:
    """Refuse a joint of the background alone, or of a body and itself."""
    if a == WORLD:
        raise BadProperty('a is a body; the background can only be b', field='a')
    if a and a == b:
        raise BadProperty('{a} cannot be joined to itself', field='b', a=a)


def _points(value: object, name: str) -> tuple[Point, ...]:
    if not isinstance(value, Iterable):
        raise must_be('a list of points', value, name, Malformed)
    return tuple(check_point(point, name) for point in value)


@dataclass(frozen=True, slots=True, kw_only=True)
class Join(Request):
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

    FOUND = JOINT

    name: Annotated[str, check_name, 'name of the joint', JOINT, ADDED]
    kind: Annotated[JointKind, lambda value, name: kind_from(text(value, name)), 'kind of joint']
    points: Annotated[
        tuple[Point, ...],
        _points,
        'anchor points, one or two as the kind requires; a rope may have others between them [m]',
    ]
    frame: Annotated[str, text, "frame of the points: '' for the world, or a body's name"] = ''
    a: Annotated[str, text, "name of a body; '' is the topmost one at the first point"] = ''
    b: Annotated[
        str,
        text,
        "name of a body, or 'world' for the background; '' is the next body at the point, or the "
        'topmost one at the second point, or the background if there is none',
    ] = ''
    properties: Annotated[JointProperties, OfClass(JointProperties), 'of the joint'] = field(
        default_factory=JointProperties
    )
    unset: Annotated[tuple[str, ...], texts, UNSET] = ()

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        count = self.kind.points
        passes = self.kind.schema.passes
        if len(self.points) < count or (len(self.points) > count and not passes):
            template = '{kind} has {points}, not {found}'
            if passes:
                template = '{kind} has {points} or more, not {found}'
            raise Malformed(
                template,
                field='points',
                kind=Text(self.kind.phrase),
                points=counted(count, 'point'),
                found=len(self.points),
            )
        if len(self.points) > MOST_STOPS:
            raise BadProperty('a rope has at most {most} points', field='points', most=MOST_STOPS)
        over = self.properties.over
        if over is not None and len(over) != len(self.points) - count:
            raise BadProperty(
                'over names {bodies}; the {kind} has {points} between its ends',
                field='over',
                bodies=counted(len(over), 'body'),
                kind=Text(self.kind),
                points=counted(len(self.points) - count, 'point'),
            )
        _check_ends(self.a, self.b)
        self.properties.check_kind(self.kind, self.unset)
        least = self.kind.schema.least_distance
        if least and math.dist(*self.points[:2]) < least:
            raise BadSize(
                'the points of a {kind} must be at least {least:g} m apart',
                field='points',
                kind=Text(self.kind),
                least=least,
            )

    def phrase(self, subject: str) -> str:
        """Return the phrase for it, with its kind."""
        return Text('join {kind} {joint}', kind=Text(self.kind), joint=subject)

    def concerned(self, world: Query) -> Iterable[str]:
        """Return the bodies that the joint will have, and those that it has."""
        points, properties = self.points, self.properties
        names = (self.a, *(properties.over or ('',) * (len(points) - 2)), self.b)
        # One point is that of both ends.
        places = points if len(points) > 1 else points * 2
        joined = (
            each
            for name, point in zip(names, places, strict=True)
            for each in (
                (name,) if name else world.bodies_at(world.resolve_point(point, self.frame))[:1]
            )
        )
        carrier = () if properties.carrier is None else (properties.carrier,)
        return (*joined, *carrier, *Request.concerned(self, world))


@dataclass(frozen=True, slots=True, kw_only=True)
class Pin(AtPoint):
    """Weld the two topmost bodies at a point, or the only one to the background."""

    VERB = 'join pin'
    FOUND = JOINT
    TOPMOST = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class Axle(AtPoint):
    """Join the two topmost bodies at a point by an axle, or the only one to the background."""

    VERB = 'join axle'
    FOUND = JOINT
    TOPMOST = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class Rejoin(Request):
    """Put a joint on pieces of its bodies: its points stay, and its limits count as before."""

    FOUND = JOINT

    name: Annotated[str, text, 'name of the joint', JOINT]
    a: Annotated[str, text, 'name of the piece of its body a', BODY]
    b: Annotated[str, text, "the same of b; 'world' for the background", BODY]

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        _check_ends(self.a, self.b)


def _commands(value: object, name: str) -> tuple[MotorCommand, ...]:
    if not isinstance(value, list | tuple) or not value:
        raise must_be('a list of commands', value, name, Malformed)
    commands = tuple(MotorCommand.from_value(each, name) for each in value)
    if len({each.joint for each in commands}) != len(commands):
        raise Malformed('{field} has a joint twice', field=name)
    return commands


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandMotors(Request):
    """
    Have motors of joints obey commands, each until its next one; if one is refused, none obeys.

    :raises Malformed: no motor is named, one is named twice, or a number is not finite
    :raises BadProperty: a value or a time is out of range
    """

    VERB = 'command'
    OBJECT = 'motors'

    commands: Annotated[tuple[MotorCommand, ...], _commands, 'of the motors, each once', JOINT]


@dataclass(frozen=True, slots=True, kw_only=True)
class Unjoin(Request):
    """Remove the joint of that name."""

    VERB = 'delete joint'
    FOUND = JOINT

    name: Annotated[str, text, 'name of the joint', JOINT]


@dataclass(frozen=True, slots=True, kw_only=True)
class UnjoinAll(OfNamespace):
    """Remove all joints, or all of a namespace."""

    VERB = 'delete'
    OBJECT = 'all joints'


def _parts(*kinds: type) -> Callable[[object, str], tuple[Any, ...]]:
    """Return a check of a tuple of requests of some kinds."""

    def check(value: object, name: str) -> tuple[Any, ...]:
        if not isinstance(value, tuple) or not all(isinstance(each, kinds) for each in value):
            raise must_be('a tuple of requests', value, name, Malformed)
        return value

    return check


@dataclass(frozen=True, slots=True, kw_only=True)
class Cut(Request):
    """Cut bodies into pieces, and joints through; if a part of it is refused, nothing is cut."""

    pieces: Annotated[
        tuple[ChangeBody | Spawn, ...],
        _parts(ChangeBody, Spawn),
        'a change of each body into its largest piece, and the other pieces',
        BODY,
        ADDED,
    ]
    joints: Annotated[
        tuple[Rejoin, ...], _parts(Rejoin), 'joints that are then on another piece', BODY, JOINT
    ] = ()
    severed: Annotated[
        tuple[Unjoin, ...], _parts(Unjoin), 'ropes, rods and springs that are cut through', JOINT
    ] = ()

    def phrase(self, subject: str) -> str:
        """Return the phrase for it, with what is cut."""
        return Request.phrase(self, subject or several(self.pieces, self.severed))


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
