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
from physsim_ros.model.names import BODY, JOINT, shown_name, WORLD
from physsim_ros.model.requests import Request
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.simulation.past import Node
from physsim_ros.sketchpad.rights import check_right, Right, Role
from physsim_ros.sketchpad.world_control import WorldControl

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
            template = 'at most {most} names have wildcards, not {count}'
            raise BadProperty(template, field='names', most=MOST_PATTERNS, count=len(patterns))
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
    if wanted := _restricted(role, wanted, control):
        _check_bodies(wanted, control.loop.bring_up_to_date(), control)


def check_locked_in_turn(role: Role, wanted: Iterable[Request], control: WorldControl) -> None:
    """
    Refuse requests whose turn has come as `check_locked` does, by the world as it is then.

    A long seek between the message and its turn may have put locked bodies where it points to.

    :raises Frozen: one of them concerns a locked body
    """
    if wanted := _restricted(role, wanted, control):
        _check_bodies(wanted, control.simulation.world.snapshot(), control)


def _restricted(role: Role, wanted: Iterable[Request], control: WorldControl) -> list[Request]:
    """Return the requests that locks may refuse: a hand lets go anywhere, and at any time."""
    if not has_locks(role, control):
        return []
    return [each for each in wanted if not isinstance(each, requests.LetGo)]


def _check_bodies(wanted: Iterable[Request], snapshot: Snapshot, control: WorldControl) -> None:
    """
    Refuse requests that concern locked bodies of a snapshot.

    :raises Frozen: one of them does
    """
    _check_newest(control)
    _check_names((name for each in wanted for name in _bodies_of(each, snapshot)), control)


def has_locks(role: Role, control: WorldControl) -> bool:
    """Return whether there are bodies that a page of a role does not change."""
    return bool(control.locked_bodies) and role is not Role.TEACH


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
    Refuse what replaces all bodies in its turn, by another moment or world, but for a teacher.

    :raises Frozen: the pages of pupils are frozen, or a body of this world is locked
    """
    check_right(Right.CHANGE, role, frozen=control.values['sketchpad_frozen'])
    check_locked_in_turn(role, (requests.DeleteAll(),), control)


def check_taken_back(
    role: Role, gestures: Collection[int], snapshot: Snapshot, control: WorldControl
) -> None:
    """
    Refuse to take back gestures that concern locked bodies, but for a teacher.

    :param gestures: their numbers
    :param snapshot: of now
    :raises Frozen: one of them does
    """
    if not gestures or not has_locks(role, control):
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
            raise Frozen('{body} is locked by a teacher', field='name', body=shown_name(name))


def _bodies_then(node: Node, snapshot: Snapshot) -> tuple[str, ...]:
    """
    Return the bodies that a request of the past concerned, by name, and those that its joints had.

    :param snapshot: of now; the points of the request may lie on other bodies now
    """
    found = {JOINT: (), BODY: (node.subject,)}.get(node.request.FOUND)
    bodies = _bodies_of(node.request, snapshot) if found is None else found
    return (*bodies, *node.joined)


def _bodies_of(request: Request, snapshot: Snapshot) -> tuple[str, ...]:
    """
    Return the bodies that a request concerns, by name, with all parts of their robots.

    :param snapshot: in which points are looked up
    """
    query = SceneQuery(snapshot)
    return tuple(each for name in request.concerned(query) for each in query.machine(name))
