# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The locks of a teacher: bodies that pages of pupils do not change.

Law: a request that concerns a locked body or one of its joints is refused, but for a teacher; so
is what takes back such a request, and what brings back another moment or another world while a
body of this one is locked.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from fnmatch import translate
from functools import lru_cache
import re

from physsim_ros.drawing import SceneQuery
from physsim_ros.model import requests
from physsim_ros.model.errors import BadProperty, Frozen
from physsim_ros.model.names import shown_name, WORLD
from physsim_ros.model.requests import Request
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.translation import Text
from physsim_ros.simulation.past import Node
from physsim_ros.sketchpad.rights import check_right, Right, Role
from physsim_ros.sketchpad.world_control import WorldControl

# Requests that concern no body: settings of the world; a hand may let go anywhere.
_OF_NONE = (requests.Configure, requests.LetGo)
# Names with wildcards: each is compiled, and compared with each name of a request.
MOST_PATTERNS = 50


class Locks:
    """
    Names of locked bodies.

    :param names: of the bodies, or patterns as in a shell
    :raises BadProperty: more than `MOST_PATTERNS` are patterns
    """

    def __init__(self, names: Collection[str]) -> None:
        patterns = {name for name in names if any(sign in name for sign in '*?[')}
        self._names = frozenset(names) - patterns
        if len(patterns) > MOST_PATTERNS:
            raise BadProperty(
                f'at most {MOST_PATTERNS} names have wildcards, not {len(patterns)}', field='names'
            )
        self._patterns = [re.compile(translate(pattern)) for pattern in patterns]

    def has(self, name: str) -> bool:
        """Return whether a body is locked."""
        return name in self._names or any(each.match(name) for each in self._patterns)


@lru_cache(maxsize=2)
def locks_of(names: tuple[str, ...]) -> Locks:
    """
    Return the locks of names and patterns.

    :raises BadProperty: there are too many patterns
    """
    return Locks(names)


def check_locked(role: Role, wanted: Iterable[Request], control: WorldControl) -> None:
    """
    Refuse requests that concern locked bodies, but for a teacher.

    In the past a request begins another course, without the bodies that came later.

    :raises Frozen: one of them does
    """
    # A hand lets go anywhere, and at any time.
    wanted = [each for each in wanted if not isinstance(each, requests.LetGo)]
    if not wanted or not control.locked_bodies or role is Role.TEACH:
        return
    snapshot = control.loop.bring_up_to_date()
    _check_newest(control)
    _check_names((name for each in wanted for name in _bodies_of(each, snapshot)), control)


def check_unchanged(role: Role, locked: Collection[str], control: WorldControl) -> None:
    """
    Refuse what waited while a teacher froze the pages or locked bodies, but for a teacher.

    :param locked: patterns of the bodies that were locked when it came
    :raises Frozen: it has to be asked for again
    """
    check_right(Right.CHANGE, role, frozen=control.values['sketchpad_frozen'])
    if role is not Role.TEACH and not set(locked).issuperset(control.locked_bodies):
        raise Frozen('a teacher has locked bodies meanwhile', field='name')


def check_moment(role: Role, control: WorldControl) -> None:
    """
    Refuse what replaces all bodies, by those of another moment or world, but for a teacher.

    :raises Frozen: a body of this world is locked
    """
    check_locked(role, (requests.DeleteAll(),), control)


def check_taken_back(
    role: Role, gestures: Collection[int], snapshot: Snapshot, control: WorldControl
) -> None:
    """
    Refuse to take back gestures that concern locked bodies, but for a teacher.

    :param gestures: their numbers
    :param snapshot: of now
    :raises Frozen: one of them does
    """
    if not gestures or not control.locked_bodies or role is Role.TEACH:
        return
    _check_newest(control)
    nodes = control.simulation.past.line.nodes_of(gestures)
    _check_names((name for each in nodes for name in _bodies_then(each, snapshot)), control)


def _check_newest(control: WorldControl) -> None:
    """
    Refuse to change the past of a world in which bodies are locked.

    :raises Frozen: the past is shown
    """
    if not control.simulation.playback.is_newest:
        raise Frozen('the past is shown, and bodies are locked by a teacher', field='history')


def _check_names(names: Iterable[str], control: WorldControl) -> None:
    """
    Refuse names of locked bodies.

    :raises Frozen: one of them is
    """
    locks = locks_of(control.locked_bodies)
    for name in names:
        # Patterns are those of bodies.
        if name != WORLD and locks.has(name):
            message = Text('{body} is locked by a teacher', body=shown_name(name))
            raise Frozen(message, field='name')


