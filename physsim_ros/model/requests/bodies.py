# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests for bodies: spawned, changed, moved, commanded, anchored, deleted, driven."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import chain
import math
import sys
from typing import Annotated

import numpy as np
from physsim_ros.model.arrays import checked_rows, Floats, greatest, no_rows
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checks import (
    check_finite,
    check_point,
    check_pose,
    FARTHEST,
    FASTEST,
    HEAVIEST,
    LONGEST,
    OfClass,
    text,
    texts,
)
from physsim_ros.model.colors import check_color, Color
from physsim_ros.model.declarations import check_key, Checked
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import ADDED, BODY, check_body_name, JOINT
from physsim_ros.model.requests.request import (
    as_field,
    AtPoint,
    OfNamespace,
    Query,
    Request,
    several,
    UNSET,
)
from physsim_ros.model.shapes import Shape
from physsim_ros.model.transform import ORIGIN, Point, Pose, Twist
from physsim_ros.model.translation import Text


def _names(value: object, name: str) -> tuple[str, ...]:
    names = _each_once(value, name)
    if not names:
        raise Malformed('no body is named', field=name)
    return names


def _each_once(value: object, name: str) -> tuple[str, ...]:
    names = texts(value, name)
    if len(set(names)) != len(names):
        raise Malformed('{field} has a name twice', field=name)
    return names


def _unset(value: object, name: str) -> tuple[str, ...]:
    names = texts(value, name)
    for each in names:
        check_key(each, Properties.WORDS)
    return names


# Texts for several bodies that form a whole, by the word of `Spawn.whole`.
_WHOLES = {'chain': Text('chain')}


def _duration(value: object, name: str) -> float:
    (seconds,) = check_finite((value,), 1, name)
    if not 0.0 <= seconds <= LONGEST:
        template = '{key} is {value:g}; it must lie between 0 and {most:g} s'
        raise BadProperty(template, field=name, key=name, value=seconds, most=LONGEST)
    return seconds


def _driven(value: object, name: str) -> Twist:
    vx, vy, turn = check_finite(value, 3, name)
    if max(abs(vx), abs(vy), abs(turn)) > FASTEST:
        raise BadProperty('{field} is faster than {most:g} m/s or rad/s', field=name, most=FASTEST)
    return vx, vy, turn


@dataclass(frozen=True, slots=True, kw_only=True)
class Spawn(Request):
    """
    Add a body, or change the body of that name in place.

    A change replaces the shape, the pose, the colour unless it is None, the lifetime unless it is
    0, and the properties that are set or unset. Everything else is kept, velocity included.

    :raises Malformed: a number is not finite, or the name is empty or too long
    :raises BadProperty: a pose, colour or lifetime is out of range
    """

    name: Annotated[str, check_body_name, 'name of the body', BODY, ADDED]
    shape: Annotated[Shape, OfClass(Shape), "geometry in the body's frame"]
    pose: Annotated[Pose, check_pose, "pose of the body's origin: x, y [m], yaw [rad]"] = ORIGIN
    frame: Annotated[str, text, "'' for the world, or a body's name"] = ''
    color: Annotated[
        Color | None,
        check_color,
        'red, green, blue, alpha, each 0 .. 1; None is the default of the name',
    ] = None
    lifetime: Annotated[
        float, _duration, 'simulation time after which the body is removed [s]; 0 is unlimited'
    ] = 0.0
    properties: Annotated[Properties, OfClass(Properties), 'material, velocity and role'] = field(
        default_factory=Properties
    )
    unset: Annotated[tuple[str, ...], _unset, UNSET] = ()
    whole: Annotated[
        str, text, "what its gesture adds, where the body is a part of that: 'chain'"
    ] = ''

    def phrase(self, subject: str) -> str:
        """Return the phrase for it, with what it is a part of."""
        return Request.phrase(self, _WHOLES.get(self.whole, subject))

    @property
    def is_whole_gesture(self) -> bool:
        """Return whether it is a part of what its gesture adds."""
        return self.whole != ''


@dataclass(frozen=True, slots=True, kw_only=True)
class ChangeBody(Request):
    """
    Change what is set or unset here of a body that is there; everything else is kept.

    :raises Malformed: a number is not finite, or an array has the wrong length
    :raises BadProperty: a pose or colour is out of range
    """

    VERB = 'change'

    name: Annotated[str, text, 'name of the body', BODY]
    shape: Annotated[
        Shape | None, OfClass(Shape), 'geometry in the frame of the body; None keeps it'
    ] = None
    properties: Annotated[Properties, OfClass(Properties), 'properties to set'] = field(
        default_factory=Properties
    )
    unset: Annotated[tuple[str, ...], _unset, UNSET] = ()
    color: Annotated[
        Color | None, check_color, 'red, green, blue, alpha, each 0 .. 1; None keeps it'
    ] = None
    pose: Annotated[
        Pose | None, check_pose, "pose of the body's origin: x, y [m], yaw [rad]; None keeps it"
    ] = None
    frame: Annotated[str, text, "frame of the pose: '' for the world, or a body's name"] = ''


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveBodies(Request):
    """
    Move bodies by one vector; velocities are kept. If one is refused, none is moved.

    :raises Malformed: no body is named, one is named twice, or a number is not finite
    :raises BadProperty: the vector is too long
    """

    VERB = 'move'
    OBJECT = 'several bodies'

    names: Annotated[tuple[str, ...], _names, 'the bodies, each once', BODY]
    by: Annotated[Point, check_point, 'vector of the world [m]']


