# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The base of requests, what several kinds have in common, and requests for the whole world."""

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Protocol

from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.checks import check_point, must_be, OfClass, text
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import Malformed
from physsim_ros.model.names import BODY, JOINT
from physsim_ros.model.scene import Joint
from physsim_ros.model.settings import check_setting, WorldSettings
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import Text

UNSET = 'names of properties to reset to their defaults'


class Query(Protocol):
    """Queries on the bodies of a snapshot."""

    snapshot: Snapshot

    def bodies_at(self, point: Point) -> tuple[str, ...]:
        """Return the names of the bodies that cover a point of the world [m], topmost first."""

    def pivot(self, axle: Joint) -> Point:
        """Return the place of a weld or an axle [m]."""

    def resolve_point(self, point: Point, frame: str) -> Point:
        """
        Return a point of a frame in the world [m].

        :param frame: '' for the world, or a body's name
        :raises UnknownFrame: there is no such body
        """

    def machine(self, name: str) -> tuple[str, ...]:
        """Return the names of a robot and its links for each of them; of another body its own."""


class Request(Checked):
    """
    The base of requests.

    :cvar VERB: verb of the phrase by which undo and redo name it; '' is the name of its class
    :cvar OBJECT: object of that phrase where the request concerns no single body or joint
    :cvar FOUND: BODY or JOINT, where the world alone knows which one it is about: the subject of
        its answer
    """

    __slots__ = ()
    VERB: ClassVar[str] = ''
    OBJECT: ClassVar[str] = ''
    FOUND: ClassVar[str] = ''

    @property
    def subject(self) -> str:
        """Return the one body or joint that it names, or ''."""
        names: tuple[str, ...] = getattr(self, 'names', ())
        name: str = getattr(self, 'name', names[0] if len(names) == 1 else '')
        return name

    def phrase(self, subject: str) -> str:
        """
        Return the phrase for it, by which undo and redo name it: `spawn ball/0`.

        :param subject: name of the body or joint concerned, or ''
        """
        verb = self.VERB or type(self).__name__.lower()
        thing = subject or Text(self.OBJECT)
        return Text(f'{verb} {{thing}}', thing=thing) if thing else verb

    @property
    def is_whole_gesture(self) -> bool:
        """Return whether its phrase names all requests of a gesture that begins with it."""
        return False

    def concerned(self, world: Query) -> Iterable[str]:
        """
        Return the names of the bodies that it changes, and of those of the joints that it changes.

        Unless a field has the note BODY or JOINT, it concerns all.
        """
        scene = world.snapshot.scene
        if not any({BODY, JOINT} & {*each.notes} for each in self.FIELDS.values()):
            return scene.names
        bodies = {each.name: each.bodies for each in scene.joints}
        joined = (name for joint in self.noted(JOINT) for name in bodies.get(joint, ()))
        return (*self.noted(BODY), *joined)


def as_field(field: str, check: Callable[[Any, str], Any]) -> Callable[[object, str], Any]:
    """Return a check that names another field in its refusal: that of the message."""
    return lambda value, _: check(value, field)


def several(bodies: Collection[object], joints: Collection[object]) -> Text:
    """Return the object of a phrase about bodies, joints or both."""
    if bodies and joints:
        return Text('several bodies and joints')
    return Text('several bodies' if bodies else 'several joints')


@dataclass(frozen=True, slots=True, kw_only=True)
class AtPoint(Request):
    """
    A request for the topmost bodies, or joints, at a point [m].

    :cvar TOPMOST: number of the bodies at the point that it concerns
    """

    FOUND = BODY
    TOPMOST: ClassVar[int] = 1

    point: Annotated[Point, check_point, 'the point [m]']
    frame: Annotated[str, text, "frame of the point: '' for the world, or a body's name"] = ''

    def concerned(self, world: Query) -> Iterable[str]:
        """Return the topmost bodies at the point."""
        return world.bodies_at(world.resolve_point(self.point, self.frame))[: self.TOPMOST]


@dataclass(frozen=True, slots=True, kw_only=True)
class OfNamespace(Request):
    """A request for all bodies, or joints, of a namespace."""

    namespace: Annotated[
        str | None, text, 'namespace, the part of a name before the last slash; None is all'
    ] = None

    def phrase(self, subject: str) -> str:
        """Return the phrase for it, with the namespace if there is one."""
        phrase = Request.phrase(self, subject)
        if self.namespace is None:
            return phrase
        namespace = self.namespace or Text('no namespace')
        return Text('{gesture} of {namespace}', gesture=phrase, namespace=namespace)


def _changes(value: object, name: str) -> dict[str, Any]:
    if not isinstance(value, Mapping):
        raise must_be('a mapping', value, name, Malformed)
    for setting in value:
        check_setting(setting)
    # Its own values, as a list that is changed later would change the past.
    settings = WorldSettings(**value)
    return {setting: getattr(settings, setting) for setting in value}


@dataclass(frozen=True, slots=True, kw_only=True)
class Configure(Request):
    """
    Change settings of the world.

    :raises Malformed: a number is not finite, or an array has the wrong length
    :raises BadProperty: there is no such setting, or a value is out of range
    """

    VERB = 'change'
    OBJECT = 'settings'

    changes: Annotated[Mapping[str, Any], _changes, 'new values by the field of WorldSettings']

    def phrase(self, subject: str) -> str:
        """Return the phrase for it, with the setting if it is one."""
        names = list(self.changes)
        return Request.phrase(self, Text(names[0]) if len(names) == 1 else subject)

    def concerned(self, _: Query) -> Iterable[str]:
        """Return no body: settings are those of the world."""
        return ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Restore(Request):
    """Replace all bodies, joints and settings by those of a saved state."""

    VERB = 'load'
    OBJECT = 'world'

    state: Annotated[WorldState, OfClass(WorldState), 'that is restored']
