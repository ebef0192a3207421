# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests of hands, which drag a body, or place it in a paused world."""

from dataclasses import dataclass
from typing import Annotated

from physsim_ros.model.checks import check_point, check_yaw, text
from physsim_ros.model.names import check_hand_name
from physsim_ros.model.requests.request import as_field, Request
from physsim_ros.model.transform import Point


@dataclass(frozen=True, slots=True, kw_only=True)
class HandRequest(Request):
    """
    A request of a hand.

    :raises Malformed: the name is empty, too long or unprintable
    """

    hand: Annotated[
        str, as_field('client_id', check_hand_name), 'name of the hand, unique in its world'
    ]


@dataclass(frozen=True, slots=True, kw_only=True)
class Grab(HandRequest):
    """Have a hand grab the topmost dynamic body under a point; it lets go of any other body."""

    VERB = 'drag'

    point: Annotated[Point, as_field('mouse_point', check_point), 'position of the hand [m]']
    frame: Annotated[str, text, "of the point: '' for the world, or a body's name"] = ''


@dataclass(frozen=True, slots=True, kw_only=True)
class GrabToPlace(Grab):
    """`Grab` in a paused world: where no dynamic body is under the point, any body is grabbed."""

    VERB = 'place'


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveHand(HandRequest):
    """Move a hand, and draw the body to it that it has grabbed."""

    point: Annotated[Point, as_field('mouse_point', check_point), 'new position of the hand [m]']
    yaw: Annotated[
        float | None,
        as_field('mouse_point', check_yaw),
        'of the body [rad], where it is placed; None keeps it',
    ] = None
    frame: Annotated[str, text, "of the point and yaw: '' for the world, or a body's name"] = ''


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaceHand(MoveHand):
    """`MoveHand` in a paused world: the body is put where its grip is at the hand."""


@dataclass(frozen=True, slots=True, kw_only=True)
class KeepHand(HandRequest):
    """Keep a hand that does not move from counting as gone."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LetGo(HandRequest):
    """Have a hand let go of its body, which flies on."""

    VERB = 'drag'