@dataclass(frozen=True, slots=True, kw_only=True)
class Anchor(AtPoint):
    """Fix the topmost body at a point to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Release(AtPoint):
    """Undo the anchoring of the topmost body at a point, and remove pins and axles there."""

    def concerned(self, world: Query) -> Iterable[str]:
        """Return the topmost body, and those that lose a pin or an axle."""
        point, scene = world.resolve_point(self.point, self.frame), world.snapshot.scene
        top = world.bodies_at(point)[:1]
        reach = max((each.click_reach for each in scene.bodies if each.name in top), default=0.0)
        removed = (
            joint.bodies
            for joint in scene.joints
            if joint.kind in (JointKind.PIN, JointKind.AXLE)
            and not {*top}.isdisjoint(joint.bodies)
            and math.dist(world.pivot(joint), point) <= reach
        )
        return chain(top, *removed)


@dataclass(frozen=True, slots=True, kw_only=True)
class Delete(Request):
    """Remove the body of that name, and its joints."""

    name: Annotated[str, text, 'name of the body', BODY]

    def concerned(self, world: Query) -> Iterable[str]:
        """Return the body, and those that lose a joint with it."""
        return DeleteBodies(names=(self.name,)).concerned(world)


@dataclass(frozen=True, slots=True, kw_only=True)
class DeleteBodies(Request):
    """
    Remove several bodies with their joints, and other joints.

    If a body or joint does not exist, nothing is removed.

    :raises Malformed: nothing is named, or something is named twice
    """

    VERB = 'delete'

    names: Annotated[tuple[str, ...], _each_once, 'the bodies', BODY]
    joints: Annotated[tuple[str, ...], _each_once, 'the joints', JOINT] = ()

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if not self.names and not self.joints:
            raise Malformed('no body is named', field='names')

    def phrase(self, subject: str) -> str:
        """Return the phrase for it, with what is deleted."""
        return Request.phrase(self, subject or several(self.names, self.joints))

    def concerned(self, world: Query) -> Iterable[str]:
        """Return the bodies, and those that lose a joint."""
        gone = {each for name in self.names for each in world.machine(name)}
        removed = (
            joint.bodies
            for joint in world.snapshot.scene.joints
            if joint.name in self.joints or not gone.isdisjoint(joint.bodies)
        )
        return chain(self.names, *removed)


@dataclass(frozen=True, slots=True, kw_only=True)
class DeleteAll(OfNamespace):
    """Remove all bodies, or all of a namespace, and their joints."""

    VERB = 'delete'
    OBJECT = 'all bodies'


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Command(Request):
    """
    Set poses, twists or wrenches of named bodies; if one is refused, nothing is set.

    Each array is copied and is read-only afterwards; n is the number of names.

    :raises Malformed: lengths do not fit, a name comes twice, a number is not finite
    :raises BadProperty: a value is out of range
    """

    VERB = 'set motion of'
    OBJECT = 'several bodies'

    names: Annotated[
        tuple[str, ...], as_field('joint_names', _names), 'the bodies, each once', BODY
    ]
    poses: Annotated[Floats, '(n, 3) float64: x, y [m], yaw [rad] of each, or empty'] = field(
        default_factory=no_rows
    )
    twists: Annotated[
        Floats, '(n, 3) float64: vx, vy [m/s], spin [rad/s], world axes, or empty'
    ] = field(default_factory=no_rows)
    wrenches: Annotated[
        Floats,
        '(n, 3) float64: fx, fy [N], torque [N m], world axes, or empty; they act at the centre '
        "of mass until the next one, at most for the world's `command_timeout`",
    ] = field(default_factory=no_rows)
    frame: Annotated[str, text, "frame of the poses: '' for the world, or a body's name"] = ''

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        # In memory once for all commands of a publisher.
        object.__setattr__(self, 'names', tuple(sys.intern(str(name)) for name in self.names))
        for array, name in (('poses', 'transforms'), ('twists', 'twist'), ('wrenches', 'wrench')):
            rows = checked_rows(getattr(self, array), len(self.names), name)
            object.__setattr__(self, array, rows)
        if greatest(self.poses[:, :2]) > FARTHEST:
            raise BadProperty(
                '{field} is further away than {most:g} m', field='transforms', most=FARTHEST
            )
        if greatest(self.poses[:, 2]) > FARTHEST:
            raise BadProperty('the yaw of {field} is too large', field='transforms')
        # The coordinates first, so that their squares do not overflow.
        if greatest(self.twists) > FASTEST or greatest(np.hypot(*self.twists.T[:2])) > FASTEST:
            raise BadProperty(
                '{field} is faster than {most:g} m/s or rad/s', field='twist', most=FASTEST
            )
        if greatest(self.wrenches) > HEAVIEST:
            raise BadProperty('wrench exceeds {most:g} N or N m', field='wrench', most=HEAVIEST)

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


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveRobot(Request):
    """
    Drive at a velocity, until the next command or a timeout.

    The drive does what it can of it: a velocity beyond its limits is cut off.

    :raises Malformed: a number is not finite, or there are not three
    :raises BadProperty: it is faster than anything may be
    """

    VERB = 'drive'

    name: Annotated[str, text, 'of the body of the robot', BODY]
    velocity: Annotated[
        Twist,
        _driven,
        'vx forward, vy to the left [m/s], turn counter-clockwise [rad/s]',
    ]
    timeout: Annotated[
        float | None,
        _duration,
        'simulation time after which it stops [s]; 0 is never, None that of the drive',
    ] = None
