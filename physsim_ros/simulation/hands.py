# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Hands of people that drag a body at the moment that is shown.

Laws: a drag, from the grab until the hand lets go, is one gesture; requests of a hand whose grip
is gone, or after another moment is shown, change nothing. In a paused world hands place bodies.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from physsim_ros.model.requests import (
    Grab,
    GrabToPlace,
    HandRequest,
    KeepHand,
    LetGo,
    MoveHand,
    PlaceHand,
)
from physsim_ros.model.snapshot import Grip

# Steady time without a request after which a hand lets go [ns]: its page is gone.
LONGEST_SILENCE = 5 * 10**9


@dataclass(slots=True)
class _Hand:
    """
    A hand that drags a body.

    :param gesture: number of the gesture of the drag
    :param silent_since: first steady time after its last request, or after a pause [ns]; None
        until then
    """

    gesture: int
    silent_since: int | None = None


class Hands:
    """The hands of people that drag a body at the moment that is shown."""

    def __init__(self) -> None:
        self._dragging: dict[str, _Hand] = {}

    def __contains__(self, hand: str) -> bool:
        return hand in self._dragging

    def gesture_of(self, request: HandRequest, gesture: int) -> int:
        """
        Return the gesture that a request is part of.

        :param gesture: its own, if no drag is under way
        """
        hand = self._dragging.get(request.hand)
        return gesture if hand is None or isinstance(request, Grab) else hand.gesture

    def note_request(self, request: HandRequest, gesture: int, grips: Iterable[Grip]) -> None:
        """
        Note that a request of a hand was carried out.

        :param grips: of the world now; at a grab, hands without one are dropped: their bodies are
            gone
        """
        match request:
            case Grab(hand=hand):
                self._dragging[hand] = _Hand(gesture)
                with_grip = {grip.hand for grip in grips}
                for name in self._dragging.keys() - with_grip:
                    del self._dragging[name]
            case MoveHand(hand=hand) | KeepHand(hand=hand):
                self._dragging[hand].silent_since = None
            case LetGo(hand=hand):
                self._dragging.pop(hand, None)

    def note_time(self, now_ns: int, *, paused: bool) -> None:
        """
        Drop the hands that have been silent for too long.

        :param now_ns: steady time, never going back [ns]
        :param paused: whether the world is paused; then the time does not count
        """
        for name, hand in list(self._dragging.items()):
            if paused or hand.silent_since is None:
                hand.silent_since = now_ns
            elif now_ns - hand.silent_since > LONGEST_SILENCE:
                del self._dragging[name]

    def clear(self) -> None:
        """Drop all hands, since another moment is shown."""
        self._dragging.clear()


def placing(request: HandRequest) -> HandRequest:
    """Return the request of a hand in a paused world, in which it places bodies."""
    match request:
        case GrabToPlace() | PlaceHand() | KeepHand() | LetGo():
            return request
        case Grab(hand=hand, point=point, frame=frame):
            return GrabToPlace(hand=hand, point=point, frame=frame)
        case MoveHand(hand=hand, point=point, yaw=yaw, frame=frame):
            return PlaceHand(hand=hand, point=point, yaw=yaw, frame=frame)
