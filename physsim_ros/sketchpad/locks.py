# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Locked bodies: which bodies a request of a page concerns, and which of them are locked."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from fnmatch import translate
from functools import lru_cache
import re

from physsim_ros.drawing import SceneQuery
from physsim_ros.model import requests
from physsim_ros.model.errors import BadProperty, Frozen
from physsim_ros.model.names import shown_name
from physsim_ros.model.requests import Request
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.sketchpad.access import Role
from physsim_ros.sketchpad.world_control import WorldControl

# Requests that concern every body of the world.
_OF_ALL = (requests.DeleteAll, requests.UnjoinAll, requests.Restore)
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


def check_locked(role: Role, wanted: Iterable[Request], world: WorldControl) -> None:
    """
    Refuse requests that concern locked bodies, but for a teacher.

    :raises Frozen: one of them does
    """
    names = world.locked_bodies()
    if not names or role is Role.TEACH:
        return
    locks = locks_of(names)
    snapshot = world.current_snapshot()
    for request in wanted:
        for name in _bodies_of(request, snapshot):
            if locks.has(name):
                raise Frozen(f'{shown_name(name)} is locked by a teacher', field='name')


def _bodies_of(request: Request, snapshot: Snapshot) -> tuple[str, ...]:
    """
    Return the bodies that a request concerns, by name.

    :param snapshot: in which points are looked up
    """
    query = SceneQuery(snapshot)
    match request:
        case requests.MoveBodies(names=names) | requests.DeleteBodies(names=names):
            return names
        case requests.Command(names=names):
            return names
        case requests.Spawn(name=name) | requests.ChangeBody(name=name):
            return (name,)
        case requests.Delete(name=name) | requests.DriveRobot(name=name):
            return (name,)
        case requests.Join(a=a, b=b, points=points):
            return tuple(
                each
                for name, point in ((a, points[0]), (b, points[-1]))
                for each in ((name,) if name else query.bodies_at(point)[:1])
            )
        case requests.Unjoin(name=name):
            joints = (each for each in query.joints if each.name == name)
            return tuple(each for joint in joints for each in (joint.a, joint.b))
        case requests.Grab(point=point):
            under = query.bodies_at(point)
            return tuple(each for each in under if query.body(each).dynamic)[:1] or under[:1]
        case requests.Anchor(point=point) | requests.Release(point=point):
            return query.bodies_at(point)[:1]
        case requests.Pin(point=point) | requests.Axle(point=point):
            return query.bodies_at(point)[:2]
    return query.names if isinstance(request, _OF_ALL) else ()