def _bodies_then(node: Node, snapshot: Snapshot) -> tuple[str, ...]:
    """
    Return the bodies that a request of the past concerned, by name, and those that its joints had.

    :param snapshot: of now; the points of the request may lie on other bodies now
    """
    request = node.request
    match request:
        case (
            requests.Join()
            | requests.Rejoin()
            | requests.Unjoin()
            | requests.Pin()
            | requests.Axle()
        ):
            return tuple(node.joined)
        case requests.Grab() | requests.Anchor() | requests.Release():
            return (node.subject,)
    return (*_bodies_of(request, snapshot), *node.joined)


def _bodies_of(request: Request, snapshot: Snapshot) -> tuple[str, ...]:
    """
    Return the bodies that a request concerns, by name, with all parts of their robots.

    :param snapshot: in which points are looked up
    """
    query = SceneQuery(snapshot)
    return tuple(each for name in _named(request, query) for each in query.machine(name))


def _deleted(
    request: requests.Delete | requests.DeleteBodies, query: SceneQuery
) -> tuple[str, ...]:
    """Return the bodies that are deleted, and those that lose a joint by that."""
    if isinstance(request, requests.Delete):
        request = requests.DeleteBodies(names=(request.name,))
    names, joints = request.names, request.joints
    gone = {each for name in names for each in query.machine(name)}
    removed = (
        joint
        for joint in query.joints
        if joint.name in joints or not gone.isdisjoint(joint.bodies)
    )
    return (*names, *(each for joint in removed for each in joint.bodies))


def _of_joint(name: str, query: SceneQuery) -> tuple[str, ...]:
    """Return the bodies of a joint; of one that is not there, none."""
    return next((each.bodies for each in query.joints if each.name == name), ())


def _joints_of(request: requests.Unjoin | requests.CommandMotors) -> tuple[str, ...]:
    """Return the names of the joints that a request is about."""
    if isinstance(request, requests.Unjoin):
        return (request.name,)
    return tuple(each.joint for each in request.commands)


def _joined(request: requests.Join | requests.Rejoin, query: SceneQuery) -> tuple[str, ...]:
    """Return the bodies that a joint has, or will have."""
    if isinstance(request, requests.Rejoin):
        return (request.a, request.b, *_of_joint(request.name, query))
    points, properties = request.points, request.properties
    names = (request.a, *(properties.over or ('',) * (len(points) - 2)), request.b)
    # One point is that of both ends.
    places = points if len(points) > 1 else points * 2
    joined = (
        each
        for name, point in zip(names, places, strict=True)
        for each in ((name,) if name else query.bodies_at(point)[:1])
    )
    carrier = () if properties.carrier is None else (properties.carrier,)
    return (*joined, *carrier, *_of_joint(request.name, query))


def _in_hand(
    request: requests.Grab | requests.MoveHand | requests.KeepHand, query: SceneQuery
) -> tuple[str, ...]:
    """Return the body that a hand grabs, or holds."""
    if isinstance(request, requests.Grab):
        under = query.bodies_at(request.point)
        return tuple(each for each in under if query.body(each).dynamic)[:1] or under[:1]
    return tuple(grip.body for grip in query.snapshot.grips if grip.hand == request.hand)


def _named(request: Request, query: SceneQuery) -> tuple[str, ...]:
    """
    Return the bodies that a request or its joints name, or that lie at its points.

    What is not named here concerns all.
    """
    match request:
        case requests.MoveBodies() | requests.Command():
            return request.names
        case requests.Delete() | requests.DeleteBodies():
            return _deleted(request, query)
        case requests.Spawn() | requests.ChangeBody() | requests.DriveRobot():
            return (request.name,)
        case requests.Join() | requests.Rejoin():
            return _joined(request, query)
        case requests.Cut(pieces=pieces, joints=moved, severed=severed):
            parts = (_named(each, query) for each in (*pieces, *moved, *severed))
            return tuple(name for names in parts for name in names)
        case requests.Unjoin() | requests.CommandMotors():
            return tuple(name for each in _joints_of(request) for name in _of_joint(each, query))
        case requests.Grab() | requests.MoveHand() | requests.KeepHand():
            return _in_hand(request, query)
        case requests.Anchor(point=point) | requests.Release(point=point):
            return query.bodies_at(point)[:1]
        case requests.Pin(point=point) | requests.Axle(point=point):
            return query.bodies_at(point)[:2]
    return () if isinstance(request, _OF_NONE) else query.names
