# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests of hands, which drag a body, or place it in a paused world."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated

from physsim_ros.model.checks import check_point, check_yaw, OfClass, text
from physsim_ros.model.names import BODY, check_hand_name
from physsim_ros.model.requests.request import as_field, Query, Request
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import Text


@dataclass(frozen=True, slots=True, kw_only=True)
class HandRequest(Request):
    """
    A request of a hand.

    :raises Malformed: the name is empty, too long or unprintable
    """

    VERB = 'drag'

    hand: Annotated[
        str, as_field('client_id', check_hand_name), 'name of the hand, unique in its world'
    ]

    @property
    def is_whole_gesture(self) -> bool:
        """Return True: all moves of a hand are one drag."""
        return True

    def concerned(self, world: Query) -> Iterable[str]:
        """Return the body that the hand holds."""
        return (grip.body for grip in world.snapshot.grips if grip.hand == self.hand)


@dataclass(frozen=True, slots=True, kw_only=True)
class Grab(HandRequest):
    """
    Have a hand grab the topmost dynamic body under a point; it lets go of any other body.

    In a paused world, where no dynamic body is under the point, it grabs any body.
    """

    FOUND = BODY

    point: Annotated[Point, as_field('mouse_point', check_point), 'position of the hand [m]']
    frame: Annotated[str, text, "frame of the point: '' for the world, or a body's name"] = ''
    paused: Annotated[bool, OfClass(bool), 'whether the world is paused'] = False

    def phrase(self, subject: str) -> str:
        """Return the phrase for it, by what the hand does with the body."""
        return Text('place {thing}' if self.paused else 'drag {thing}', thing=subject)

    def concerned(self, world: Query) -> Iterable[str]:
        """Return the topmost dynamic body at the point, or else the topmost one."""
        point, bodies = world.resolve_point(self.point, self.frame), world.snapshot.scene.bodies
        under = world.bodies_at(point)
        dynamic = {body.name for body in bodies if body.dynamic}
        return tuple(name for name in under if name in dynamic)[:1] or under[:1]


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveHand(HandRequest):
    """
    Move a hand, and draw the body to it that it has grabbed.

    In a paused world, the body is put where its grip is at the hand.
    """

    point: Annotated[Point, as_field('mouse_point', check_point), 'new position of the hand [m]']
    yaw: Annotated[
        float | None,
        as_field('mouse_point', check_yaw),
        'of the body [rad], in a paused world; None keeps it',
    ] = None
    frame: Annotated[str, text, "frame of both: '' for the world, or a body's name"] = ''
    paused: Annotated[bool, OfClass(bool), 'whether the world is paused'] = False


@dataclass(frozen=True, slots=True, kw_only=True)
class KeepHand(HandRequest):
    """Keep a hand that does not move from counting as gone."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LetGo(HandRequest):
    """Have a hand let go of its body, which flies on."""

    def concerned(self, _: Query) -> Iterable[str]:
        """Return no body: a hand may let go anywhere."""
        return ()
