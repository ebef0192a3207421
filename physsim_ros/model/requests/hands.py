# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests of the hands that drag bodies."""

from __future__ import annotations

from dataclasses import dataclass

from physsim_ros.model.checks import check_point, check_pose
from physsim_ros.model.names import check_hand_name
from physsim_ros.model.transform import Point


@dataclass(frozen=True, slots=True, kw_only=True)
class OfHand:
    """
    A request of a hand.

    :param hand: name of the hand, unique in its world
    :raises Malformed: the name is empty, too long or unprintable
    """

    hand: str

    def __post_init__(self) -> None:
        check_hand_name(self.hand)


@dataclass(frozen=True, slots=True, kw_only=True)
class Grab(OfHand):
    """
    Have a hand grab the topmost dynamic body under a point; it lets go of any other body.

    :param point: position of the hand [m]
    :param frame: of the point: '' for the world, or a body's name
    """

    point: Point
    frame: str = ''

    def __post_init__(self) -> None:
        OfHand.__post_init__(self)
        check_point(self.point, 'mouse_point')


@dataclass(frozen=True, slots=True, kw_only=True)
class GrabToPlace(Grab):
    """`Grab` in a paused world: where no dynamic body is under the point, any body is grabbed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveHand(OfHand):
    """
    Move a hand, and draw the body to it that it has grabbed.

    :param point: new position of the hand [m]
    :param yaw: of the body [rad], where it is placed; None keeps it
    :param frame: of the point and yaw: '' for the world, or a body's name
    """

    point: Point
    yaw: float | None = None
    frame: str = ''

    def __post_init__(self) -> None:
        OfHand.__post_init__(self)
        check_pose((*self.point, self.yaw or 0.0), 'mouse_point')


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaceHand(MoveHand):
    """`MoveHand` in a paused world: the body is put where its grip is at the hand."""


@dataclass(frozen=True, slots=True, kw_only=True)
class KeepHand(OfHand):
    """Keep a hand that does not move from counting as gone."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LetGo(OfHand):
    """Have a hand let go of its body, which flies on."""
